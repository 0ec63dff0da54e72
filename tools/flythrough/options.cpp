#include "options.h"

#include <charconv>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/arguments.h"
#include "app/complaint.h"
#include "arguments.h"

namespace obscura::flythrough {

using app::Complaint;

namespace {

// "a:b", frames a to b - 1 of `length`.
void setFrames(const std::string& text, Settings& settings) {
    settings.first = 0;
    settings.end = settings.length;
    if (text.empty()) return;
    const std::vector<float> range = app::numbers(text, ':');
    const bool good = range.size() == 2 && range[0] >= 0.0f && range[0] < range[1] && range[0] == float(uint32_t(range[0])) && range[1] == float(uint32_t(range[1]));
    if (!good || range[1] > float(settings.length))
        throw Complaint(fmt::format("--frames {}: write FIRST:END, such as 0:16; the flythrough has frames 0 to {} (--length)", text, settings.length - 1));
    settings.first = uint32_t(range[0]);
    settings.end = uint32_t(range[1]);
}

void listFlythroughs() {
    for (const Script& script : scripts())
        fmt::print("{:<18}{} ({}{})\n", script.name, script.title, script.scene, script.events.empty() ? "" : fmt::format(", {} events", script.events.size()));
}

}  // namespace

std::optional<Options> parseOptions(int argc, const char* const* argv) {
    Options options;
    CLI::App cli{"Flies a camera through animated scenes with every method and measures what it shows against ray-traced references: errors in space, "
                 "flicker, noise and lag in time.",
                 "obscura-flythrough"};
    cli.set_help_flag("-h,--help", "Print this and exit");
    cli.set_version_flag("--version", "Obscura " OBSCURA_VERSION);
    cli.footer(
        "Writes to --out: frames/ (PNG), one MP4 a method and one side by side, frames.csv, events.csv, static.csv, passes.csv, report.json, report.md and\n"
        "report.html. A run that was interrupted goes on where it stopped.\n\n"
        "Examples:\n"
        "  obscura-flythrough --flythrough teleport --method hbao,horizon_split --out out/teleport\n"
        "  obscura-flythrough --flythrough all --method all --print-jobs 8 --out /share/run | parallel\n"
        "  obscura-flythrough --merge /share/run/part-0,/share/run/part-1 --out /share/run/all");
    cli.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);  // so that scripts' defaults can be overridden
    evaluate::Judged judged;
    std::vector<std::string> filters{"raw", "spatial", "temporal"}, merged;
    std::string size, frames, falloff, out = "out/flythrough", check, renew;
    bool list = false, noPictures = false, noVideo = false, noCache = false;
    using evaluate::takeAll;

    cli.option_defaults()->group("What is flown");
    takeAll(cli.add_option("--flythrough", options.flythroughs, "By name, several with commas, or all (content/flythroughs.json; --list prints them), or FILE.json, a path that the game recorded"));
    cli.add_option("--length", options.settings.length, "Frames of the whole flythrough")->check(CLI::Range(2u, 100000u))->capture_default_str();
    cli.add_option("--frames", frames, "FIRST:END: measure these alone, so that a long run splits over machines (--merge joins them)");
    auto* sizeOption = cli.add_option("--size", size, "WIDTHxHEIGHT in pixels, without guard band (320x180)");
    cli.add_option("--guard", options.settings.guard, "Guard band, fraction of each side")->check(CLI::Range(0.0f, 0.5f))->capture_default_str();

    cli.option_defaults()->group("What is judged");
    addJudged(cli, judged);
    takeAll(cli.add_option("--modes,--filter", filters, "Resolve presets: raw (no blur, no history), spatial (the preset's own blur), temporal (and a history)")->capture_default_str());
    cli.add_option("--falloff", falloff, "KIND:LENGTH instead of the flythrough's own");
    cli.add_option("--rays", options.settings.rays, "Rays a pixel of the references")->check(CLI::Range(32u, 65536u))->capture_default_str();
    cli.add_option("--seed", options.settings.seed, "Of the rays")->capture_default_str();
    cli.add_flag("--no-cache", noCache, "Trace references anew, keep none (they lie in the user's cache folder)");

    cli.option_defaults()->group("What comes out");
    cli.add_option("--out", out, "Folder of the results")->capture_default_str();
    cli.add_flag("--no-pictures", noPictures, "Numbers alone");
    cli.add_flag("--no-video", noVideo, "Pictures, but no videos (those need ffmpeg)");
    cli.add_flag("--again", options.again, "Measure anew what the folder holds already");
    takeAll(cli.add_option("--merge", merged, "Folders of runs over parts of the frames: join them in --out, measure nothing"));
    cli.add_option("--print-jobs", options.jobs, "Print this run as so many commands, one a line, and do nothing else (pipe them into GNU parallel)")
        ->check(CLI::Range(1u, 100000u));
    cli.add_flag("--slurm", options.slurm, "With --print-jobs: a Slurm array script instead (sbatch it)");
    auto* checkOption = cli.add_option("--check-baseline", check, "Fail when a method's flicker or lag is worse than this file says");
    cli.add_option("--renew-baseline", renew, "Measure anew and write the file (only --method's rows when methods are named)")->excludes(checkOption);

    evaluate::addDevice(cli, options.device, options.validation, options.verbose);
    cli.add_flag("--list", list, "Print the flythroughs there are");

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
        if (cli.count("--method") == 0) judged.methods = {"all"};
    } else if (options.flythroughs.empty()) {
        throw Complaint("nothing to fly: give --flythrough NAME, or all (--list prints the names)");
    }
    if (options.flythroughs == std::vector<std::string>{"all"}) {
        options.flythroughs.clear();
        for (const Script& script : scripts()) options.flythroughs.push_back(script.name);
    }
    for (const std::string& flythrough : options.flythroughs) findScript(flythrough);
    options.candidates = evaluate::candidates(judged.methods, judged.presets, judged.allSets());
    for (const std::string& filter : filters) options.filters.push_back(&evaluate::resolvePreset("--modes " + filter, filter));
    if (*sizeOption) options.settings.size = app::sizeOf(size);
    if (!falloff.empty()) options.settings.falloff = evaluate::falloffs({falloff})[0];
    setFrames(frames, options.settings);
    if (options.slurm && !options.jobs) throw Complaint("--slurm: goes with --print-jobs N, the number of parts");
    if (options.jobs) {
        if (!frames.empty()) throw Complaint("--print-jobs: shares out all frames; leave out --frames");
        if (options.jobs > options.settings.length) throw Complaint(fmt::format("--print-jobs {}: there are only {} frames", options.jobs, options.settings.length));
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
        const uint32_t first = uint32_t(uint64_t(options.settings.length) * job / options.jobs), end = uint32_t(uint64_t(options.settings.length) * (job + 1) / options.jobs);
        return fmt::format("{}{} --no-video --frames {}:{} --out {}", options.program, options.arguments, first, end, app::shellWord(fmt::format("{}/part-{}", out, job)));
    };
    std::string parts, commands;
    for (uint32_t job = 0; job < options.jobs; ++job) {
        parts += fmt::format("{}{}/part-{}", job ? "," : "", out, job);
        commands += options.slurm ? fmt::format("  {}) {} ;;\n", job, command(job)) : command(job) + "\n";
    }
    const std::string merge = fmt::format("{} --merge {} --out {}", options.program, app::shellWord(parts), app::shellWord(out));
    if (!options.slurm) return commands + "# then: " + merge + "\n";
    return fmt::format("#!/bin/sh\n#SBATCH --job-name=obscura-flythrough\n#SBATCH --array=0-{}\ncase \"$SLURM_ARRAY_TASK_ID\" in\n{}esac\n# then: {}\n",
                       options.jobs - 1, commands, merge);
}

}  // namespace obscura::flythrough
