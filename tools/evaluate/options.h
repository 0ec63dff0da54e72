// The command line as a struct. Parsing checks everything that needs neither a device nor a scene.
#pragma once

#include "measure/measurement.h"

namespace obscura::evaluate {

enum class Job { evaluate, gallery, checkBaseline, renewBaseline };

struct Options : measure::Measurement {
    Job job = Job::evaluate;
    bool bentNormals = false;  // of methods that have them: errors of direction and of the light taken from them, and pictures
    bool errorsOnly = false;   // eA alone, without regions and perceptual metrics; for baselines
    // Output.
    std::filesystem::path json, out, page, captureOut, baseline;
};

// Throws app::Complaint. Empty after printing help or a list.
std::optional<Options> parseOptions(int argc, const char* const* argv);

}  // namespace obscura::evaluate
