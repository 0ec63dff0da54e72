// The measurement itself: every candidate and falloff on a shot, against every reference.
#pragma once

#include "measure/draw.h"
#include "measure/references.h"
#include "options.h"
#include "truth/bent_normals.h"

namespace obscura::evaluate {

// What one candidate drew with one falloff.
struct Drawn {
    size_t candidate = 0;  // of Options::candidates
    size_t falloff = 0;    // of Options::falloffs
    truth::Plane visibility;
    std::vector<glm::vec3> bentNormals;  // of measure::Drawing
    std::vector<gpu::PassTime> passes;   // the method's own passes, medians in milliseconds
    double milliseconds = 0.0;           // sum of the passes, median over rounds
};

// One line of the tables.
struct Row {
    size_t drawn = 0;                           // of ShotResult::drawn
    size_t reference = 0;                       // of ShotResult::references
    std::vector<truth::RegionMetrics> regions;  // whole first
    truth::BentErrors bent;                     // without pixels: not asked for, or a method or reference has none
    const truth::Metrics& whole() const { return regions.front().metrics; }
};

struct Seconds {
    double frame = 0.0, references = 0.0, methods = 0.0, metrics = 0.0;
};

struct ShotResult {
    std::string scene, camera, remark;
    float time = 0.0f;
    truth::CapturedFrame frame;    // with pixels only if it is written to a file
    glm::uvec2 size{0}, guard{0};  // visible part, guard band
    uint32_t every = 1;            // RayChoice::every
    std::vector<measure::ShotReference> references;
    std::vector<truth::BentErrors> bent;  // by reference: of its own visibility and mean directions; without pixels: not asked for
    std::vector<Drawn> drawn;
    std::vector<Row> rows;  // by reference, falloff, candidate
    Seconds seconds;
    bool referencesFromCache = false;
    bool empty() const { return !rows.empty() && rows.front().whole().pixels == 0; }  // no pixel was evaluated; `remark` says why
};

ShotResult measure(measure::Machine& machine, measure::Shot& shot, const Options& options);

}  // namespace obscura::evaluate
