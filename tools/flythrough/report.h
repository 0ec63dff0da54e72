// What a run leaves behind: tables for programs, a page for people, videos.
#pragma once

#include "part.h"

namespace obscura::flythrough {

// One row a part: means over its frames, worst over its events.
struct Summary {
    double eA = 0.0, bias = 0.0;                  // mean over frames
    double difference = 0.0, excess = 0.0;        // mean D_A, mean F
    double flickerOfError = 0.0, referenceFlicker = 0.0;  // mean F_e, mean F_R
    double noiseMean = 0.0, noiseP99 = 0.0;       // static
    uint32_t t90 = 0;                             // worst event
    double ghost = 0.0;                           // summed over events
    double milliseconds = 0.0;                    // medians of its passes, summed
    uint32_t worst = 0;                           // frame of the largest eA
};
Summary summarize(const Part& part);

std::string table(const std::vector<Part>& parts);                 // for a terminal
std::string markdown(const std::vector<Part>& parts);              // the same for a text: a table a flythrough, a row a method and filter
// The four CSVs, report.json, report.md and report.html.
void writeReport(const std::vector<Part>& parts, const std::string& device, const std::filesystem::path& out);
// NAME.mp4 of every part with pictures and FLYTHROUGH.side-by-side.mp4; one line on stderr, no failure, where ffmpeg is not.
void writeVideos(const std::vector<Part>& parts, const std::filesystem::path& out);

}  // namespace obscura::flythrough
