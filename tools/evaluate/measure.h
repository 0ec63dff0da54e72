// The measurement itself: every candidate and falloff on a shot, against every reference.
#pragma once

#include "app/statistics.h"
#include "references.h"
#include "truth/metrics.h"

namespace obscura::evaluate {

// A run of frames with one candidate.
struct Drawing {
    truth::Plane visibility;
    std::vector<app::Series> passes;  // the method's own in the last timed frame, as app::Statistics keeps them: a value a frame since they came
    std::vector<double> own;          // a timed frame: its own passes, summed
    std::vector<double> rest;         // and what draws the frame whatever the method
    uint64_t bytes = 0;               // graph::Graph::frameBytes()
};
// Methods that gather over frames are warmed up until they have. Throws app::Complaint where a value is not finite.
Drawing draw(Machine& machine, Shot& shot, const Candidate& candidate, const ao::Falloff& falloff, uint32_t warmUp, uint32_t frames);

// What one candidate drew with one falloff.
struct Drawn {
    size_t candidate = 0;                // of Options::candidates
    size_t falloff = 0;                  // of Options::falloffs
    truth::Plane visibility;
    std::vector<graph::PassTime> passes; // the method's own, medians in milliseconds
    double milliseconds = 0.0;           // all of them, median of the rounds
};

// One line of the tables.
struct Row {
    size_t drawn = 0;                    // of ShotResult::drawn
    size_t reference = 0;                // of ShotResult::references
    std::vector<truth::RegionMetrics> regions;  // whole first
    const truth::Metrics& whole() const { return regions.front().metrics; }
};

struct Seconds {
    double frame = 0.0, references = 0.0, methods = 0.0, metrics = 0.0;
};

struct ShotResult {
    std::string scene, camera, remark;
    float time = 0.0f;
    truth::CapturedFrame frame;          // kept where it is written out; else without pixels
    glm::uvec2 size{0}, guard{0};        // visible part, guard band
    uint32_t every = 1;                  // RayChoice::every
    std::vector<JudgedBy> references;
    std::vector<Drawn> drawn;
    std::vector<Row> rows;               // by reference, falloff, candidate
    Seconds seconds;
    bool referencesFromCache = false;
};

// Six significant digits: what float errors hold. Not finite: 0.
double digits(double value);

ShotResult measure(Machine& machine, Shot& shot, const Options& options);

}  // namespace obscura::evaluate
