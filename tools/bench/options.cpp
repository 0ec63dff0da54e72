#include "options.h"

#include <algorithm>
#include <charconv>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/arguments.h"
#include "app/complaint.h"
#include "app/voxel_arguments.h"
#include "arguments.h"
#include "content.h"
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
    evaluate::Options& what = options.what;
    what.rounds = 5;
    what.frames = 5;
    what.rays.rays = 256;
    CLI::App cli{"Times ambient-obscurance methods against each other and says what the time buys: error against ray-traced references, flicker, memory.",
                 "obscura-bench"};
    cli.set_help_flag("-h,--help", "Print this and exit");
    cli.set_version_flag("--version", "Obscura " OBSCURA_VERSION);
    cli.footer(
        "All methods, falloffs, cameras and sizes of a scene take turns, a round after the other, so that a machine's drift hits them alike. Compare\n"
        "times inside one run only. Writes to --out: bench.html (error against time, scaling), bench.json, bench.csv, passes.csv, bench.md. A run that was\n"
        "interrupted goes on where it was.\n\n"
        "Examples:\n"
        "  obscura-bench --scene sponza,atrium --falloff quadratic:2,exponential:1 --out out/front       who is best at every millisecond\n"
        "  obscura-bench --method hbao --set steps=4,8,16 --scene atrium                                 cost and error against samples\n"
        "  obscura-bench --method hybrid --set voxel_structure=dense,nanovdb --scene sponza              two ways to keep voxels\n"
        "  obscura-bench --triangles 10000,100000,1000000 --size 320x180,640x360,1280x720 --flicker 0    how time grows\n"
        "  obscura-bench --scene sponza --compare before/bench.json                                      is anything slower or worse than it was?\n"
        "  obscura-bench --from out/front/bench.json --table README.md                                   the table between README's markers");
    cli.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);  // so that scripts' defaults can be overridden
    evaluate::Judged judged;
    judged.methods = {"all"};
    std::vector<std::string> falloffs{"quadratic:2"}, cameras{"own"}, references{"world", "screen"}, sizes{"640x360"}, triangles;
    std::string flickerSize = "320x180", out = "out/bench";
    uint32_t flickerFrames = 12;
    bool noCache = false;
    using evaluate::takeAll;

    cli.option_defaults()->group("What is looked at");
    takeAll(cli.add_option("--scene", what.scenes, "toasters, atrium, sponza, dragon, or glTF files; several with commas (all that are here)"));
    takeAll(cli.add_option("--triangles", triangles, "Balls on a floor of about so many triangles, to see how time grows with them; instead of --scene, or beside it"));
    takeAll(cli.add_option("--camera", cameras, "own, scene:N, path:FILE@SECONDS, path:@SECONDS, FILE.json; several with commas")->capture_default_str());
    takeAll(cli.add_option("--size", sizes, "WIDTHxHEIGHT in pixels, without guard band; several with commas")->capture_default_str());
    cli.add_option("--guard", what.guard, "Guard band, fraction of each side")->check(CLI::Range(0.0f, 0.5f))->capture_default_str();
    app::addVoxelArguments(cli, what.voxels, cli.option_defaults()->get_group());

    cli.option_defaults()->group("What is measured");
    addJudged(cli, judged,
              "METHOD.PARAMETER=VALUE, or PARAMETER=VALUE for all that have it, or a list of values: each is measured; may be repeated. Whatever traces "
              "voxels also has voxels, voxel_size, voxelizer, voxel_structure and voxel_shell");
    takeAll(cli.add_option("--falloff", falloffs, "KIND:LENGTH in metres, or ramp:START:END; several with commas")->capture_default_str());
    cli.add_option("--rounds", what.rounds, "Times the whole list is run")->check(CLI::Range(1u, 1000u))->capture_default_str();
    cli.add_option("--frames", what.frames, "Timed frames of each in a round")->check(CLI::Range(1u, 100000u))->capture_default_str();
    cli.add_option("--warm-up", what.warmUp, "Frames before those")->check(CLI::Range(0u, 1000u))->capture_default_str();
    takeAll(cli.add_option("--reference", references, "What errors are measured against: world, screen, or none")->capture_default_str());
    cli.add_option("--rays", what.rays.rays, "Rays a pixel of the references")->check(CLI::Range(32u, 65536u))->capture_default_str();
    cli.add_option("--seed", what.rays.seed, "Of the rays")->capture_default_str();
    cli.add_flag("--no-cache", noCache, "Render references anew, keep none (they lie in the user's cache folder)");
    cli.add_option("--flicker", flickerFrames, "Frames of the scene's flythrough that flicker is measured on; 0: it is not")->check(CLI::Range(0u, 10000u))->capture_default_str();
    cli.add_option("--flicker-size", flickerSize, "Their size")->capture_default_str();

    cli.option_defaults()->group("What comes out");
    cli.add_option("--out", out, "Folder of the results")->capture_default_str();
    cli.add_flag("--again", options.again, "Measure anew what the folder holds already");
    cli.add_option("--from", options.from, "Measure nothing: take the bench.json of an earlier run");
    cli.add_option("--table", options.table, "Markdown file whose table between <!-- bench: begin --> and <!-- bench: end --> is written anew");
    cli.add_option("--compare", options.compare, "bench.json of an earlier run: print ratios with confidence intervals, fail when something is worse beyond noise");
    cli.add_option("--tolerance", options.tolerance, "By which the time of a row may grow beyond its noise")->check(CLI::Range(0.0, 10.0))->capture_default_str();
    cli.add_flag("--absolute", options.absolute, "Compare milliseconds as they are; else as shares of their round, so that a slower machine is no regression");
    evaluate::addDevice(cli, what.device, what.validation, what.verbose);

    if (!app::parse(cli, argc, argv)) return std::nullopt;
    options.command = evaluate::commandOf("obscura-bench", argc, argv);
    options.out = out;
    if (!options.from.empty()) {
        for (const char* option : {"--scene", "--triangles", "--method", "--preset", "--set", "--falloff", "--size", "--camera"})
            if (cli.count(option)) throw Complaint(fmt::format("{}: --from takes everything from its file; leave one of them out", option));
        if (!cli.count("--out")) options.out.clear();  // tables and comparisons need no folder
        return options;
    }
    options.triangles = trianglesOf(triangles);
    if (what.scenes.empty() && options.triangles.empty())
        for (const evaluate::SceneFile& scene : evaluate::namedScenes())
            if (!scene.file.empty()) what.scenes.push_back(scene.name);
    for (const std::string& size : sizes) options.sizes.push_back(app::sizeOf(size));
    for (const std::string& camera : cameras) what.cameras.push_back(evaluate::cameraOf(camera));
    what.falloffs = evaluate::falloffs(falloffs);
    what.candidates = evaluate::variants(judged.methods, judged.presets, judged.allSets());
    for (const std::string& reference : references) {
        if (reference == "world") what.reference.world = true;
        else if (reference == "screen") what.reference.screen = true;
        else if (reference != "none" || references.size() > 1)
            throw Complaint(fmt::format("--reference {}: {}", reference, reference == "none" ? "none stands alone" : app::choices(reference, {"world", "screen", "none"})));
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
    if (!options.triangles.empty() && std::any_of(what.cameras.begin(), what.cameras.end(), [](const auto& c) { return c.kind == evaluate::CameraChoice::Kind::path; }))
        throw Complaint("--triangles: generated scenes have no flythrough; leave out --camera path:...");
    return options;
}

}  // namespace obscura::bench
