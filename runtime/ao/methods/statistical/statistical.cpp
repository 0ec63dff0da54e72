// Statistical volumetric obscurance [Hendrickx, Scandolo, Eisemann, Eisemann: Adaptively Layered Statistical Volumetric
// Obscurance, HPG 2015]. A box stands on the surface at each pixel. Its filled fraction follows from the mean height of the surface in a
// window of the image, which summed-area tables give at a cost independent of the window's size:
//     A = gain sum over layers of psi(mean height / h) n / sum over layers of n,   psi(x) = max(0, min(x, 1 - s (x - 1)))
// Layers separate surfaces by depth: each level splits each layer at its own local mean. Of each pair one layer has a table; the other is
// its parent's table minus that one. There are no samples, so no noise and no blur.
//
// Differences where the paper is incomplete or wrong:
// - Occupancy is 1 inside solids [eq. 2 has it inverted].
// - All layers count in the mean, also those wholly outside of the box, and sky: space behind and far in front is open [eq. 5's "i in V"
//   does not say].
// - Tables are 32-bit integers, not floats, so their sums and differences are exact (fixed_point.h).
// - The mean over the box is not cosine-weighted as ambient obscurance is; `gain` compensates on average over scenes.
// - The box is sized from the falloff: R is the reach of the quadratic falloff with the same integral.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: extent, texels, for
// each level layers and table (rows, columns), evaluate.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "ao/denoise.h"
#include "ao/methods/statistical/tables.h"
#include "ao/statistical/constants.h"

namespace obscura::ao::statistical {
namespace {

using shared::Box;
using Tables = StatisticalTables::Tables;

enum Estimator : uint32_t { kTables, kPoints, kLines };
const char* const kEstimators[] = {"tables", "points", "lines"};
const char* const kLayerings[] = {"one", "2 adaptive", "4 adaptive", "8 adaptive", "16 uniform", "64 uniform"};
constexpr uint32_t kFirstUniform = 4;  // index in kLayerings
const char* const kAxes[] = {"normal", "view"};
const char* const kSizes[] = {"full", "half", "quarter"};

const Parameter kParameters[] = {
    {"layers", "", 0, 5, 2, true, {kLayerings, 6},
        "How surfaces are separated by depth: adaptively, at local means, or in uniform slices of the whole depth range, which are slow "
        "and for comparison only. More layers cost more tables; too few: dark halos around foreground objects."},
    {"quadrants", "", 0, 1, 1, true, {},
        "1: averages each quarter of the window alone, so that a surface that falls away on one side does not cancel occluders on the "
        "other. Costs more table reads. 0: creases beside edges are too bright."},
    {"tables", "", 0, 2, 1, true, {kSizes, 3},
        "Size of the tables relative to the image. Memory and most of the time grow with its square. Too small: contact shadows blur."},
    {"radius", "R", 0.05f, 4, 0.78f, false, {},
        "Half width of the box, in reaches of the falloff. Too small: wide occlusion is lost; too large: creases blur."},
    {"height", "R", 0.05f, 4, 0.92f, false, {},
        "Height of the box, in reaches of the falloff. Too low: tall occluders stop counting; too high: low ones count too little."},
    {"slope", "", 0.1f, 16, 1.5f, false, {},
        "How fast occluders that are higher than the box stop counting: they are gone at 1 + 1/slope box heights. Too low: dark halos; too "
        "high: hard edges."},
    {"gain", "", 0.1f, 4, 1.17f, false, {},
        "Factor on obscurance, because the filled part of a box is smaller than the blocked part of the sky. Too low: too bright; too "
        "high: creases turn black."},
    {"largest", "", 0.01f, 0.5f, 0.22f, false, {},
        "Largest half width on the screen, in image heights. It bounds the integer sums. Too high: they lose precision; too low: wide "
        "occlusion is lost close up."},
    {"align", "", 0, 1, 0, true, {kAxes, 2},
        "What the box stands along: the surface's normal, or the camera's view axis, as in the paper's section 3. Along the view: slanted "
        "surfaces darken themselves."},
    {"estimator", "", 0, 2, 0, true, {kEstimators, 3},
        "Summed-area tables, or for comparison samples in the same box: points, or lines along the normal with a 5x5 blur."},
    {"samples", "", 1, 1024, 256, true, {},
        "Points or lines per pixel for those estimators. Cost grows with them. Too few: noise. Tables ignore it."},
};
const Setting kPaper[] = {
    {"quadrants", 0}, {"tables", 0}, {"radius", 0.75f}, {"height", 1.5f}, {"slope", 4}, {"gain", 1.4f}, {"largest", 0.25f}};
const Setting kPaperHalf[] = {
    {"quadrants", 0}, {"tables", 1}, {"radius", 0.75f}, {"height", 1.5f}, {"slope", 4}, {"gain", 1.4f}, {"largest", 0.25f}};
const Setting kPaperQuarter[] = {
    {"quadrants", 0}, {"tables", 2}, {"radius", 0.75f}, {"height", 1.5f}, {"slope", 4}, {"gain", 1.4f}, {"largest", 0.25f}};
const Setting kQuality[] = {{"tables", 0}};
const Preset kPresets[] = {
    {"default", "4 adaptive layers, four quadrants, tables of half size.", {}},
    {"paper",
        "4 adaptive layers, one region, tables of full size, as in most of the paper's figures; it gives no size, slope and gain, so these "
        "are "
        "ours.",
        {kPaper, std::size(kPaper)}},
    {"paper_half", "Preset paper with tables of half size.", {kPaperHalf, std::size(kPaperHalf)}},
    {"paper_quarter", "Preset paper with tables of quarter size.", {kPaperQuarter, std::size(kPaperQuarter)}},
    {"quality", "4 adaptive layers, four quadrants, tables of full size.", {kQuality, std::size(kQuality)}},
};
const MethodInfo kInfo{"statistical", "Statistical volumetric obscurance",
    "Hendrickx, Scandolo, Eisemann, Eisemann: Adaptively Layered Statistical Volumetric Obscurance, 2015",
    "Mean height of the surface around each pixel, for each depth layer, from summed-area tables. No samples, no noise.", kDepth | kNormals,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}};

// The reach of the quadratic falloff with the same integral over distance.
float quadraticReach(const Falloff& falloff) {
    const int steps = 256;
    const float step = reach(falloff) / float(steps);
    float sum = 0.0f;
    for (int i = 0; i < steps; ++i) sum += evaluate(falloff, (float(i) + 0.5f) * step) * step;
    return 1.5f * sum;
}

class Statistical final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind) {
        auto result = std::make_unique<Statistical>();
        bool created = StatisticalTables::create(device, shaders, result->m_tables) == Status::ok &&
                       Denoise::create(device, shaders, result->m_denoise) == Status::ok;
        const auto make = [&](const char* name, std::initializer_list<gpu::Constant> constants, gpu::Program& program) {
            created = created && gpu::Program::compute(device, shaders, name, constants, program) == gpu::Status::ok;
        };
        make("ao/statistical/samples.comp", {}, result->m_samples);
        for (uint32_t split = 1; split <= 2; ++split) {
            make("ao/statistical/uniform.comp", {{0, split}}, result->m_uniform[split - 1]);
            for (uint32_t level = 0; level < 4; ++level)
                make("ao/statistical/evaluate.comp", {{0, split}, {1, 1u << level}}, result->m_evaluate[split - 1][level]);
        }
        return created ? std::move(result) : nullptr;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& view = inputs.view;
        const float R = quadraticReach(inputs.falloffDesc);
        const uint32_t layering = values.count("layers"), estimator = values.count("estimator");
        Box box{values["radius"] * R, values["height"] * R, std::max(values["largest"] * float(view.visible.y), 1.0f),
            1u << values.count("tables"), 0.0f, std::abs(view.project.x) / view.pixelsPerMetre};
        const graph::ImageId visibility = graph.image("statistical.visibility", {VK_FORMAT_R16_SFLOAT, view.visible.x, view.visible.y});
        if (estimator != kTables) {
            const shared::StatisticalSamples constants{
                box, values["slope"], values["gain"], values.count("samples"), estimator == kLines ? 1u : 0u, values.count("align"), 0};
            graph.pass("statistical.samples", m_samples)
                .read(inputs.viewBlock)
                .read(inputs.depth)
                .read(inputs.normals)
                .write(visibility)
                .constants(constants)
                .dispatch(view.visible.x, view.visible.y);
            return estimator == kLines ? m_denoise.add(graph, inputs, visibility, "statistical.blur") : visibility;
        }

        const bool adaptive = layering < kFirstUniform;
        const Tables t = m_tables.add(graph, inputs, box, adaptive ? layering : 0);
        const shared::StatisticalEvaluate constants{t.box, t.size, values["slope"], values["gain"], values.count("align"), 0};
        const uint32_t quadrants = values.count("quadrants");
        if (!adaptive) {
            addUniform(graph, inputs, constants, t, layering == kFirstUniform ? 16 : 64, quadrants, visibility);
            return visibility;
        }
        graph.pass("statistical.evaluate", m_evaluate[quadrants][layering])
            .read(inputs.viewBlock)
            .read(inputs.depth)
            .read(inputs.normals)
            .read(t.extent)
            .read(t.root)
            .read(t.levels[0])
            .read(t.levels[1])
            .read(t.levels[2])
            .write(visibility)
            .constants(constants)
            .dispatch(view.visible.x, view.visible.y);
        return visibility;
    }

    // Everything below the mean height counts as filled, unless that is so high that psi is 0.
    Blocking blocking(const Inputs& inputs, const Values& values) const override {
        const float height = values["height"] * quadraticReach(inputs.falloffDesc);
        return {height * (1.0f + 1.0f / values["slope"]), Blocking::kEndless};
    }

private:
    void addUniform(graph::Graph& graph, const Inputs& inputs, const shared::StatisticalEvaluate& evaluate, const Tables& t,
        uint32_t layers, uint32_t quadrants, graph::ImageId visibility) {
        const auto& visible = inputs.view.visible;
        m_tables.addUniform(graph, inputs, t, layers);
        const graph::BufferId pair = graph.buffer("statistical.pair", SummedArea::bytes(t.size, 2));
        const graph::BufferId blocked = graph.buffer("statistical.blocked", uint64_t(visible.x) * visible.y * 16);
        for (uint32_t k = 0; k < layers; k += 2) {
            m_tables.addPair(graph, t, k, pair);
            graph.pass("statistical.uniform", m_uniform[quadrants])
                .read(inputs.viewBlock)
                .read(inputs.depth)
                .read(inputs.normals)
                .read(t.extent)
                .read(pair)
                .write(blocked)
                .write(visibility)
                .constants(shared::StatisticalUniform{
                    t.box, t.size, evaluate.slope, evaluate.gain, k == 0, k + 2 == layers, evaluate.viewAligned, 0})
                .dispatch(visible.x, visible.y);
        }
    }

    StatisticalTables m_tables;
    Denoise m_denoise;
    gpu::Program m_samples;
    gpu::Program m_uniform[2];      // one region, quadrants
    gpu::Program m_evaluate[2][4];  // [one region, quadrants][level]
};

}  // namespace

MethodEntry entry() { return {.info = &kInfo, .create = &Statistical::create, .perFalloff = false}; }

}  // namespace obscura::ao::statistical
