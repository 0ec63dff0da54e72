// All methods, in the order of keys and menus: that of the lines obscura_method(id) in CMakeLists.txt, of which methods.inc is made.
#include <cstring>
#include <iterator>

#include "ao/method.h"
#include "ao/temporal.h"

namespace obscura::ao {

#define OBSCURA_METHOD(id) \
    namespace id {         \
    MethodEntry entry();   \
    }
#include "methods.inc"
#undef OBSCURA_METHOD

namespace {

// Parameters of every method, of passes that the library adds before and after it: resolution, history, controls.
const char* const kScales[] = {"full", "half", "quarter"};
const Parameter kShared[] = {
    {"scale", "", 0, 2, 0, true, {kScales, 3},
        "Resolution that the method works at, each way; the result is brought back to all pixels along surfaces. Half costs a quarter; "
        "thin things lose detail first."},
    {"temporal", "", 0, 0.98f, 0, false, {},
        "Largest weight of the reprojected history; samples then rotate from frame to frame. 0: off. Higher is calmer and reacts more "
        "slowly. Without motion vectors history follows the camera, and moving objects have none."},
    {"temporal_clip", "sd", 0, 8, TemporalSettings{}.clip, false, {},
        "Clamps history to this many standard deviations of its neighbourhood; 0 turns clamping off. Lower flickers more, higher lets "
        "moved occluders leave trails."},
    {"intensity", "", 0, 4, 1, false, {}, "Factor on obscurance. 1: as computed; above, creases turn black early."},
    {"power", "", 0.25f, 8, 1, false, {}, "Exponent on visibility. 1: as computed; higher is darker, in creases most."},
    {"floor", "", 0, 1, 0, false, {}, "Lowest visibility. 0: creases may turn black."},
    {"fade_from", "m", 0, 10000, 0, false, {}, "Distance along the view from which on obscurance fades, if `fade_to` is above 0."},
    {"fade_to", "m", 0, 10000, 0, false, {}, "Distance along the view from which on all is open. 0: obscurance does not fade."},
};

const Setting kRaw[] = {{"denoise", 0}, {"blur", 0}, {"filter", 0}, {"temporal", 0}};
const Setting kSpatial[] = {{"temporal", 0}};
const Setting kTemporal[] = {{"temporal", 0.92f}};
const Preset kResolves[] = {
    {"raw", "No filter: the samples as they are.", {kRaw, std::size(kRaw)}},
    {"spatial", "The method's own blur.", {kSpatial, std::size(kSpatial)}},
    {"temporal", "The method's own blur, and a reprojected history that averages samples over frames.", {kTemporal, std::size(kTemporal)}},
};

// Parameters of every method that reads the screen alone: of the off-screen pass, which runs before the temporal one.
const char* const kOffScreen[] = {"off", "offscreen", "hidden"};
const Parameter kOffScreenParameters[] = {
    {"offscreen", "", 0, 2, 0, true, {kOffScreen, 3},
        "Adds occluders from voxels that are outside the picture, or outside it and hidden behind visible surfaces. Needs voxels; costs "
        "rays."},
    {"offscreen_rays", "", 4, 64, 16, true, {},
        "Rays through the voxels, at a quarter of the pixels. Cost grows with rays x reach / stride; too few are noisy."},
    {"offscreen_stride", "cells", 0.5f, 8, 1.25f, false, {},
        "Step of these rays. Longer steps cost less and miss walls, which are one cell thick along the grid."},
};

bool isScreenSpace(const MethodInfo& info) { return info.needs && !(info.needs & kVolume); }

// A method's own parameters and presets, followed by the shared ones.
struct Composed {
    std::vector<Parameter> parameters;
    std::vector<Preset> presets;
    std::vector<Setting> half;  // of the preset
    MethodInfo info;
    explicit Composed(const MethodInfo& own) : info(own) {
        parameters.assign(own.parameters.begin(), own.parameters.end());
        if (isScreenSpace(own)) parameters.insert(parameters.end(), std::begin(kOffScreenParameters), std::end(kOffScreenParameters));
        if (own.needs) parameters.insert(parameters.end(), std::begin(kShared), std::end(kShared));
        info.parameters = {parameters.data(), parameters.size()};
        presets.assign(own.presets.begin(), own.presets.end());
        if (own.needs) {
            half.assign(presets[0].settings.begin(), presets[0].settings.end());
            half.push_back({"scale", 1});
            presets.push_back({"half", "default at half the resolution, each way.", {half.data(), half.size()}});
        }
        info.presets = {presets.data(), presets.size()};
    }
};

}  // namespace

std::span<const MethodEntry> registry() {
    static const std::vector<MethodEntry> kEntries = [] {
        std::vector<MethodEntry> entries{
#define OBSCURA_METHOD(id) id::entry(),
#include "methods.inc"
#undef OBSCURA_METHOD
        };
        static std::vector<std::unique_ptr<Composed>> composed;
        for (MethodEntry& entry : entries) entry.info = &composed.emplace_back(std::make_unique<Composed>(*entry.info))->info;
        return entries;
    }();
    return kEntries;
}

List<const MethodInfo*> methods() {
    static const std::vector<const MethodInfo*> kInfos = [] {
        std::vector<const MethodInfo*> result;
        for (const MethodEntry& entry : registry()) result.push_back(entry.info);
        return result;
    }();
    return {kInfos.data(), kInfos.size()};
}

const MethodInfo* findMethod(const char* id) {
    for (const MethodInfo* info : methods())
        if (id && std::strcmp(info->id, id) == 0) return info;
    return nullptr;
}

List<Preset> resolvePresets() { return {kResolves, std::size(kResolves)}; }

const Preset* findResolvePreset(const char* id) {
    for (const Preset& preset : kResolves)
        if (id && std::strcmp(preset.id, id) == 0) return &preset;
    return nullptr;
}

}  // namespace obscura::ao
