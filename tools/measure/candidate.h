// A candidate of a measurement: a method with the values of a preset and settings that replace some of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ao/method.h"
#include "render/voxel_volume.h"

namespace obscura::measure {

// A candidate's voxelization, replacing that of the run: settings voxels, voxel_levels, voxel_size, voxelizer, voxel_structure,
// voxel_shell.
struct VoxelChoice {
    std::optional<float> cells, levels, cellSize, voxelizer, structure, shell;
    render::Voxelization over(render::Voxelization how) const;
};

struct Candidate {
    ao::Values values;
    std::string preset;
    std::vector<std::string> settings;  // "steps=4", over the preset
    VoxelChoice voxels;
    std::vector<std::string> varied;  // parameters of `settings` that were given a list of values
    const ao::MethodInfo& info() const { return values.info(); }
    std::string label() const;     // "hbao 8x4 steps=4"; the default preset is left out
    std::string fileName() const;  // "hbao.8x4", settings included; letters, digits, dots, dashes
};

// Every method named (or "all") with every preset named (or "all") that it has, `sets` applied: "METHOD.PARAMETER=VALUE", or
// "PARAMETER=VALUE" for every chosen method that has the parameter; "resolve=NAME" stands for what one of ao::resolvePresets() sets.
// Throws app::Complaint, which lists the known names.
std::vector<Candidate> candidates(
    const std::vector<std::string>& methods, const std::vector<std::string>& presets, const std::vector<std::string>& sets);
// As candidates(), but a setting may list values, "steps=4,8,16": a candidate for each combination, none twice.
std::vector<Candidate> variants(
    const std::vector<std::string>& methods, const std::vector<std::string>& presets, const std::vector<std::string>& sets);

// One of ao::resolvePresets() by its id; throws app::Complaint, whose text begins with the option `said`.
const ao::Preset& resolvePreset(const std::string& said, const std::string& id);

struct FalloffChoice {
    ao::Falloff falloff;
    std::string text;              // "quadratic:2"
    std::string fileName() const;  // "quadratic_2"
};
std::vector<FalloffChoice> falloffs(const std::vector<std::string>& texts);  // throws app::Complaint

}  // namespace obscura::measure
