// Output of a run: tables, CSV, JSON, an HTML page, videos.
#pragma once

#include "chunk.h"

namespace obscura::flythrough {

std::string table(const std::vector<Chunk>& chunks);     // for a terminal
std::string markdown(const std::vector<Chunk>& chunks);  // one table per flythrough, one row per method and filter
// The four CSVs, report.json, report.md and report.html.
void writeReport(const std::vector<Chunk>& chunks, const std::string& device, const std::filesystem::path& out);
// NAME.mp4 of every method with pictures, and FLYTHROUGH.side-by-side.mp4. Without ffmpeg: one line on stderr, no failure.
void writeVideos(const std::vector<Chunk>& chunks, const std::filesystem::path& out);

}  // namespace obscura::flythrough
