#include "options.h"

#include <charconv>
#include <cstdio>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/arguments.h"
#include "app/complaint.h"
#include "measure/arguments.h"

namespace obscura::flythrough {

using app::Complaint;

namespace {

// "a:b", frames a to b - 1 of `length`.
void setFrames(const std::string& text, Settings& settings) {
    settings.first = 0;
    settings.end = settings.length;
    if (text.empty()) return;
    const std::vector<float> range = app::numbers(text, ':');
    const bool valid = range.size() == 2 && range[0] >= 0.0f && range[0] < range[1] && range[0] == float(uint32_t(range[0])) &&
                       range[1] == float(uint32_t(range[1]));
    if (!valid || range[1] > float(settings.length))
        throw Complaint(fmt::format(
            "--frames {}: write FIRST:END, such as 0:16; the flythrough has frames 0 to {} (--length)", text, settings.length - 1));
    settings.first = uint32_t(range[0]);
    settings.end = uint32_t(range[1]);
}

void listFlythroughs() {
    for (const Script& script : scripts())
        fmt::print("{:<18}{} ({}{})\n", script.name, script.title, script.scene,
            script.events.empty() ? "" : fmt::format(", {} events", script.events.size()));
}

}  // namespace

std::optional<Options> parseOptions(int argc, const char* const* argv) {
    Options options;
    CLI::App cli{
        "Renders camera flights through animated scenes with every method and measures, against ray-traced references, errors, "
        "flicker, noise and lag.",
        "obscura-flythrough"};
    cli.set_help_flag("-h,--help", "Print this and exit");
    cli.set_version_flag("--version", "Obscura " OBSCURA_VERSION);
    cli.footer(
        "Writes to --out: frames/ (PNG), one MP4 per method and one side by side, frames.csv, events.csv, static.csv, passes.csv, "
        "report.json, report.md and\n"
        "report.html. An interrupted run resumes with the same command.\n\n"
        "Examples:\n"
        "  obscura-flythrough --flythrough teleport --method hbao,horizon_split --out out/teleport\n"
        "  obscura-flythrough --scene model.glb --camera orbit,scene:0 --method all --out out/model\n"
        "  obscura-flythrough --flythrough all --method all --print-jobs 8 --out /share/run | parallel\n"
        "  obscura-flythrough --merge /share/run/part-0,/share/run/part-1 --out /share/run/all");
    cli.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);  // so that scripts' defaults can be overridden
    measure::CandidateOptions chosen;
    std::vector<std::string> filters{"raw", "spatial", "temporal"}, merged;
    std::vector<std::string> flythroughs, scenes, cameras;
    std::string animation = "all";
    std::string size, frames, falloff, out = "out/flythrough", check, renew;
    bool list = false, noPictures = false, noVideo = false, noCache = false;
    using measure::takeAll;

    cli.option_defaults()->group("Flythrough");
    takeAll(cli.add_option("--flythrough", flythroughs,
        "By name, several with commas, or all (content/flythroughs.json; --list prints them), or FILE.json, a path recorded by the game"));
    takeAll(cli.add_option("--scene", scenes, "Instead: toasters, atrium, sponza, dragon, or glTF files; several with commas"));
    auto* cameraOption = takeAll(cli.add_option("--camera", cameras,
        "How --scene is seen: orbit (default), scene:N (the glTF's N-th camera, animated with it), path:FILE.json@SECONDS, "
        "path:@SECONDS (the scene's flythrough), own, or FILE.json; several with commas"));
    auto* animationOption =
        cli.add_option("--animation", animation, "Animation of --scene: NAME or number, all together, or none")->capture_default_str();
    cli.add_option("--length", options.settings.length, "Frames of the whole flythrough")
        ->check(CLI::Range(2u, 100000u))
        ->capture_default_str();
    cli.add_option("--frames", frames, "FIRST:END: measure only these frames, to split a run over machines (--merge joins the chunks)");
    auto* sizeOption = cli.add_option("--size", size, "WIDTHxHEIGHT in pixels, without guard band (default: 320x180)");
    cli.add_option("--guard", options.settings.guard, "Guard band, fraction of each side")
        ->check(CLI::Range(0.0f, 0.5f))
        ->capture_default_str();

    cli.option_defaults()->group("Methods");
    addCandidateOptions(cli, chosen);
    takeAll(
        cli.add_option("--modes,--filter", filters,
               "Resolve presets: raw (no blur, no history), spatial (the preset's blur), temporal (blur and history)")
            ->capture_default_str());
    cli.add_option("--falloff", falloff, "KIND:LENGTH; replaces the flythrough's falloff");
    cli.add_option("--rays", options.settings.rays, "Rays per pixel of the references")
        ->check(CLI::Range(32u, 65536u))
        ->capture_default_str();
    cli.add_option("--seed", options.settings.seed, "Seed of the rays")->capture_default_str();
    cli.add_flag("--no-cache", noCache, "Trace references again and do not cache them (default: cached in the user's cache folder)");

    cli.option_defaults()->group("Output");
    cli.add_option("--out", out, "Folder of the results")->capture_default_str();
    cli.add_flag("--no-pictures", noPictures, "No pictures and no videos");
    cli.add_flag("--no-video", noVideo, "No videos (they need ffmpeg)");
    cli.add_flag("--again", options.again, "Measure again instead of resuming from the folder");
    takeAll(cli.add_option("--merge", merged, "Folders of runs over chunks of the frames: join them in --out, measure nothing"));
    cli.add_option(
           "--print-jobs", options.jobs, "Split the run into this many commands, print them one per line (for GNU parallel), and exit")
        ->check(CLI::Range(1u, 100000u));
    cli.add_flag("--slurm", options.slurm, "With --print-jobs: print a Slurm array script for sbatch");
    auto* checkOption = cli.add_option("--check-baseline", check, "Fail if a method's flicker, noise or lag exceeds this baseline");
    cli.add_option("--renew-baseline", renew, "Measure and write this baseline (with --method: only the rows of those methods)")
        ->excludes(checkOption);

    measure::addDevice(cli, options.device, options.validation, options.verbose);
    cli.add_flag("--list", list, "Print the names of the flythroughs");

    if (!app::parse(cli, argc, argv)) return std::nullopt;
    if (list) {
        listFlythroughs();
        return std::nullopt;
    }

    options.settings.out = out;
    options.settings.pictures = !noPictures;
    options.settings.cache = !noCache;
    options.video = !noPictures && !noVideo;
    for (const std::string& folder : merged) options.merged.emplace_back(folder);
    if (!merged.empty()) {
        options.job = Job::merge;
        return options;
    }
    const bool gate = !check.empty() || !renew.empty();
    if (gate) {
        options.job = check.empty() ? Job::renewBaseline : Job::checkBaseline;
        options.baseline = check.empty() ? renew : check;
        if (cli.count("--method") == 0) chosen.methods = {"all"};
    } else if (flythroughs.empty() && scenes.empty()) {
        throw Complaint("no flythrough: give --flythrough NAME, or all (--list prints the names), or --scene FILE.gltf");
    }
    if (scenes.empty() && (*cameraOption || *animationOption))
        throw Complaint(fmt::format("{}: needs --scene; a flythrough has a camera of its own", *cameraOption ? "--camera" : "--animation"));
    if (flythroughs == std::vector<std::string>{"all"}) {
        flythroughs.clear();
        for (const Script& script : scripts()) flythroughs.push_back(script.name);
    }
    for (const std::string& flythrough : flythroughs) options.scripts.push_back(findScript(flythrough));
    if (cameras.empty()) cameras = {"orbit"};
    for (const app::SceneFile& scene : app::expectScenes(scenes))
        for (const std::string& camera : cameras) options.scripts.push_back(sceneScript(scene, camera, animation));
    options.candidates = measure::candidates(chosen.methods, chosen.presets, chosen.allSets());
    for (const std::string& filter : filters) options.filters.push_back(&measure::resolvePreset("--modes " + filter, filter));
    if (*sizeOption) options.settings.size = app::sizeOf(size);
    if (!falloff.empty()) options.settings.falloff = measure::falloffs({falloff})[0];
    setFrames(frames, options.settings);
    if (options.slurm && !options.jobs) throw Complaint("--slurm: needs --print-jobs N, the number of jobs");
    if (options.jobs) {
        if (!frames.empty()) throw Complaint("--print-jobs: splits all frames; leave out --frames");
        if (options.jobs > options.settings.length)
            throw Complaint(fmt::format("--print-jobs {}: there are only {} frames", options.jobs, options.settings.length));
        options.job = Job::printJobs;
        options.program = app::shellWord(argv[0]);
        for (int i = 1; i < argc; ++i) {
            const std::string word = argv[i];
            if (word == "--slurm") continue;
            if (word == "--print-jobs" || word == "--out") {
                ++i;
                continue;
            }
            if (word.starts_with("--print-jobs=") || word.starts_with("--out=")) continue;
            options.arguments += " " + app::shellWord(word);
        }
    }
    return options;
}

std::string jobList(const Options& options) {
    const std::string out = options.settings.out.string();
    const auto command = [&](uint32_t job) {
        const uint32_t first = uint32_t(uint64_t(options.settings.length) * job / options.jobs),
                       end = uint32_t(uint64_t(options.settings.length) * (job + 1) / options.jobs);
        return fmt::format("{}{} --no-video --frames {}:{} --out {}", options.program, options.arguments, first, end,
            app::shellWord(fmt::format("{}/part-{}", out, job)));
    };
    std::string folders, commands;
    for (uint32_t job = 0; job < options.jobs; ++job) {
        folders += fmt::format("{}{}/part-{}", job ? "," : "", out, job);
        commands += options.slurm ? fmt::format("  {}) {} ;;\n", job, command(job)) : command(job) + "\n";
    }
    const std::string merge = fmt::format("{} --merge {} --out {}", options.program, app::shellWord(folders), app::shellWord(out));
    if (!options.slurm) return commands + "# then: " + merge + "\n";
    return fmt::format(
        "#!/bin/sh\n#SBATCH --job-name=obscura-flythrough\n#SBATCH --array=0-{}\ncase \"$SLURM_ARRAY_TASK_ID\" in\n{}esac\n# then: {}\n",
        options.jobs - 1, commands, merge);
}

}  // namespace obscura::flythrough
