// Output of a headless run: a table on the terminal, summary.html and timings.json.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/picture.h"
#include "app/statistics.h"
#include "engine.h"

namespace obscura::game {

struct ReportPicture {
    uint32_t frame = 0;
    float time = 0.0f;  // seconds
    app::Picture final, visibility;
};

// Size, memory and times of the voxels as lines of text; times are medians of the passes that fill and trace the volume.
std::string voxelFacts(const voxel::Voxels& voxels, const app::Statistics& times);

struct Report {
    const Options& options;
    Engine& engine;
    const Stage& stage;
    const app::Statistics& statistics;
    uint32_t frames = 0;   // rendered
    uint32_t dropped = 0;  // of these, not timed
    std::vector<ReportPicture> pictures;

    std::string table() const;  // per-pass times as text
    // Writes summary.html and timings.json, each by renaming a complete file.
    void write(const std::filesystem::path& folder) const;
};

}  // namespace obscura::game
