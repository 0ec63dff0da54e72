// Results of a benchmark: one row per candidate, shot and falloff; JSON and CSV.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace obscura::bench {

using Json = nlohmann::ordered_json;

struct PassTime {
    std::string name;
    double median = 0.0, p95 = 0.0;  // ms
};

// Of visibility against one reference, over pixels that are not sky.
struct ErrorRow {
    std::string reference;  // "world", "screen"
    double eA = 0.0, bias = 0.0, rmse = 0.0, p99 = 0.0, ssim = 0.0;
};

struct Flicker {
    double ofError = 0.0;      // F_e, mean over a flythrough of the scene
    double ofReference = 0.0;  // F_R, the flicker of error of a constant picture
};

// What the compiler of a GPU counts; see gpu_cost/cost.h. For the row's falloff, at 1920x1080.
struct GpuCost {
    double cycles = 0.0;                        // of a SIMD, for 64 pixels
    double arithmeticMs = 0.0, memoryMs = 0.0;  // floors
    double registers = 0.0, waves = 0.0;        // of the worst pass
    bool guessed = false;                       // some loops have the compiler's guess as weight
    std::string geometry;                       // what must be rendered besides
};

// The key of a row. Rows of the same scene, camera and size were measured in turns, round by round.
struct Row {
    std::string scene, camera, falloff, method, preset, settings;
    uint32_t width = 0, height = 0;
    bool baseline = false;      // a published method to compare with
    std::string label() const;  // "hbao 8x4 steps=4"
    std::string place() const;  // "sponza own 640x360 quadratic:2"
    bool drawsObscurance() const { return method != "none"; }
    std::string name() const { return label() + ", " + place(); }

    // Quantities that time may scale with.
    uint64_t triangles = 0;  // of the scene
    double reach = 0.0;      // m, of the falloff
    std::string varied;      // names of the settings that were given lists, "directions steps"
    double samples = 0.0;    // product of their values; 0: none was varied

    // Milliseconds of the method's own passes, warm-up dropped.
    double median = 0.0, p95 = 0.0;  // over all timed frames of all rounds
    std::vector<double> rounds;      // median of each round
    std::vector<PassTime> passes;
    double frame = 0.0;  // median of the passes that draw the frame for every method

    uint64_t bytes = 0;            // device memory beyond that of the frame without obscurance
    std::vector<ErrorRow> errors;  // none if every pixel is sky
    std::optional<Flicker> flicker;
    std::optional<GpuCost> gpu;
    const ErrorRow* against(const std::string& reference) const;
};

struct Results {
    std::string device, command;  // command: the command line of the run
    double guard = 0.0;
    uint32_t frames = 0, warmUp = 0, rounds = 0, rays = 0;
    std::string gpu, gpuCompiler;  // of GpuCost: "navi21 (Radeon RX 6900 XT)", "Mesa 22.3.6"; empty: not counted
    uint32_t flickerFrames = 0, flickerWidth = 0, flickerHeight = 0;
    std::vector<Row> rows;
};

Json toJson(const Row& row);
Row rowOf(const Json& json);  // throws Json::exception
std::string jsonText(const Results& results);
Results readResults(const std::filesystem::path& file);  // throws app::Complaint

// One line per row; one line per pass.
std::string csv(const Results& results);
std::string passesCsv(const Results& results);

}  // namespace obscura::bench
