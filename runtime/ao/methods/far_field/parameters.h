// Parameters and presets of far_field, and which settings others leave without effect.
#pragma once

#include <iterator>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "ao/interleave.h"
#include "ao/layer_pass.h"
#include "ao/methods/far_field/grid.h"

namespace obscura::ao::far_field {

inline constexpr const char* kAveragings[] = {"none", "prefix sums", "pyramid", "direct"};
inline constexpr float kTile3x3 = 2;  // in kInterleaves
enum Estimator : uint32_t { kSlab, kConnected, kBlended };
inline constexpr const char* kEstimators[] = {"slab", "connected", "blended"};
inline constexpr const char* kParts[] = {"both", "near", "far"};
inline constexpr const char* kNeighbours[] = {"plane", "depth"};
inline constexpr const char* kOffOn[] = {"off", "on"};
inline constexpr const char* kSparsities[] = {"every", "every 2nd", "every 4th"};

inline const Parameter kParameters[] = {
    {"directions", "", 4, 32, 12, true, {},
        "Directions in which the depth buffer is scanned, K. Cost and memory grow with them; even numbers scan opposite directions "
        "together. Too few: bands."},
    {"segments", "", 1, 8, 2, true, {},
        "Segments of each sector, evaluated separately. The cost per pixel grows with directions x segments. Too few: bands."},
    {"interval", "px", 3, 20, 5, true, {},
        "Shortest interval that is reduced to one point, B0. Longer costs less and widens the near field. Too long: small occluders are "
        "missed."},
    {"longest", "", 0.25f, 1, 0.5f, false, {},
        "Longest interval, as a fraction of its distance; 1 in the paper. Shorter costs more. Too long: intervals, which run along the "
        "middle of a sector, reach across its sides and leave bands."},
    {"lines", "", 0, 2, 0, true, {kSparsities, 3},
        "Which of the scan lines, 1 px apart, are used. Fewer cost less; too few: thin objects are missed."},
    {"slope", "", -2, 2, 1, false, {},
        "Slope s of the second angle from which the highest point of an interval is chosen: -1, from above, in the paper. 0 counts as 1."},
    {"estimator", "", 0, 2, 2, true, {kEstimators, 3},
        "Shape of the surface below a point: a slab away from the camera, as in the paper, a line to the previous point, or a blend of "
        "both. All cost the same. Surfaces with a thickness are slabs."},
    {"averaging", "", 0, 3, 2, true, {kAveragings, 4},
        "How points are averaged over the width of a sector: not at all, by the paper's prefix sums, or by a lateral pyramid of 1/depth, "
        "with a sixth of the memory. direct: single texels of the depth buffer, no scans. Without averaging thin objects alias. Only the "
        "pyramid reads depth layers."},
    {"near", "", 0, 16, 5, true, {},
        "Samples of the near field in each segment. Cost grows with them. 0: far field only; too few: contact shadows are lost."},
    {"parts", "", 0, 2, 0, true, {kParts, 3},
        "Output: both fields, the near field alone, or the far field alone above the horizon of the near field."},
    {"memory", "MB", 1, 4096, 256, true, {},
        "Most memory of points. Directions whose points do not fit are scanned in batches one after another, which costs little on large "
        "images. Lower is slower on small ones."},
    kInterleave,
    {"thickness", "m", 0, 100, 0, false, {},
        "Thickness of surfaces, in 32 bins of each sector; 0: endless. Above 0 turns off averaging, interleaving and depth layers. Too "
        "low: light leaks through solid objects."},
    {"jitter", "", 0, 1, 0, false, {},
        "Random turn of the directions of each pixel, as a fraction of half a segment: noise instead of bands."},
    {"alternate", "", 0, 1, 1, true, {kOffOn, 2},
        "Turns the directions of every other pixel by half a segment: bands become a fine checkerboard, which shows beside tall objects "
        "only. Free. Off if interleaved or jittered."},
    kDepthLayers,
    kSheet,
    {"neighbours", "", 0, 1, 0, true, {kNeighbours, 2},
        "Neighbours that interleaving averages: those near the pixel's tangent plane, or those within 3 % of its depth, as in the paper. "
        "By "
        "depth, grazing surfaces are grainy and low steps blur."},
    {"blur", "", 0, 0.5f, 0.07f, false, {},
        "After interleaving: 5x5 mean of neighbours whose visibility differs by at most this; 0: off. Too low: grain where near and far "
        "field meet; too high: contact shadows blur."},
};
inline const Setting kPaper8[] = {{"directions", 8}, {"segments", 2}, {"alternate", 0}, {"interval", 10}, {"longest", 1}, {"slope", -1},
    {"estimator", kSlab}, {"averaging", 1}, {"near", 5}};
inline const Setting kPaper16[] = {{"directions", 16}, {"segments", 2}, {"alternate", 0}, {"memory", 512}, {"interval", 10}, {"longest", 1},
    {"slope", -1}, {"estimator", kSlab}, {"averaging", 1}, {"near", 5}};
inline const Setting kPaperSaao[] = {{"directions", 18}, {"segments", 2}, {"memory", 512}, {"interval", 10}, {"longest", 1}, {"slope", -1},
    {"estimator", kSlab}, {"averaging", 1}, {"near", 5}, {"interleave", kTile3x3}, {"neighbours", 1}};
inline const Setting kFast[] = {{"directions", 18}, {"segments", 2}, {"longest", 1}, {"near", 3}, {"interleave", kTile3x3}};
inline const Setting kThin[] = {
    {"directions", 16}, {"segments", 1}, {"longest", 1}, {"averaging", 0}, {"near", 3}, {"thickness", 0.1f}, {"jitter", 1}};
inline const Setting kLayers[] = {{"depth_layers", float(LayerMode::second)}};
inline const Preset kPresets[] = {
    {"default", "12 directions x 2 segments, blended estimator, lateral pyramid.", {}},
    {"paper_8x2", "The paper's smaller setting: 8 directions x 2 segments.", {kPaper8, std::size(kPaper8)}},
    {"paper_16x2", "The paper's larger setting: 16 directions x 2 segments.", {kPaper16, std::size(kPaper16)}},
    {"paper_saao", "The paper's interleaved setting: 18 directions x 2 segments, blurred.", {kPaperSaao, std::size(kPaperSaao)}},
    {"fast", "Interleaved over 3x3 pixels: each pixel evaluates a ninth of the far field.", {kFast, std::size(kFast)}},
    {"layers", "The default with depth layers: finite objects stop occluding behind their back faces.", {kLayers, std::size(kLayers)}},
    {"thin", "Surfaces 10 cm thick, 16 directions without averaging, jittered.", {kThin, std::size(kThin)}},
};
inline const MethodInfo kInfo{"far_field", "Far-field ambient obscurance", "Timonen: Screen-Space Far-Field Ambient Obscurance, HPG 2013",
    "Occluders from the whole depth buffer, at a cost that does not depend on radius or falloff.", kDepth | kNormals,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}};

// The first setting that others leave without effect, and why; empty if there is none.
inline std::string withoutEffect(const Values& values) {
    const auto asked = [&](const char* id) {
        for (const Parameter& parameter : kParameters)
            if (std::string_view(parameter.id) == id) return values[id] != parameter.initial;
        return false;
    };
    if (values["thickness"] > 0.0f) {
        for (const char* id : {"estimator", "interleave", "depth_layers"})
            if (asked(id)) return fmt::format("{} has no effect with a thickness: surfaces are slabs without averages", id);
        const auto averaging = Averaging(values.count("averaging"));
        if (averaging == Averaging::prefixSums)
            return "averaging has no effect with a thickness: points of surfaces with a back have no mean";
    }
    if (asked("depth_layers") && Averaging(values.count("averaging")) != Averaging::pyramid)
        return "depth_layers has no effect without the pyramid, which alone averages two fields";
    if (asked("depth_layers") && tileSide(values) > 1) return "depth_layers has no effect when interleaved";
    if (asked("neighbours") && tileSide(values) == 1) return "neighbours has no effect unless interleaved";
    return {};
}

}  // namespace obscura::ao::far_field
