#include "options.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "ao/library.h"
#include "app/arguments.h"
#include "app/complaint.h"
#include "app/content.h"
#include "app/voxel_arguments.h"
#include "measure/arguments.h"
#include "scene/hash.h"

namespace obscura::bench {

using app::Complaint;

namespace {

std::vector<uint64_t> trianglesOf(const std::vector<std::string>& texts) {
    constexpr uint64_t kLeast = 1000, kMost = 20000000;
    std::vector<uint64_t> list;
    for (const std::string& text : texts) {
        uint64_t count = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
        if (error != std::errc() || end != text.data() + text.size() || count < kLeast || count > kMost)
            throw Complaint(fmt::format("--triangles {}: a whole number from {} to {}, several with commas", text, kLeast, kMost));
        list.push_back(count);
    }
    return list;
}

}  // namespace

std::optional<Options> parseOptions(int argc, const char* const* argv) {
    Options options;
    measure::Measurement& what = options.what;
    what.rounds = 5;
    what.frames = 5;
    what.rays.rays = 256;
    CLI::App cli{"Measures time, error against ray-traced references, flicker and memory of ambient-obscurance methods.", "obscura-bench"};
    cli.set_help_flag("-h,--help", "Print this and exit");
    cli.set_version_flag("--version", "Obscura " OBSCURA_VERSION);
    cli.footer(
        "All methods, falloffs, cameras and sizes of a scene run in turns, round by round, so that drift of the machine affects all "
        "equally. Compare\n"
        "times of one run only. Writes to --out: bench.html (error against cost, scaling), bench.json, bench.csv, passes.csv, bench.md. An "
        "interrupted\n"
        "run resumes with the same command.\n\n"
        "Examples:\n"
        "  obscura-bench --scene sponza,atrium --falloff quadratic:2,exponential:1 --out out/front       error against time\n"
        "  obscura-bench --method hbao --set steps=4,8,16 --scene atrium                                 cost and error against samples\n"
        "  obscura-bench --method hybrid --set voxel_structure=dense,nanovdb --scene sponza              two voxel structures\n"
        "  obscura-bench --triangles 10000,100000,1000000 --size 320x180,640x360,1280x720 --flicker 0    scaling of time\n"
        "  obscura-bench --scene sponza --compare before/bench.json                                      regressions\n"
        "  obscura-bench --gpu-cost --method gtao,layered --preset all                                   cycles, registers, bytes, without "
        "a GPU\n"
        "  obscura-bench --from out/front/bench.json --table README.md                                   the table between README's "
        "markers");
    cli.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);  // so that scripts' defaults can be overridden
    measure::CandidateOptions chosen;
    chosen.methods = {"all"};
    std::vector<std::string> falloffs{"quadratic:2"}, cameras{"own"}, references{"world", "screen"}, sizes{"640x360"}, triangles;
    std::string flickerSize = "320x180", out = "out/bench";
    uint32_t flickerFrames = 12;
    float time = 0.0f;
    bool noCache = false;
    using measure::takeAll;

    cli.option_defaults()->group("Frames");
    takeAll(cli.add_option(
        "--scene", what.scenes, "toasters, atrium, sponza, dragon, or glTF files; several with commas (default: all that are found)"));
    takeAll(cli.add_option(
        "--triangles", triangles, "Generated scenes of about so many triangles, for scaling; instead of --scene, or in addition"));
    takeAll(cli.add_option("--camera", cameras, "own, scene:N, path:FILE@SECONDS, path:@SECONDS, FILE.json; several with commas")
            ->capture_default_str());
    cli.add_option("--animation", what.animation, "Animation of the scenes: NAME or number, all together, or none")->capture_default_str();
    auto* timeOption = cli.add_option("--time", time, "Seconds into the animation (default: 0; on a flythrough the path's time)");
    takeAll(cli.add_option("--size", sizes, "WIDTHxHEIGHT in pixels, without guard band; several with commas")->capture_default_str());
    cli.add_option("--guard", what.guard, "Guard band, fraction of each side")->check(CLI::Range(0.0f, 0.5f))->capture_default_str();
    app::addVoxelArguments(cli, what.voxels, cli.option_defaults()->get_group());

    cli.option_defaults()->group("Measurement");
    addCandidateOptions(cli, chosen,
        "METHOD.PARAMETER=VALUE, or PARAMETER=VALUE for all that have it, or a list of values: each is measured; may be repeated. Methods "
        "that trace voxels also have voxels, voxel_size, voxelizer, voxel_structure and voxel_shell");
    takeAll(cli.add_option("--falloff", falloffs, "KIND:LENGTH in metres, or ramp:START:END; several with commas")->capture_default_str());
    cli.add_option("--rounds", what.rounds, "Number of rounds; each runs all settings once")
        ->check(CLI::Range(1u, 1000u))
        ->capture_default_str();
    cli.add_option("--frames", what.frames, "Timed frames of each setting in a round")
        ->check(CLI::Range(1u, 100000u))
        ->capture_default_str();
    cli.add_option("--warm-up", what.warmUp, "Untimed frames before those")->check(CLI::Range(0u, 1000u))->capture_default_str();
    takeAll(cli.add_option("--reference", references, "References that errors are measured against: world, screen, or none")
            ->capture_default_str());
    cli.add_option("--rays", what.rays.rays, "Rays per pixel of the references")->check(CLI::Range(32u, 65536u))->capture_default_str();
    cli.add_option("--seed", what.rays.seed, "Seed of the rays")->capture_default_str();
    cli.add_flag("--no-cache", noCache, "Trace references again and do not cache them (default: cached in the user's cache folder)");
    cli.add_option("--flicker", flickerFrames, "Frames of the scene's flythrough on which flicker is measured; 0: flicker is not measured")
        ->check(CLI::Range(0u, 10000u))
        ->capture_default_str();
    cli.add_option("--flicker-size", flickerSize, "WIDTHxHEIGHT of those frames, pixels")->capture_default_str();

    cli.option_defaults()->group("Cost on a GPU, counted by its compiler (Mesa's RADV; needs no GPU)");
    std::vector<std::string> chips;
    auto* gpuCost =
        cli.add_option("--gpu-cost", chips,
               "Instead of measuring, count cycles, registers, fetches and bytes of every preset on these chips: navi21, vega10, "
               "navi10, polaris10; several with commas (navi21,vega10)")
            ->expected(0, -1)
            ->delimiter(',');
    auto* check = cli.add_option("--check-gpu-cost", options.checkGpuCost,
        "Compare these costs with a baseline; fail if a pass takes over 3 % more cycles, fits fewer waves, or spills more");
    bool bentNormals = false;
    auto* bent =
        cli.add_flag("--bent-normals", bentNormals, "Count the methods with the passes of their bent normals; those without are left out");
    auto* renew = cli.add_option("--renew-gpu-cost", options.renewGpuCost, "Write that baseline");
    check->excludes(renew);
    bent->excludes(check)->excludes(renew);
    cli.add_flag("!--no-gpu-cost", options.withGpuCost, "Measure without counting the candidates' cycles on navi21 besides");

    cli.option_defaults()->group("Output");
    cli.add_option("--out", out, "Folder of the results")->capture_default_str();
    cli.add_flag("--again", options.again, "Measure again instead of resuming from the folder");
    cli.add_option("--from", options.from, "Measure nothing; read the bench.json of an earlier run");
    cli.add_option("--table", options.table,
        "Markdown file; replaces its tables: of times between <!-- bench: begin --> and <!-- bench: end -->, of GPU costs between "
        "<!-- gpu cost: begin --> and <!-- gpu cost: end -->");
    cli.add_option("--summary", options.summary, "JSON file of each preset's cycles, error and flicker, which the game's menu shows");
    cli.add_option(
        "--compare", options.compare, "bench.json of an earlier run: print ratios with confidence intervals, fail on regressions");
    cli.add_option(
           "--tolerance", options.tolerance, "Relative growth of a row's time that is allowed in addition to its confidence interval")
        ->check(CLI::Range(0.0, 10.0))
        ->capture_default_str();
    cli.add_flag(
        "--absolute", options.absolute, "Compare milliseconds, not shares of a round; then a slower machine counts as a regression");
    measure::addDevice(cli, what.device, what.validation, what.verbose);

    if (!app::parse(cli, argc, argv)) return std::nullopt;
    options.command = measure::commandOf("obscura-bench", argc, argv);
    options.out = out;
    if (*gpuCost || *check || *renew) {
        options.gpuCost = chips.empty() ? std::vector<std::string>{"navi21", "vega10"} : chips;
        if (!cli.count("--preset")) chosen.presets = {"all"};
        if (!cli.count("--size")) sizes = {"1920x1080"};
        if (!cli.count("--out")) options.out = *check || *renew ? "" : "out/gpu_cost";
    }
    if (!options.from.empty()) {
        for (const char* option :
            {"--scene", "--animation", "--time", "--triangles", "--method", "--preset", "--set", "--falloff", "--size", "--camera"})
            if (cli.count(option))
                throw Complaint(fmt::format("{}: has no effect with --from, which reads an earlier run; leave one of them out", option));
        if (!cli.count("--out")) options.out.clear();  // tables and comparisons need no folder
        return options;
    }
    options.triangles = trianglesOf(triangles);
    if (*timeOption && !std::isfinite(time)) throw Complaint("--time: must be a finite number of seconds");
    if (*timeOption) what.time = time;
    if (options.gpuCost.empty() && what.scenes.empty() && options.triangles.empty())
        for (const app::SceneFile& scene : app::namedScenes())
            if (!scene.file.empty()) what.scenes.push_back(scene.info.name);
    for (const std::string& size : sizes) options.sizes.push_back(app::sizeOf(size));
    for (const std::string& camera : cameras) what.cameras.push_back(measure::cameraOf(camera));
    what.falloffs = measure::falloffs(falloffs);
    what.candidates = measure::variants(chosen.methods, chosen.presets, chosen.allSets());
    if (bentNormals) {
        if (!*gpuCost) throw Complaint("--bent-normals: only with --gpu-cost");
        std::erase_if(what.candidates, [](const measure::Candidate& candidate) { return !candidate.info().bentNormals; });
        if (what.candidates.empty())
            throw Complaint(fmt::format("--bent-normals: none of the chosen methods has them; {} do", ao::bentNormalsFrom()));
        for (measure::Candidate& candidate : what.candidates) candidate.values.bentNormals = true;
    }
    for (const std::string& reference : references) {
        if (reference == "world") what.reference.world = true;
        else if (reference == "screen") what.reference.screen = true;
        else if (reference != "none" || references.size() > 1)
            throw Complaint(fmt::format("--reference {}: {}", reference,
                reference == "none" ? "none cannot be combined with others" : app::choices(reference, {"world", "screen", "none"})));
    }
    what.rays.targetError = 0.0f;
    what.rays.cache = !noCache;
    if (!noCache) what.voxels.cache = scene::cacheFolder();
    if (flickerFrames == 1) throw Complaint("--flicker 1: a change needs two frames; give 2 or more, or 0 for none");
    if (flickerFrames) {
        flythrough::Settings& settings = options.flicker.emplace();
        settings.size = app::sizeOf(flickerSize);
        settings.guard = what.guard;
        settings.length = settings.end = flickerFrames;
        settings.rays = what.rays.rays;
        settings.seed = what.rays.seed;
        settings.cache = what.rays.cache;
        settings.pictures = settings.still = false;
    }
    if (!options.triangles.empty() &&
        std::any_of(what.cameras.begin(), what.cameras.end(), [](const auto& c) { return c.kind == measure::CameraChoice::Kind::path; }))
        throw Complaint("--triangles: generated scenes have no flythrough; leave out --camera path:...");
    return options;
}

}  // namespace obscura::bench
