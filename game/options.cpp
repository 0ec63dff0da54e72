#include "options.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/arguments.h"
#include "app/complaint.h"
#include "app/voxel_arguments.h"
#include "keys.h"
#include "scene/hash.h"
#include "settings.h"

namespace obscura::game {

using app::Complaint;

namespace {

glm::vec3 vectorOf(const char* option, const std::string& text) {
    const std::vector<float> list = app::numbers(text, ',');
    if (list.size() != 3) throw Complaint(fmt::format("{} {}: write three numbers with commas, metres: 1.5,1.7,-2", option, text));
    return {list[0], list[1], list[2]};
}

render::VoxelSlice sliceOf(const std::string& text) {
    render::VoxelSlice slice;
    slice.axis = text[0] - 'x';
    const std::vector<float> at = text.size() > 2 && text[1] == ':' ? app::numbers(text.substr(2), ',') : std::vector<float>();
    if (slice.axis < 0 || slice.axis > 2 || (text.size() > 1 && at.size() != 1))
        throw Complaint(fmt::format("--voxel-slice {}: write x, y or z, or an axis and metres: y:1.2", text));
    if (!at.empty()) slice.at = at[0];
    return slice;
}

CameraChoice cameraOf(const std::string& text) {
    CameraChoice camera;
    if (text.starts_with("scene:")) {
        const std::vector<float> index = app::numbers(text.substr(6), ',');
        if (index.size() != 1 || index[0] < 0.0f || index[0] != std::floor(index[0]))
            throw Complaint(fmt::format("--camera {}: write scene:N, N counting the file's cameras from 0", text));
        camera.kind = CameraChoice::Kind::lens;
        camera.lens = int(index[0]);
    } else if (text.starts_with("path:")) {
        camera.kind = CameraChoice::Kind::path;
        const size_t mark = text.rfind('@');
        camera.file = text.substr(5, mark == std::string::npos ? mark : mark - 5);
        if (mark != std::string::npos) {
            const std::vector<float> at = app::numbers(text.substr(mark + 1), ',');
            if (at.size() != 1) throw Complaint(fmt::format("--camera {}: after @ comes a time in seconds", text));
            camera.at = at[0];
        }
    } else {
        camera.kind = CameraChoice::Kind::file;
        camera.file = text;
    }
    return camera;
}

std::optional<Options> parse(const std::vector<std::string>& words) {
    Options options;
    options.commandLine = fmt::format("{}", fmt::join(words, " "));

    CLI::App cli{"Obscura: walk through a scene and switch its ambient-obscurance method while it moves.", "obscura"};
    cli.set_help_flag("-h,--help", "Print this and exit");
    cli.set_version_flag("--version", "Obscura " OBSCURA_VERSION);
    cli.footer(keyPage(true) +
               "\nEnvironment:\n"
               "  OBSCURA_CONTENT      another folder of scenes, searched after content/\n"
               "  OBSCURA_SHADERS      the shaders folder whose edits are reloaded\n"
               "  OBSCURA_DEVICE       default of --device\n"
               "  OBSCURA_VALIDATION   1 or sync, as --validation core or sync\n"
               "  XDG_CONFIG_HOME      folder of obscura/settings, which the window remembers (default: ~/.config)\n"
               "\nExit codes: 0 success, 1 device or system failure, 2 invalid input, 3 validation messages\n");
    cli.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);  // so that scripts' defaults can be overridden
    std::string method, preset, resolve, offscreen, falloff, compare, view = "final", antialiasing = "taa", slice, size, camera, path, eye,
                                                                      target;
    std::vector<std::string> assignments;
    bool headless = false, listMethods = false, listScenes = false, listScene = false, listDevices = false, flythrough = false,
         noVsync = false, noSettings = false;
    double budget = 0.0;
    float uiScale = 1.0f;
    uint32_t frames = 1, switchTest = 0;
    float fov = 60.0f;

    const char* kPicture = "Picture";
    cli.add_option("--scene", options.scene, "toasters, atrium, sponza, dragon, or the path of a glTF file")
        ->group(kPicture)
        ->capture_default_str();
    cli.add_option("--method", method, "Obscurance method, by its id (--list-methods)")->group(kPicture);
    cli.add_option("--preset", preset, "Preset of that method")->group(kPicture);
    cli.add_option("--resolve", resolve,
           "Noise removal: raw (none), spatial (the method's blur), temporal (blur and history; the window's default) or preset (as the "
           "preset "
           "says; the default without a window)")
        ->group(kPicture);
    cli.add_option("--set", assignments, "METHOD.PARAMETER=VALUE, or PARAMETER=VALUE for the chosen method; may be repeated")
        ->group(kPicture)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    cli.add_option("--offscreen", offscreen, app::kOffScreenHelp)->group(kPicture);
    cli.add_option("--falloff", falloff, "KIND:LENGTH in metres; exponential, linear, quadratic, wendland, constant, or ramp:START:END")
        ->group(kPicture);
    std::vector<std::string> views;
    for (const render::View known : render::kViews) views.emplace_back(render::name(known));
    cli.add_option("--view", view, fmt::format("{}, or pass:NAME", fmt::join(views, ", ")))->group(kPicture)->capture_default_str();
    cli.add_option(
           "--compare", compare, "METHOD[:PRESET][,PARAMETER=VALUE...]: a second setting B on the same frames, shown right of a divider")
        ->group(kPicture);
    cli.add_option("--split", options.split, "Position of the divider, fraction of the width")
        ->group(kPicture)
        ->check(CLI::Range(0.0f, 1.0f))
        ->capture_default_str();
    cli.add_option("--difference-range", options.differenceRange, "Difference of visibility at which the difference views saturate")
        ->group(kPicture)
        ->check(CLI::Range(0.001f, 1.0f))
        ->capture_default_str();
    cli.add_option("--animation", options.animation, "Animation of the scene: NAME or number, all together, or none (--list-scene)")
        ->group(kPicture)
        ->capture_default_str();
    auto* timeOption =
        cli.add_option("--time", options.time, "Seconds into the animation at the first frame")->group(kPicture)->capture_default_str();
    cli.add_option("--guard", options.guard, "Guard band around the picture, fraction of each side")
        ->group(kPicture)
        ->check(CLI::Range(0.0f, 0.5f))
        ->capture_default_str();
    cli.add_option("--aa", antialiasing, "Anti-aliasing of the final picture: taa (temporal: jitter, mean over frames) or none")
        ->group(kPicture)
        ->check(CLI::IsMember({"taa", "none"}))
        ->capture_default_str();
    cli.add_flag("--bent-normals", options.bentNormals, "Take ambient light from bent normals, of methods that have them");
    cli.add_option("--exposure", options.exposure, "Factor on the light before tone mapping")
        ->group(kPicture)
        ->check(CLI::Range(0.001f, 1000.0f))
        ->capture_default_str();
    cli.add_option("--toys", options.toys, "Walking toasters dropped at the start, in addition to the scene's own")
        ->group(kPicture)
        ->check(CLI::Range(0u, 64u))
        ->capture_default_str();
    cli.add_flag(
           "--bare", options.bare, "Leave out the toasters that the game adds to a scene, as obscura-evaluate and obscura-flythrough do")
        ->group(kPicture);
    cli.add_flag("--skip-masked", options.skipMasked, "Leave out alpha-masked surfaces (leaves, chains), as stored references do")
        ->group(kPicture);

    app::addVoxelArguments(cli, options.voxels, kPicture);
    cli.add_option(
           "--voxel-slice", slice, "AXIS or AXIS:METRES: the layer that --view voxel-slice shows, x, y or z; default: at the camera")
        ->group(kPicture);

    const char* kCamera = "Camera";
    auto* cameraOption =
        cli.add_option("--camera", camera, "FILE.json, scene:N (the glTF's N-th camera), path:FILE.json or path:FILE.json@SECONDS")
            ->group(kCamera);
    auto* pathOption =
        cli.add_option("--path", path,
               "Replay FILE.json (key R records one) in steps of 1/30 s of world time, from its first key or --time; headless: to its end")
            ->group(kCamera)
            ->excludes(cameraOption);
    cli.add_flag("--flythrough", flythrough, "Follow the scene's flythrough, unless another camera is given")->group(kCamera);
    auto* eyeOption = cli.add_option("--eye", eye, "X,Y,Z of the camera, metres")->group(kCamera);
    auto* targetOption = cli.add_option("--target", target, "X,Y,Z it looks at")->group(kCamera);
    auto* fovOption = cli.add_option("--fov", fov, "Vertical field of view, degrees")->group(kCamera)->check(CLI::Range(1.0f, 170.0f));
    cameraOption->excludes(eyeOption);
    pathOption->excludes(eyeOption);
    eyeOption->needs(targetOption);
    targetOption->needs(eyeOption);

    const char* kRun = "Run";
    cli.add_flag("--headless", headless, "Render without a window or display")->group(kRun);
    auto* framesOption = cli.add_option("--frames", frames, "Frames to render, then stop (headless default: 1)")
                             ->group(kRun)
                             ->check(CLI::Range(1u, 1000000u));
    cli.add_option("--step", options.step, "World time of a headless frame, seconds; 0 keeps the time fixed")
        ->group(kRun)
        ->check(CLI::Range(0.0f, 10.0f))
        ->capture_default_str();
    cli.add_option("--size", size, "WIDTHxHEIGHT of the picture or window, pixels (1280x720)")->group(kRun);
    cli.add_option("--screenshot", options.screenshot, "PNG of the last frame")->group(kRun);
    cli.add_option("--out", options.out,
           "Folder for every frame as PNG, summary.html and timings.json, and all files that are named without a folder")
        ->group(kRun);
    cli.add_flag("--measure", options.measure,
           "Measure noise and flicker, and errors where obscura-flythrough has cached a frame's reference; --out: measures.csv")
        ->group(kRun);
    auto* switchOption =
        cli.add_option("--switch-test", switchTest, "Run every method this many frames, then switch at each frame; report the worst")
            ->group(kRun)
            ->check(CLI::Range(1u, 10000u));
    auto* budgetOption = cli.add_option("--budget", budget,
                                "GPU time for obscurance, ms; the window starts with the most accurate method within it, unless "
                                "a method is given (default: 2, on a software device 60)")
                             ->group(kRun)
                             ->check(CLI::Range(0.01, 10000.0));
    auto* scaleOption = cli.add_option("--ui-scale", uiScale, "Size of the panels' text, 1 for small screens (default: by the monitor)")
                            ->group(kRun)
                            ->check(CLI::Range(0.5f, 4.0f));
    cli.add_flag("--no-settings", noSettings, "Neither use nor write the settings that the window keeps from one start to the next")
        ->group(kRun);
    cli.add_flag("--full-screen", options.fullScreen, "Start in full screen")->group(kRun);
    cli.add_flag("--no-vsync", noVsync, "Present without waiting for vertical sync")->group(kRun);
    cli.add_flag("--no-present", options.noPresent, "Behave as on a device that cannot present")->group(kRun);

    const char* kDevice = "Device";
    cli.add_option("--device", options.device, "Part of the name of the Vulkan device to use (--list-devices)")->group(kDevice);
    cli.add_option("--validation", options.validation, "Vulkan validation: off, core, or sync (core and synchronization)")
        ->group(kDevice)
        ->check(CLI::IsMember({"off", "core", "sync"}))
        ->capture_default_str();
    auto* cacheOption =
        cli.add_option("--pipeline-cache", options.pipelineCache, "Pipeline cache file (default: in the user's cache folder)")
            ->group(kDevice);
    cli.add_flag("--no-pipeline-cache", options.noPipelineCache, "Do not read or write a pipeline cache")
        ->group(kDevice)
        ->excludes(cacheOption);
    cli.add_flag("--verbose", options.verbose, "Print the renderer's log and start-up times")->group(kDevice);

    const char* kLists = "Lists";
    auto* methodsFlag = cli.add_flag("--list-methods", listMethods, "Print every method with its parameters and presets")->group(kLists);
    cli.add_flag("--json", options.json, "Print the list of methods as JSON")->group(kLists)->needs(methodsFlag);
    cli.add_flag("--list-scenes", listScenes, "Print the named scenes and their files")->group(kLists);
    cli.add_flag("--list-scene", listScene, "Print the cameras, animations, variants and extensions of --scene")->group(kLists);
    cli.add_flag("--list-devices", listDevices, "Print the Vulkan devices")->group(kLists);

    std::vector<const char*> argv;
    for (const std::string& word : words) argv.push_back(word.c_str());
    if (!app::parse(cli, int(argv.size()), argv.data())) return std::nullopt;

    if (listMethods) options.job = Job::listMethods;
    else if (listScenes) options.job = Job::listScenes;
    else if (listScene) options.job = Job::listScene;
    else if (listDevices) options.job = Job::listDevices;
    else if (headless) options.job = Job::headless;
    if (!std::isfinite(options.time)) throw Complaint("--time: must be a finite number of seconds");
    if (!size.empty()) {
        const glm::uvec2 wanted = app::sizeOf(size);
        options.size = {wanted.x, wanted.y};
    }
    if (!options.screenshot.empty() && !options.screenshot.has_parent_path()) options.screenshot = options.out / options.screenshot;
    if (*framesOption) options.frames = frames;
    if (*switchOption) options.switchTest = switchTest;
    options.vsync = !noVsync;
    options.antialiasing = antialiasing == "taa" ? render::Antialiasing::temporal : render::Antialiasing::none;
    options.voxels.cache = scene::cacheFolder();
    if (!slice.empty()) options.slice = sliceOf(slice);
    if (flythrough) options.camera.kind = CameraChoice::Kind::flythrough;
    if (*cameraOption) options.camera = cameraOf(camera);
    if (*pathOption) {
        options.camera.kind = CameraChoice::Kind::path;
        options.camera.file = path;
        options.camera.replay = true;
        if (*timeOption) options.camera.start = options.time;
    }
    if (*eyeOption) {
        options.camera.kind = CameraChoice::Kind::fixed;
        options.camera.eye = vectorOf("--eye", eye);
        options.camera.target = vectorOf("--target", target);
        if (options.camera.eye == options.camera.target) throw Complaint("--target: must differ from --eye");
    }
    if (*fovOption) options.camera.fovDegrees = fov;
    if (*budgetOption) options.budget = budget;
    if (*scaleOption) options.uiScale = uiScale;
    if (!method.empty()) options.choice.select(method);
    if (!preset.empty()) options.choice.applyPreset(preset);
    if (!resolve.empty()) options.choice.applyResolve(resolve);
    if (options.job == Job::play) options.choice.resolveAll(resolve.empty() ? "temporal" : resolve);
    options.namesMethod = !method.empty() || !preset.empty() || !resolve.empty() || !assignments.empty();
    if (!offscreen.empty()) options.choice.assignToAll("offscreen", offscreen);
    for (const std::string& assignment : assignments) options.choice.assign(assignment);
    if (!falloff.empty()) options.choice.setFalloff(falloff);
    if (!render::parseView(view, options.view, options.passView)) {
        throw Complaint(fmt::format("--view {}: no such view; {}, pass:NAME", view, app::choices(view, views)));
    }
    if (!compare.empty()) options.compare.emplace().read(compare);
    if (render::isDifference(options.view) && !options.compare)
        throw Complaint(fmt::format("--view {}: needs two methods; give the second with --compare", view));
    if (!noSettings) options.settings = settingsFile();
    return options;
}

}  // namespace

std::optional<Options> parseOptions(int argc, const char* const* argv) {
    const std::vector<std::string> words(argv, argv + argc);
    std::optional<Options> options = parse(words);
    if (!options || options->job != Job::play || options->settings.empty()) return options;
    try {
        // Remembered settings stand before the command line, which overrides them; a method there is not mixed with a remembered one.
        std::vector<std::string> all{words.front()};
        for (const auto& [option, value] : readSettings(options->settings)) {
            const bool ofMethod = option == "--method" || option == "--preset" || option == "--resolve" || option == "--set";
            if (ofMethod && options->namesMethod) continue;
            all.push_back(option);
            if (!value.empty()) all.push_back(value);
        }
        all.insert(all.end(), words.begin() + 1, words.end());
        std::optional<Options> remembered = parse(all);
        remembered.value().commandLine = options->commandLine;
        return remembered;
    } catch (const std::exception& error) {
        fmt::print(stderr, "obscura: the settings of the last start are not used: {}\n", error.what());
        return options;
    }
}

}  // namespace obscura::game
