// Results as JSON, as tables and as a folder of pictures. Files are written after all measurements, each by renaming a complete file.
#pragma once

#include <nlohmann/json.hpp>

#include "measure.h"

namespace obscura::evaluate {

using Json = nlohmann::ordered_json;

struct About {
    std::string device;
    uint32_t frames = 0, warmUp = 0;
};

// One object a row. Errors are of visibility, method minus reference: a positive bias is too bright.
Json rowJson(const ShotResult& shot, const Row& row, const Options& options, const About& about);
Json rowsJson(const std::vector<ShotResult>& shots, const Options& options, const About& about);

std::string markdown(const std::vector<ShotResult>& shots, const Options& options, const About& about);
// For a terminal: one line per row, and the time of each stage.
std::string textTable(const std::vector<ShotResult>& shots, const Options& options, const About& about);

// visibility and error pictures, references, metrics.json, metrics.md.
void writeFolder(const std::vector<ShotResult>& shots, const Options& options, const About& about);
// NAME.capture.exr and NAME.json; with the shot's name if there is more than one.
void writeCaptures(const std::vector<ShotResult>& shots, const std::filesystem::path& stem);
std::string shotFileName(const ShotResult& shot);  // "sponza.scene-0"

}  // namespace obscura::evaluate
