// The command line as a struct. Everything that can be judged without a device or a scene is judged here.
#pragma once

#include "flight.h"

namespace obscura::flythrough {

enum class Job { fly, merge, printJobs, checkBaseline, renewBaseline };

struct Options {
    Job job = Job::fly;
    std::vector<std::string> flythroughs;
    std::vector<evaluate::Candidate> candidates;
    std::vector<const ao::Preset*> filters;   // of ao::resolvePresets()
    Settings settings;                             // out and pictures included
    bool video = true;
    bool again = false;                            // measure what is there already, too
    std::vector<std::filesystem::path> merged;     // folders of parts
    std::filesystem::path baseline;
    uint32_t jobs = 0;
    bool slurm = false;
    std::string program, arguments;                // for --print-jobs: argv[0] and what each job repeats, as words of a shell
    std::string device, validation = "off";
    bool verbose = false;
};

// Throws app::Complaint. Nothing when the line asked for help or a list, which has been printed.
std::optional<Options> parseOptions(int argc, const char* const* argv);

// The same run in `jobs` parts, one command a line for GNU parallel, or a Slurm array script; the merge comes last, as a comment.
std::string jobList(const Options& options);

}  // namespace obscura::flythrough
