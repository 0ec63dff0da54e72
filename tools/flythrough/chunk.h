// A chunk of a run: measurements of one method on some or all frames of one flythrough. Saved as a file in OUT/parts, so that runs
// can be resumed and split over machines. Everything but `passes` is deterministic.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace obscura::flythrough {

struct FrameRow {
    uint32_t frame = 0;
    float time = 0.0f;  // s
    // Of visibility against the world reference, over pixels that are not sky.
    float eA = 0.0f, bias = 0.0f, rmse = 0.0f;
    // Change from the previous frame along motion (truth/stability.h), over the fraction `share` of pixels found in it. 0 in the first
    // frame.
    float share = 0.0f, difference = 0.0f, referenceDifference = 0.0f, flickerOfError = 0.0f, referenceFlicker = 0.0f;
    bool empty = false;  // every pixel is sky: the row has no numbers
};

struct EventRow {
    uint32_t frame = 0, pixels = 0, t90 = 0;
    float ghost = 0.0f;
};

struct StaticRow {
    float mean = 0.0f, p99 = 0.0f;
};  // standard deviations over frames with fixed camera and scene
struct PassRow {
    std::string name;
    double median = 0.0, p95 = 0.0;
};  // ms

struct Chunk {
    std::string key;  // hash of everything that determines the rows
    std::string flythrough, method, preset, settings, filter, falloff;
    uint32_t width = 0, height = 0, rays = 0;
    uint32_t first = 0, end = 0;  // frames of this chunk
    std::vector<FrameRow> frames;
    std::vector<EventRow> events;    // those that begin in [first, end)
    std::optional<StaticRow> still;  // only in the chunk with frame 0
    std::vector<PassRow> passes;     // the method's own passes
    std::string pictures;            // folder of the frames' pictures, relative to the report; empty: no pictures

    std::string label() const;  // "hbao tuned steps=4"
    std::string name() const;   // "teleport.hbao.temporal", safe as a file name
};

// Summary of a chunk: means over its frames that are not empty, worst value over its events.
struct Summary {
    size_t frames = 0;                                                             // that are not empty; 0: all else but milliseconds is 0
    double eA = 0.0, bias = 0.0;                                                   // mean over frames
    double difference = 0.0, excess = 0.0;                                         // mean D_A, mean F
    double flickerOfError = 0.0, referenceFlicker = 0.0;                           // mean F_e, mean F_R
    double noiseMean = 0.0, noiseP99 = 0.0;                                        // static
    uint32_t t90 = 0;                                                              // worst event
    double ghost = 0.0;                                                            // summed over events
    double milliseconds = 0.0;                                                     // sum of the medians of its passes
    uint32_t worst = 0;                                                            // frame of the largest eA
    std::string number(const char* format, double value, const char* none) const;  // as text; `none` if every frame is empty
};
Summary summarize(const Chunk& chunk);

std::string chunkText(const Chunk& chunk);
// Empty if the file is missing or not a chunk.
std::optional<Chunk> readChunk(const std::filesystem::path& file);

// Joins chunks of the same flythrough, method and filter, frames in order. Throws app::Complaint if keys differ or frames are missing or
// double.
std::vector<Chunk> joined(std::vector<Chunk> chunks);

// CSV with a header line: one line per frame, event, static measurement, pass. The first three do not depend on how the run was split, byte
// for byte.
std::string framesCsv(const std::vector<Chunk>& chunks);
std::string eventsCsv(const std::vector<Chunk>& chunks);
std::string staticCsv(const std::vector<Chunk>& chunks);
std::string passesCsv(const std::vector<Chunk>& chunks);

}  // namespace obscura::flythrough
