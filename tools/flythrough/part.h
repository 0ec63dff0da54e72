// What one method measured on one flythrough: kept as a file, so that an interrupted run goes on where it stopped and
// machines can share one. A part says nothing of how fast it ran but in `passes`: everything else is the same bytes each time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace obscura::flythrough {

struct FrameRow {
    uint32_t frame = 0;
    float time = 0.0f;                 // s
    // Of visibility against the world reference, over pixels that are not sky.
    float eA = 0.0f, bias = 0.0f, rmse = 0.0f;
    // From the frame before along motion vectors (truth/stability.h); `share` of the pixels could be followed. Zero at the first.
    float share = 0.0f, difference = 0.0f, referenceDifference = 0.0f, flickerOfError = 0.0f, referenceFlicker = 0.0f;
};

struct EventRow {
    uint32_t frame = 0, pixels = 0, t90 = 0;
    float ghost = 0.0f;
};

struct StaticRow { float mean = 0.0f, p99 = 0.0f; };  // standard deviations over frames, camera and scene still
struct PassRow { std::string name; double median = 0.0, p95 = 0.0; };  // ms

struct Part {
    std::string key;                   // of everything that determines the rows
    std::string flythrough, method, preset, settings, filter, falloff;
    uint32_t width = 0, height = 0, rays = 0;
    uint32_t first = 0, end = 0;       // frames measured here
    std::vector<FrameRow> frames;
    std::vector<EventRow> events;      // those that begin in [first, end)
    std::optional<StaticRow> still;    // by the part that holds frame 0
    std::vector<PassRow> passes;       // the method's own
    std::string pictures;              // folder of the frames' pictures, relative to the report; empty: none were kept

    std::string label() const;         // "hbao tuned steps=4"
    std::string name() const;          // "teleport.hbao.temporal", safe as a file name
};

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

std::string partText(const Part& part);
// Nothing when the file is missing or is not one of ours.
std::optional<Part> readPart(const std::filesystem::path& file);

// Parts of the same key become one, frames in order. Throws app::Complaint when two disagree or a frame is missing in between.
std::vector<Part> joined(std::vector<Part> parts);

// One line a frame, an event, a standstill, a pass: with a head line each. The first three are the same bytes however the
// frames were shared out.
std::string framesCsv(const std::vector<Part>& parts);
std::string eventsCsv(const std::vector<Part>& parts);
std::string staticCsv(const std::vector<Part>& parts);
std::string passesCsv(const std::vector<Part>& parts);

}  // namespace obscura::flythrough
