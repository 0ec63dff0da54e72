// Screen-space far-field ambient obscurance [Timonen: Screen-Space Far-Field Ambient Obscurance, HPG 2013]. The depth buffer is scanned
// along parallel lines in K directions; every B0 pixels a line leaves the two heights that make up its highest point as receivers see it,
// and longer intervals leave the maxima of shorter ones. A pixel then walks each of its K sectors outwards over some seven such points,
// averaged over the sector's width, raises its horizon, and looks up what each rise blocks in a table of the falloff:
//     A = 1/pi sum over sectors of w_k |n_k| sum over visible points of integral of rho cos(theta - d) sin(theta)      [eq. 2, 3]
//
// Where the paper is silent or mistaken:
// - Angles are from the zenith, so a point is visible when its angle is smaller [alg. 2 compares the other way].
// - s = -1 with x = (m0 - m1) / s needs m1 = max(z - s x) [alg. 1 has + s x].
// - Intervals lie on a grid of the whole direction, not of each line, or there is nothing to average [alg. 1 counts down each line].
// - The four-dimensional table is exactly two-dimensional (shaders/ao/far_field/estimator.glsl).
// - Samples start from where the receiver, raised by a pixel's footprint, is seen.
// - Lines that are sky or outside are left out of means, by a third prefix sum that counts lines.
// The default goes further: points hang on lines between slab and connection (to the point walked over before, visible or not: a line to the
// last visible one blocks what lies open between two columns), are seen from above and below (s = 1), and are averaged as
// 1/depth by a lateral pyramid, which needs a sixth of the memory of prefix sums and no pass over every cell.
//
// With depth layers (`depth_layers`) there are two fields. What goes on without end, the background, is scanned as ever, behind things too. Things
// end, so they are no heights: of an interval their means are kept, covered share, front, back and slant, and a receiver takes the corners of
// such a stretch for an arc of so much opacity (shaders/ao/far_field/things_met.glsl). Read by the pyramid alone, which can average both.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: table (when the falloff is new),
// scan, prefix sums or pyramid, obscurance; interleaved also near field, box average, gather, blur; with layers also fields, things and their pyramid.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "ao/resolve.h"
#include "ao/spans.h"
#include "far_field_layers.h"

namespace obscura::ao {
namespace {

const char* const kAveragings[] = {"none", "prefix sums", "pyramid", "direct"};
constexpr float kNine = 2;  // interleave: 3x3
enum Estimator : uint32_t { kSlab, kConnected, kBlended };
const char* const kEstimators[] = {"slab", "connected", "blended"};
const char* const kParts[] = {"both", "near", "far"};
const char* const kOffOn[] = {"off", "on"};
const char* const kSparsities[] = {"every", "every 2nd", "every 4th"};

const Parameter kParameters[] = {
    {"directions", "", 4, 32, 12, true, {}, "Directions in which the depth buffer is scanned, K; even numbers share walks between opposite ones."},
    {"segments", "", 1, 8, 2, true, {}, "Parts of each sector, evaluated one by one; the cost per pixel grows with directions x segments."},
    {"interval", "px", 3, 20, 5, true, {}, "Shortest interval that keeps one point, B0; longer ones cost less and leave more to the near field."},
    {"longest", "", 0.25f, 1, 0.5f, false, {}, "Longest interval, parts of its distance; the paper's is 1. Intervals run along a sector's middle, so long ones reach across its sides and leave bands."},
    {"lines", "", 0, 2, 0, true, {kSparsities, 3}, "Which of the lines, a pixel apart, are scanned."},
    {"slope", "", -2, 2, 1, false, {}, "Slope of the second angle at which intervals are seen, s; the paper's is -1, from above. 0 counts as 1."},
    {"estimator", "", 0, 2, 2, true, {kEstimators, 3}, "What stands below a point: a slab away from the camera as in the paper, the connection to the point before it, or between both."},
    {"averaging", "", 0, 3, 2, true, {kAveragings, 4}, "How points are averaged over a sector's width: not at all, by the paper's prefix sums, or by a lateral pyramid of 1/depth; direct: single texels of the depth buffer, without scans."},
    {"near", "", 0, 16, 5, true, {}, "Samples of the near field in each segment; 0 leaves the far field alone."},
    {"parts", "", 0, 2, 0, true, {kParts, 3}, "What is shown: both fields, the near one alone, or the far one alone above the near one's horizon."},
    kInterleave,
    {"thickness", "m", 0, 100, 0, false, {}, "How thick surfaces are, kept in 32 bins of each sector; 0 is endless. Thin ones are neither averaged nor interleaved."},
    {"jitter", "", 0, 1, 0, false, {}, "How much of its segment a pixel's directions are turned by, at random: noise instead of bands. Not interleaved."},
    {"alternate", "", 0, 1, 1, true, {kOffOn, 2}, "Every other pixel's directions are turned by half a segment: bands become a fine checkerboard, weak but beside tall things. Neither interleaved nor jittered."},
    {"depth_layers", "", 0, 3, 0, true, {kLayerChoices, 4}, "What is read of what lies behind the visible surface, so that things end where they do; each more costs geometry passes. By the pyramid alone: neither with thickness nor interleaved."},
    kSheet,
    {"blur", "", 0, 0.5f, 0.07f, false, {}, "After interleaving: 5x5 over neighbours whose visibility differs by no more than this; 0 for none."},
};
const Setting kPaper8[] = {{"directions", 8}, {"segments", 2}, {"alternate", 0}, {"interval", 10}, {"longest", 1}, {"slope", -1}, {"estimator", kSlab}, {"averaging", 1}, {"near", 5}};
const Setting kPaper16[] = {{"directions", 16}, {"segments", 2}, {"alternate", 0}, {"interval", 5}, {"longest", 1}, {"slope", -1}, {"estimator", kSlab}, {"averaging", 1}, {"near", 5}};
const Setting kPaperSaao[] = {{"directions", 18}, {"segments", 2}, {"interval", 10}, {"longest", 1}, {"slope", -1},
                              {"estimator", kSlab}, {"averaging", 1}, {"near", 5}, {"interleave", kNine}};
const Setting kFast[] = {{"directions", 18}, {"segments", 2}, {"longest", 1}, {"near", 3}, {"interleave", kNine}};
const Setting kThin[] = {{"directions", 16}, {"segments", 1}, {"longest", 1}, {"averaging", 0}, {"near", 3}, {"thickness", 0.1f}, {"jitter", 1}};
const Setting kLayers[] = {{"depth_layers", float(LayerUse::second)}};
const Preset kPresets[] = {
    {"default", "12 directions x 2 segments, blended estimator, lateral pyramid.", {}},
    {"paper_8x2", "The paper's smaller setting.", {kPaper8, std::size(kPaper8)}},
    {"paper_16x2", "The paper's larger setting.", {kPaper16, std::size(kPaper16)}},
    {"paper_saao", "The paper's interleaved setting: 18 directions x 2 segments, blurred.", {kPaperSaao, std::size(kPaperSaao)}},
    {"fast", "Interleaved over 3x3 pixels: a ninth of the far field a pixel.", {kFast, std::size(kFast)}},
    {"layers", "The default through depth layers: what ends hides nothing behind it.", {kLayers, std::size(kLayers)}},
    {"thin", "Surfaces 10 cm thick, 16 single lines, jittered.", {kThin, std::size(kThin)}},
};
const MethodInfo kInfo{"far_field",
                       "Far-field ambient obscurance",
                       "Timonen: Screen-Space Far-Field Ambient Obscurance, HPG 2013",
                       "Occluders from the whole depth buffer, at a cost that no radius or falloff changes.",
                       kDepth | kNormals,
                       {kParameters, std::size(kParameters)},
                       {kPresets, std::size(kPresets)}};

class FarField final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders) {
        auto result = std::make_unique<FarField>();
        if (FalloffTable::create(device, shaders, result->m_table) != gpu::Status::ok) return nullptr;
        for (uint32_t i = 0; i < 4; ++i) {
            const bool thin = i == uint32_t(Averaging::none) || i == uint32_t(Averaging::direct);
            const auto make = [&](const char* pass, std::initializer_list<gpu::Constant> constants, gpu::Program& program) {
                const char* end = i == uint32_t(Averaging::prefixSums) ? "_sums.comp" : ".comp";
                return gpu::Program::compute(device, shaders, std::string("ao/far_field/") + pass + end, constants, program) == gpu::Status::ok;
            };
            if (!make("scan", {{0, i}}, result->m_scan[i]) || !make("obscurance", {{0, i}, {1, 0}}, result->m_obscurance[i]) ||
                !make("interleaved", {{0, i}}, result->m_interleaved[i]) || (thin && !make("obscurance", {{0, i}, {1, 1}}, result->m_thin[i]))) return nullptr;
        }
        const struct { const char* name; gpu::Program* program; } programs[] = {{"prefix", &result->m_prefix}, {"pyramid", &result->m_pyramid},
                                                                                {"box_average", &result->m_boxAverage}, {"blur", &result->m_blur}};
        if (Gather::create(device, shaders, result->m_gather) != Status::ok || LayerFields::create(device, shaders, result->m_fields) != gpu::Status::ok) return nullptr;
        if (gpu::Program::compute(device, shaders, "ao/far_field/obscurance_layers.comp", {{0, uint32_t(Averaging::pyramid)}}, result->m_layered) != gpu::Status::ok) return nullptr;
        for (const auto& [name, program] : programs)
            if (gpu::Program::compute(device, shaders, std::string("ao/far_field/") + name + ".comp", {}, *program) != gpu::Status::ok) return nullptr;
        return result;
    }

    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const shared::View& view = inputs.view;
        const bool layered = inputs.layers.thickness && readsLayers(values);
        const float thickness = values["thickness"];
        const uint32_t side = thickness > 0.0f ? 1 : tileSide(values);
        auto averaging = Averaging(values.count("averaging"));
        if (thickness > 0.0f && averaging != Averaging::direct) averaging = Averaging::none;
        const uint32_t directions = std::min(sharedOut(values.count("directions"), side), 32u / (side * side) * side * side), lineStep = 1u << values.count("lines");
        const FarFieldGrid grid = farFieldGrid(view.size, directions, values.count("interval"), lineStep, averaging, graph.device().caps().maxImageSize);
        const float slope = values["slope"];
        const float connections[] = {0.0f, 1.0f, 0.75f};
        shared::FarFieldConstants constants{};
        constants.directions = directions;
        constants.stride = 1;
        constants.segments = values.count("segments");
        constants.levels = grid.levels;
        constants.interval = float(grid.interval);
        constants.lineStep = float(lineStep);
        constants.slope = std::abs(slope) < 0.01f ? 1.0f : slope;
        constants.connection = connections[values.count("estimator")];
        constants.longest = values["longest"];
        constants.unit = inputs.falloffDesc.length;
        constants.taps = values.count("near");
        constants.parts = values.count("parts") ? values.count("parts") : shared::kNearPart | shared::kFarPart;
        constants.paired = directions % 2 == 0;
        constants.thickness = thickness;
        constants.jitter = values["jitter"];
        constants.alternate = side == 1 && constants.jitter <= 0.0f && values.count("alternate");

        const LayerFields::Fields fields = layered ? m_fields.split(graph, inputs, values["sheet"]) : LayerFields::Fields{inputs.depth, {}};
        const graph::BufferId grids = graph.upload("far_field.directions", grid.directions.data(), grid.directions.size() * sizeof(shared::Direction));
        graph::ImageId cells = inputs.normals;  // something to bind where there are none
        if (averaging != Averaging::direct) cells = graph.image("far_field.cells", {grid.format, shared::kCellsWide, grid.rows});
        const uint32_t run = averaging == Averaging::pyramid ? 1 : 1u << (grid.levels - 1);
        if (averaging != Averaging::direct) graph.pass("far_field.scan", m_scan[uint32_t(averaging)]).read(inputs.viewBlock).read(fields.background).read(grids).write(cells)
            .constants(constants).dispatch(grid.lines, grid.intervals / run, constants.paired ? directions / 2 : directions);
        if (averaging == Averaging::prefixSums)
            graph.pass("far_field.prefix sums", m_prefix).read(grids).write(cells).constants(constants).dispatch(grid.intervals, grid.levels, directions);
        for (uint32_t from = 0; averaging == Averaging::pyramid && from + 1 < grid.levels; from += 3) {
            const struct { shared::FarFieldConstants constants; uint32_t from; } levels{constants, from};
            const uint32_t block = 8u << from;
            graph.pass("far_field.pyramid", m_pyramid).read(inputs.viewBlock).read(grids).write(cells).constants(levels)
                .dispatch((grid.lines + block - 1) / block, (grid.intervals + block - 1) / block, directions);
        }
        const Scanned scanned{grids, cells, m_table.add(graph, inputs, "far_field.table"), averaging, constants};
        if (layered) return layers(graph, inputs, scanned, fields, m_fields.scan(graph, inputs, fields.things, grids, grid, constants));
        return side > 1 ? interleaved(graph, inputs, scanned, side, values["blur"]) : obscurance(graph, inputs, scanned, "far_field.obscurance");
    }

    // Scans have no end: the farthest surface hides what is behind it, unless layers tell where it ends.
    Blocking blocking(const Inputs& inputs, const Values& values) const override {
        const Blocking bare{Blocking::kEndless, values["thickness"] > 0.0f ? values["thickness"] : Blocking::kEndless};
        return readsLayers(values) ? blockingOfSpans(bare, inputs, values) : bare;
    }

private:
    struct Scanned {
        graph::BufferId grids;
        graph::ImageId cells;
        graph::ImageId table;
        Averaging averaging;
        shared::FarFieldConstants constants;
    };

    graph::ImageId obscurance(graph::Graph& graph, const Inputs& inputs, const Scanned& scanned, const char* name) {
        const auto& visible = inputs.view.visible;
        const graph::ImageId result = graph.image(name, {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        auto& programs = scanned.constants.thickness > 0.0f ? m_thin : m_obscurance;
        graph.pass(name, programs[uint32_t(scanned.averaging)]).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).read(scanned.grids)
            .read(scanned.cells).read(scanned.table).write(result).constants(scanned.constants).dispatch(visible.x, visible.y);
        return result;
    }

    static bool readsLayers(const Values& values) {
        return layersOf(values) != LayerUse::none && Averaging(values.count("averaging")) == Averaging::pyramid && values["thickness"] <= 0.0f && tileSide(values) == 1;
    }

    graph::ImageId layers(graph::Graph& graph, const Inputs& inputs, const Scanned& scanned, const LayerFields::Fields& fields, graph::ImageId thingCells) {
        const auto& visible = inputs.view.visible;
        const graph::ImageId result = graph.image("far_field.obscurance", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph.pass("far_field.obscurance", m_layered).read(inputs.viewBlock).read(fields.background).read(inputs.normals).read(scanned.grids).read(scanned.cells)
            .read(scanned.table).write(result).read(fields.things).read(thingCells).read(inputs.depth).constants(scanned.constants).dispatch(visible.x, visible.y);
        return result;
    }

    // [Timonen 2013, sec. 10]: the whole near field of every pixel, the far field shared out over a tile of pixels.
    graph::ImageId interleaved(graph::Graph& graph, const Inputs& inputs, const Scanned& scanned, uint32_t side, float threshold) {
        const auto& visible = inputs.view.visible;
        Scanned near = scanned, far = scanned;
        near.constants.segments = 1;
        near.constants.stride = scanned.averaging == Averaging::pyramid && scanned.constants.directions >= 16 ? 2 : 1;  // not in the paper's: half the time, 0.002
        near.constants.parts &= shared::kNearPart;
        far.constants.parts &= shared::kFarPart;
        near.constants.side = far.constants.side = side;
        const graph::ImageId nearField = obscurance(graph, inputs, near, "far_field.near field");
        const graph::ImageId surfaces = graph.image("far_field.surfaces", {VK_FORMAT_R32G32_UINT, visible.x, visible.y});
        graph.pass("far_field.box average", m_boxAverage).read(inputs.viewBlock).read(inputs.depth).read(inputs.normals).write(surfaces)
            .constants(side).dispatch(visible.x, visible.y);
        const graph::ImageId parts = graph.image("far_field.parts", {VK_FORMAT_R16G16_SFLOAT, visible.x, visible.y});
        graph.pass("far_field.obscurance", m_interleaved[uint32_t(far.averaging)]).read(inputs.viewBlock).read(inputs.depth).read(surfaces).read(far.grids)
            .read(far.cells).read(far.table).write(parts).constants(far.constants).dispatch(visible.x, visible.y);
        const graph::ImageId gathered = m_gather.add(graph, inputs, parts, side, nearField);
        if (threshold <= 0.0f) return gathered;
        const graph::ImageId blurred = graph.image("far_field.blurred", graph.desc(gathered));
        graph.pass("far_field.blur", m_blur).read(gathered).write(blurred).constants(threshold).dispatch(visible.x, visible.y);
        return blurred;
    }

    void reset() override { m_table.reset(); }

    FalloffTable m_table;
    gpu::Program m_scan[4], m_obscurance[4], m_thin[4], m_interleaved[4];  // by averaging
    gpu::Program m_prefix, m_pyramid, m_boxAverage, m_blur, m_layered;
    LayerFields m_fields;
    Gather m_gather;
};

}  // namespace

MethodEntry farFieldEntry() { return {&kInfo, &FarField::create}; }

}  // namespace obscura::ao
