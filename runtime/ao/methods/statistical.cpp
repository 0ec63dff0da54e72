// Statistical volumetric obscurance [Hendrickx, Scandolo, Eisemann, Eisemann: Adaptively Layered Statistical Volumetric
// Obscurance, HPG 2015]. Around each pixel stands a box on the surface. How much of it is filled follows from the mean
// height of the surface in a window of the picture, which summed-area tables give at one cost whatever its size:
//     A = gain sum over layers of psi(mean height / h) n / sum over layers of n,   psi(x) = max(0, min(x, 1 - s (x - 1)))
// Layers keep apart what lies far apart in depth: each level splits each layer at its own local mean. Of each pair one gets a
// table, the other is the difference from their parent's. There are no samples, so there is no noise and nothing to blur.
//
// Where the paper is silent or mistaken:
// - Occupancy is 1 inside of matter [eq. 2 has it the other way round].
// - All layers are counted in the mean, those wholly outside of the box too: space behind and far in front is open [eq. 5's
//   "i in V" leaves it open].
// - Tables are 32-bit integers, not floats: their sums are exact and differences of tables too (fixed_point.h).
// - The box's mean is not weighed by the cosine as ambient obscurance is; `gain` makes up for it, a compromise between scenes.
// - The box is sized from the falloff: R is the reach of the quadratic falloff with the same integral.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: extent, texels, for
// each level layers and table (rows, columns), evaluate.
#include <algorithm>
#include <iterator>

#include "ao/methods/statistical_tables.h"
#include "ao/resolve.h"

namespace obscura::ao {
namespace {

using shared::Box;
using shared::uvec2;
using Tables = StatisticalTables::Tables;

enum Estimator : uint32_t { kTables, kPoints, kLines };
const char* const kEstimators[] = {"tables", "points", "lines"};
const char* const kLayerings[] = {"one", "2 adaptive", "4 adaptive", "8 adaptive", "16 uniform", "64 uniform"};
constexpr uint32_t kFirstUniform = 4;  // of those
const char* const kSizes[] = {"full", "half", "quarter"};

const Parameter kParameters[] = {
    {"layers", "", 0, 5, 2, true, {kLayerings, 6}, "How depths are kept apart: by local means, or in uniform slices of the whole depth range, which only comparisons are worth."},
    {"quadrants", "", 0, 1, 1, true, {}, "1: each quarter of the window by itself, so that what lies below the surface on one side hides nothing on the other."},
    {"tables", "", 0, 2, 1, true, {kSizes, 3}, "Size of the tables against the picture's; memory and most of the time go with its square."},
    {"radius", "R", 0.05f, 4, 0.78f, false, {}, "Half width of the box, in reaches of the falloff."},
    {"height", "R", 0.05f, 4, 0.92f, false, {}, "Height of the box, in reaches of the falloff."},
    {"slope", "", 0.1f, 16, 1.5f, false, {}, "How fast what stands higher than the box stops counting: gone at 1 + 1/slope heights."},
    {"gain", "", 0.1f, 4, 1.17f, false, {}, "Strength: the filled part of a box is less than the blocked part of the sky."},
    {"largest", "", 0.01f, 0.5f, 0.22f, false, {}, "Largest half width on the screen, in picture heights; bounds the numbers, and so sets their precision."},
    {"estimator", "", 0, 2, 0, true, {kEstimators, 3}, "Tables, or for comparison samples in the same box: points, or lines along the normal with a 5x5 blur."},
    {"samples", "", 1, 1024, 256, true, {}, "Points or lines a pixel; tables take none."},
};
const Setting kPaper[] = {{"quadrants", 0}, {"tables", 0}, {"radius", 0.75f}, {"height", 1.5f}, {"slope", 4}, {"gain", 1.4f}, {"largest", 0.25f}};
const Setting kPaperHalf[] = {{"quadrants", 0}, {"tables", 1}, {"radius", 0.75f}, {"height", 1.5f}, {"slope", 4}, {"gain", 1.4f}, {"largest", 0.25f}};
const Setting kPaperQuarter[] = {{"quadrants", 0}, {"tables", 2}, {"radius", 0.75f}, {"height", 1.5f}, {"slope", 4}, {"gain", 1.4f}, {"largest", 0.25f}};
const Setting kQuality[] = {{"tables", 0}};
const Preset kPresets[] = {
    {"default", "4 adaptive layers, four quadrants, tables of half size.", {}},
    {"paper", "4 adaptive layers, one region, tables of full size, as in most of the paper's figures.", {kPaper, std::size(kPaper)}},
    {"paper_half", "The same with tables of half size.", {kPaperHalf, std::size(kPaperHalf)}},
    {"paper_quarter", "The same with tables of quarter size.", {kPaperQuarter, std::size(kPaperQuarter)}},
    {"quality", "4 adaptive layers, four quadrants, tables of full size.", {kQuality, std::size(kQuality)}},
};
const MethodInfo kInfo{"statistical",
                       "Statistical volumetric obscurance",
                       "Hendrickx, Scandolo, Eisemann, Eisemann: Adaptively Layered Statistical Volumetric Obscurance, 2015",
                       "The mean height around each pixel, layer by layer, from summed-area tables. No samples, no noise.",
                       kDepth | kNormals,
                       {kParameters, std::size(kParameters)},
                       {kPresets, std::size(kPresets)}};

struct EvaluateConstants { Box box; uvec2 size; float slope, gain; };
struct UniformConstants { EvaluateConstants evaluate; uint32_t isFirst, isLast; };
struct SampleConstants { Box box; float slope, gain; uint32_t samples, lines; };

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
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders) {
        auto result = std::make_unique<Statistical>();
        bool good = StatisticalTables::create(device, shaders, result->m_tables) == Status::ok && Denoise::create(device, shaders, result->m_denoise) == Status::ok;
        const auto make = [&](const char* name, std::initializer_list<gpu::Constant> constants, gpu::Program& program) {
            good = good && gpu::Program::compute(device, shaders, name, constants, program) == gpu::Status::ok;
        };
        make("ao/statistical/samples.comp", {}, result->m_samples);
        for (uint32_t split = 1; split <= 2; ++split) {
            make("ao/statistical/uniform.comp", {{0, split}}, result->m_uniform[split - 1]);
            for (uint32_t level = 0; level < 4; ++level)
                make("ao/statistical/evaluate.comp", {{0, split}, {1, 1u << level}}, result->m_evaluate[split - 1][level]);
        }
        return good ? std::move(result) : nullptr;
    }

    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& view = inputs.view;
        const float R = quadraticReach(inputs.falloffDesc);
        const uint32_t layering = values.count("layers"), estimator = values.count("estimator");
        Box box{values["radius"] * R, values["height"] * R, std::max(values["largest"] * float(view.visible.y), 1.0f), 1u << values.count("tables")};
        const graph::ImageId visibility = graph.image("statistical.visibility", {VK_FORMAT_R16_SFLOAT, view.visible.x, view.visible.y});
        if (estimator != kTables) {
            const SampleConstants constants{box, values["slope"], values["gain"], values.count("samples"), estimator == kLines ? 1u : 0u};
            graph.pass("statistical.samples", m_samples).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).write(visibility)
                .constants(constants).dispatch(view.visible.x, view.visible.y);
            return estimator == kLines ? m_denoise.add(graph, inputs, visibility, "statistical.blur") : visibility;
        }

        const bool adaptive = layering < kFirstUniform;
        const Tables t = m_tables.add(graph, inputs, box, adaptive ? layering : 0);
        const EvaluateConstants constants{t.box, t.size, values["slope"], values["gain"]};
        const uint32_t quadrants = values.count("quadrants");
        if (!adaptive) {
            addUniform(graph, inputs, constants, t, layering == kFirstUniform ? 16 : 64, quadrants, visibility);
            return visibility;
        }
        graph.pass("statistical.evaluate", m_evaluate[quadrants][layering]).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(t.extent)
            .read(t.root).read(t.levels[0]).read(t.levels[1]).read(t.levels[2]).write(visibility).constants(constants).dispatch(view.visible.x, view.visible.y);
        return visibility;
    }

    // All below the mean height is taken for filled, however far in front it was seen.
    Blocking blocking(const Inputs&, const Values&) const override { return {}; }

private:
    void addUniform(graph::Graph& graph, const Inputs& inputs, const EvaluateConstants& evaluate, const Tables& t, uint32_t layers, uint32_t quadrants,
                    graph::ImageId visibility) {
        const auto& visible = inputs.view.visible;
        m_tables.addUniform(graph, inputs, t, layers);
        const graph::BufferId pair = graph.buffer("statistical.pair", SummedArea::bytes(t.size, 2));
        const graph::BufferId blocked = graph.buffer("statistical.blocked", uint64_t(visible.x) * visible.y * 16);
        for (uint32_t k = 0; k < layers; k += 2) {
            m_tables.addPair(graph, t, k, pair);
            graph.pass("statistical.uniform", m_uniform[quadrants]).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(t.extent).read(t.root)
                .read(pair).write(blocked).write(visibility).constants(UniformConstants{evaluate, k == 0, k + 2 == layers}).dispatch(visible.x, visible.y);
        }
    }

    StatisticalTables m_tables;
    Denoise m_denoise;
    gpu::Program m_samples;
    gpu::Program m_uniform[2];      // one region, quadrants
    gpu::Program m_evaluate[2][4];  // likewise, by level
};

}  // namespace

MethodEntry statisticalEntry() { return {&kInfo, &Statistical::create}; }

}  // namespace obscura::ao
