// The command line as a struct. Parsing checks everything that needs neither a device nor a scene.
#pragma once

#include "flight.h"

namespace obscura::flythrough {

enum class Job { fly, merge, printJobs, checkBaseline, renewBaseline };

struct Options {
    Job job = Job::fly;
    std::vector<Script> scripts;
    std::vector<measure::Candidate> candidates;
    std::vector<const ao::Preset*> filters;  // of ao::resolvePresets()
    Settings settings;                       // out and pictures included
    bool video = true;
    bool again = false;                         // measure again what an earlier run measured
    std::vector<std::filesystem::path> merged;  // folders of runs to merge
    std::filesystem::path baseline;
    uint32_t jobs = 0;
    bool slurm = false;
    std::string program, arguments;  // for --print-jobs: argv[0] and the arguments of every job, quoted for a shell
    std::string device, validation = "off";
    bool verbose = false;
};

// Throws app::Complaint. Empty after printing help or a list.
std::optional<Options> parseOptions(int argc, const char* const* argv);

// The run as `jobs` chunks: one command per line for GNU parallel, or a Slurm array script. The last line is a comment with the merge.
std::string jobList(const Options& options);

}  // namespace obscura::flythrough
