#include "options.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "ao/library.h"
#include "app/arguments.h"
#include "app/complaint.h"
#include "app/content.h"
#include "app/voxel_arguments.h"
#include "measure/arguments.h"
#include "scene/hash.h"

namespace obscura::evaluate {

namespace fs = std::filesystem;
using app::Complaint;

namespace {

constexpr const char* kGallery = "gallery.html";  // default name of the page

measure::ReferenceChoice referenceOf(const std::vector<std::string>& words, const std::string& channel) {
    measure::ReferenceChoice choice;
    choice.channel = channel;
    for (const std::string& word : words) {
        if (word == "world") choice.world = true;
        else if (word == "screen") choice.screen = true;
        else if (fs::path(word).extension() != ".exr")
            throw Complaint(fmt::format("--reference {}: {}, or an EXR file", word, app::choices(word, {"world", "screen"})));
        else if (!choice.file.empty()) throw Complaint(fmt::format("--reference {}: one file at a time", word));
        else choice.file = word;
    }
    if (!channel.empty() && choice.file.empty())
        throw Complaint(fmt::format("--channel {}: names a channel of an EXR file; give one with --reference FILE.exr", channel));
    return choice;
}

void listMethods() {
    for (const ao::MethodInfo* info : ao::methods()) {
        std::string presets;
        for (const ao::Preset& preset : info->presets) presets += std::string(presets.empty() ? "" : ", ") + preset.id;
        fmt::print("{:<18}{}; presets: {}\n", info->id, info->title, presets);
    }
}

void listScenes() {
    for (const app::SceneFile& scene : app::namedScenes())
        fmt::print("{:<12}{}\n", scene.info.name, scene.file.empty() ? "not found; " + scene.info.howToGet : scene.file.string());
}

void expectTogether(const Options& options, bool hasSceneOptions) {
    if (options.job == Job::checkBaseline || options.job == Job::renewBaseline) {
        if (!options.capture.empty() || !options.scenes.empty())
            throw Complaint("a baseline names its own scenes: leave out --scene and --capture");
        return;
    }
    if (options.capture.empty() != options.captureCamera.empty())
        throw Complaint(
            options.capture.empty()
                ? "--camera: FILE.json of a captured frame needs --capture FRAME.exr, one of a scene --scene NAME"
                : fmt::format("--capture {}: needs --camera FILE.json with its field of view and guard band", options.capture.string()));
    if (!options.capture.empty() && hasSceneOptions)
        throw Complaint(
            "--capture: a captured frame has its own scene, size and time; leave out --scene, --animation, --size, --time, --guard and "
            "--skip-masked");
    if (options.capture.empty() && options.scenes.empty())
        throw Complaint("no frame: give --scene NAME, or --capture FRAME.exr with --camera FRAME.json");
    if (!options.capture.empty() && options.reference.world)
        throw Complaint("--reference world: a captured frame has no triangles; give screen, or a rendered reference as FILE.exr");
}

}  // namespace

std::optional<Options> parseOptions(int argc, const char* const* argv) {
    Options options;
    CLI::App cli{
        "Measures ambient-obscurance methods against ray-traced references: error tables, pictures, an HTML page, and a baseline for "
        "regressions.",
        "obscura-evaluate"};
    cli.set_help_flag("-h,--help", "Print this and exit");
    cli.set_version_flag("--version", "Obscura " OBSCURA_VERSION);
    cli.footer(
        "Examples:\n"
        "  obscura-evaluate --scene sponza --method hbao --preset all --reference world,screen --out out/hbao\n"
        "  obscura-evaluate --capture frame.exr --camera frame.json --method all --json errors.json\n"
        "  obscura-evaluate --gallery gallery.html\n"
        "  obscura-evaluate --renew-baseline tests/accuracy/baseline.json");
    cli.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);  // so that scripts' defaults can be overridden
    measure::CandidateOptions chosen;
    std::vector<std::string> falloffTexts, cameras, references;
    std::string size, channel, page, check, renew, capture;
    float time = 0.0f;
    bool list = false, scenesListed = false, noCache = false;

    cli.option_defaults()->group("Frames");
    cli.add_option("--capture", capture, "EXR of a captured frame: Z, and N.X N.Y N.Z where there are normals; needs --camera FILE.json");
    auto* scene =
        measure::takeAll(cli.add_option("--scene", options.scenes, "toasters, atrium, sponza, dragon, or glTF files; several with commas"));
    measure::takeAll(cli.add_option("--camera", cameras,
        "own (the view of scenes.json), scene:N, path:FILE@SECONDS, path:@SECONDS (the scene's flythrough), FILE.json; several with "
        "commas"));
    auto* animation = cli.add_option("--animation", options.animation, "Animation of the scenes: NAME or number, all together, or none")
                          ->capture_default_str();
    auto* timeOption = cli.add_option("--time", time, "Seconds into the animation (default: 0; on a flythrough the path's time)");
    auto* sizeOption =
        cli.add_option("--size", size, "WIDTHxHEIGHT in pixels, without guard band (default: 640x360; with --gallery 480x270)");
    auto* guard =
        cli.add_option("--guard", options.guard, "Guard band, fraction of each side")->check(CLI::Range(0.0f, 0.5f))->capture_default_str();
    auto* masked = cli.add_flag(
        "--skip-masked", options.skipMasked, "Leave alpha-masked surfaces out of frame and reference, as stored references do");

    app::addVoxelArguments(cli, options.voxels, cli.option_defaults()->get_group());

    cli.option_defaults()->group("Methods");
    measure::addCandidateOptions(cli, chosen);
    cli.add_option("--resolve", chosen.resolve,
        "Noise removal: raw (none), spatial (the method's blur), or temporal (blur and history); default: as in the preset");
    measure::takeAll(cli.add_option("--falloff", falloffTexts,
        "KIND:LENGTH in metres (default: quadratic:2); exponential, linear, quadratic, wendland, constant, or ramp:START:END"));
    auto* frames = cli.add_option("--frames", options.frames, "Timed frames; medians are reported (default: 12; with --gallery 7)")
                       ->check(CLI::Range(1u, 100000u));
    cli.add_option("--warm-up", options.warmUp, "Untimed frames before those")->check(CLI::Range(0u, 1000u))->capture_default_str();
    cli.add_option("--rounds", options.rounds,
           "Number of rounds; each runs all settings once, so that drift of the machine affects all equally; times are medians over rounds")
        ->check(CLI::Range(1u, 1000u))
        ->capture_default_str();

    cli.option_defaults()->group("References");
    measure::takeAll(cli.add_option(
        "--reference", references, "world (rays against the triangles), screen (rays through the depth buffer), or an EXR of obscurance"));
    cli.add_option("--channel", channel, "Channel of that EXR (default: named after the falloff, world.quadratic_2)");
    auto* rays = cli.add_option("--rays", options.rays.rays, "Maximum of rays per pixel (default: 4096; with --gallery 256)")
                     ->check(CLI::Range(32u, 1048576u));
    cli.add_option("--target-error", options.rays.targetError, "Standard error at which tracing a pixel stops; 0: always all rays")
        ->check(CLI::Range(0.0f, 1.0f))
        ->capture_default_str();
    cli.add_option("--seed", options.rays.seed, "Seed of the rays")->capture_default_str();
    auto* every = cli.add_option("--every", options.rays.every,
                         "Trace and evaluate only every N-th pixel of each row and column: 1/(N N) of the time, no SSIM and FLIP")
                      ->check(CLI::Range(1u, 64u))
                      ->capture_default_str();
    cli.add_flag("--no-cache", noCache, "Trace references again and do not cache them (default: cached in the user's cache folder)");

    cli.add_flag("--bent-normals", options.bentNormals,
        "Also measure bent normals, of the methods that have them: mean angle to the world reference's mean unblocked direction, and error "
        "of the sample's ambient light with the normal and with the bent normal; --out gets their pictures");

    cli.option_defaults()->group("Output");
    cli.add_option("--json", options.json, "File of one object per method, preset, falloff and reference");
    cli.add_option("--out", options.out,
        "Folder for visibility (EXR, PNG), error pictures, references, metrics.json, metrics.md, and all files that are named without a "
        "folder");
    cli.add_option("--capture-out", options.captureOut, "Write the frame as NAME.capture.exr and NAME.json");
    auto* gallery =
        cli.add_option("--gallery", page, "One HTML page of every method on a list of scenes, cameras and falloffs (default: gallery.html)")
            ->expected(0, 1)
            ->default_str(kGallery);
    auto* checkOption = cli.add_option("--check-baseline", check, "Fail if a method's error exceeds this baseline");
    auto* renewOption =
        cli.add_option("--renew-baseline", renew, "Measure and write this baseline (with --method: only the cells of those methods)");
    gallery->excludes(checkOption)->excludes(renewOption);
    checkOption->excludes(renewOption);
    every->excludes(gallery)->excludes(checkOption)->excludes(renewOption);  // pages and baselines need all pixels

    measure::addDevice(cli, options.device, options.validation, options.verbose);
    cli.add_flag("--list-methods", list, "Print the methods and their presets");
    cli.add_flag("--list-scenes", scenesListed, "Print the named scenes and their files");

    if (!app::parse(cli, argc, argv)) return std::nullopt;
    if (list || scenesListed) {
        list ? listMethods() : listScenes();
        return std::nullopt;
    }

    if (*gallery) {
        options.job = Job::gallery;
        if (cli.count("--method") == 0) chosen.methods = {"all"};
        if (falloffTexts.empty()) falloffTexts = {"quadratic:2", "exponential:1"};
        if (references.empty()) references = {"world", "screen"};
        if (!*frames) options.frames = 7;
        if (!*rays) options.rays.rays = 256;
        if (!*sizeOption) options.size = {480, 270};
        if (!*scene && capture.empty())
            for (const app::SceneFile& known : app::namedScenes())
                if (!known.file.empty()) options.scenes.push_back(known.info.name);
    } else if (*checkOption || *renewOption) {
        options.job = *checkOption ? Job::checkBaseline : Job::renewBaseline;
        options.baseline = *checkOption ? check : renew;
        if (cli.count("--method") == 0) chosen.methods = {"all"};
        if (cli.count("--preset") == 0) chosen.presets = {"all"};
    }
    options.capture = capture;
    if (!capture.empty()) {
        if (cameras.size() > 1) throw Complaint("--camera: a captured frame has one camera, FILE.json");
        if (!cameras.empty()) options.captureCamera = cameras.front();
    } else {
        for (const std::string& camera : cameras) options.cameras.push_back(measure::cameraOf(camera));
        if ((options.usualCameras = options.cameras.empty())) options.cameras.push_back(measure::cameraOf("own"));
        if (options.usualCameras && options.job == Job::gallery) options.cameras.push_back(measure::cameraOf("path:@4"));
    }
    const std::vector<std::string> sets = chosen.allSets();
    if (!sets.empty() && options.job == Job::renewBaseline) throw Complaint("--set: a baseline holds presets as they are");
    if (references.empty()) references = {capture.empty() ? "world" : "screen"};
    options.candidates = measure::candidates(chosen.methods, chosen.presets, sets);
    options.falloffs = measure::falloffs(falloffTexts.empty() ? std::vector<std::string>{"quadratic:2"} : falloffTexts);
    options.reference = referenceOf(references, channel);
    if (*timeOption && !std::isfinite(time)) throw Complaint("--time: must be a finite number of seconds");
    if (*timeOption) options.time = time;
    if (!size.empty()) options.size = app::sizeOf(size);
    if (*gallery) options.page = page;
    for (fs::path* file : {&options.json, &options.page, &options.captureOut})
        if (!file->empty() && !file->has_parent_path()) *file = options.out / *file;
    options.rays.cache = !noCache;
    if (!noCache) options.voxels.cache = scene::cacheFolder();
    if (options.bentNormals) {
        bool any = false;
        for (measure::Candidate& candidate : options.candidates) any |= candidate.values.bentNormals = candidate.info().bentNormals;
        if (!any) throw Complaint(fmt::format("--bent-normals: none of the chosen methods has them; {} do", ao::bentNormalsFrom()));
        if (!options.reference.world) throw Complaint("--bent-normals: only --reference world has directions to compare with");
        if (options.job != Job::evaluate) throw Complaint("--bent-normals: not for pages and baselines");
        options.rays.bentNormals = true;
    }
    expectTogether(options, *scene || *animation || *timeOption || *sizeOption || *guard || *masked);
    return options;
}

}  // namespace obscura::evaluate
