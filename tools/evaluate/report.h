// Results as JSON, as tables and as a folder of pictures. Nothing is written before everything has been measured, and
// every file appears whole.
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
// For a terminal, one line a row and what every part took.
std::string textTable(const std::vector<ShotResult>& shots, const Options& options, const About& about);

// visibility and error pictures, references, metrics.json, metrics.md.
void writeFolder(const std::vector<ShotResult>& shots, const Options& options, const About& about);
// NAME.capture.exr and NAME.json, numbered where there is more than one shot.
void writeCaptures(const std::vector<ShotResult>& shots, const std::filesystem::path& stem);
std::string shotFileName(const ShotResult& shot);  // "sponza.scene-0"

}  // namespace obscura::evaluate
