// What a run leaves behind: tables for programs, a page for people, videos.
#pragma once

#include "part.h"

namespace obscura::flythrough {

std::string table(const std::vector<Part>& parts);                 // for a terminal
std::string markdown(const std::vector<Part>& parts);              // the same for a text: a table a flythrough, a row a method and filter
// The four CSVs, report.json, report.md and report.html.
void writeReport(const std::vector<Part>& parts, const std::string& device, const std::filesystem::path& out);
// NAME.mp4 of every part with pictures and FLYTHROUGH.side-by-side.mp4; one line on stderr, no failure, where ffmpeg is not.
void writeVideos(const std::vector<Part>& parts, const std::filesystem::path& out);

}  // namespace obscura::flythrough
