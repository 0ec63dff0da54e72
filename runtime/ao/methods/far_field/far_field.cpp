// Screen-space far-field ambient obscurance [Timonen: Screen-Space Far-Field Ambient Obscurance, HPG 2013]. The depth buffer is scanned
// along parallel lines in K directions. Every interval of B0 pixels of a line is reduced to two heights, which define its highest point as
// seen by receivers; longer intervals hold the maxima of shorter ones. A pixel then visits about seven such points in each of its K sectors
// from near to far, averaged over the sector's width, raises its horizon, and looks up what each rise blocks in a table of the falloff:
//     A = 1/pi sum over sectors of w_k |n_k| sum over visible points of integral of rho cos(theta - d) sin(theta)      [eq. 2, 3]
//
// Differences where the paper is incomplete or wrong:
// - Angles are measured from the zenith, so a point is visible if its angle is smaller [alg. 2 has the opposite comparison].
// - s = -1 with x = (m0 - m1) / s needs m1 = max(z - s x) [alg. 1 has + s x].
// - Intervals lie on one grid per direction, so that neighbouring lines can be averaged [alg. 1 starts anew on each line].
// - The four-dimensional table reduces exactly to two dimensions (shaders/ao/far_field/estimator.glsl).
// - Samples start at the projection of the receiver after it is raised by one pixel's footprint.
// - Prefix sums also count lines with a point, and lines in the image. Lines outside take no part in means; sky takes none in points, but
//   points then cover that fraction of a sector.
// - s is limited in wide views, where view rays are flatter than the receiver angle.
// The default extends the paper: below a point is a blend of slab and connection (to the previous point, visible or not: a line to the last
// visible point would block the gap between two columns), points are seen from above and below (s = 1), and are averaged as 1/depth by a
// lateral pyramid, which needs a sixth of the memory of prefix sums and no pass over every cell.
//
// With depth layers (`depth_layers`) there are two fields. The background, endless surfaces, is scanned as without layers, also behind
// objects. Objects are surfaces with a known back, so they are not heights: an interval keeps their means (coverage, front, back and
// slope of the front), and a receiver treats the corners of that segment as an arc with an opacity (shaders/ao/far_field/object_arcs.glsl).
// Only the pyramid reads layers, because it can average both fields.
//
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: table (when the falloff changes),
// scan, prefix sums or pyramid, obscurance (all three again for every batch of directions, if not all fit into memory); interleaved also
// near field, box average, gather, blur; with layers also fields, objects and objects pyramid.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "ao/falloff_table.h"
#include "ao/interleave.h"
#include "ao/layer_pass.h"
#include "ao/methods/far_field/layers.h"
#include "ao/methods/far_field/parameters.h"

namespace obscura::ao::far_field {
namespace {

class FarField final : public Method {
public:
    FarField(gpu::Device& device, const gpu::ShaderLibrary& shaders) : m_device(device), m_shaders(shaders) {}
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind) {
        auto result = std::make_unique<FarField>(device, shaders);
        if (FalloffTable::create(device, shaders, result->m_table) != gpu::Status::ok) return nullptr;
        for (uint32_t i = 0; i < 4; ++i) {
            const bool thin = i == uint32_t(Averaging::none) || i == uint32_t(Averaging::direct);
            const auto make = [&](const char* pass, std::initializer_list<gpu::Constant> constants, gpu::Program& program) {
                const char* end = i == uint32_t(Averaging::prefixSums) ? ".comp:SUMS" : ".comp";
                return gpu::Program::compute(device, shaders, std::string("ao/far_field/") + pass + end, constants, program) ==
                       gpu::Status::ok;
            };
            if (!make("scan", {{0, i}}, result->m_scan[i]) || !make("obscurance", {{0, i}, {1, 0}}, result->m_obscurance[i]) ||
                !make("interleaved", {{0, i}}, result->m_interleaved[i]) ||
                (thin && !make("obscurance", {{0, i}, {1, 1}}, result->m_thin[i])))
                return nullptr;
        }
        const struct {
            const char* name;
            gpu::Program* program;
        } programs[] = {{"prefix", &result->m_prefix}, {"pyramid", &result->m_pyramid}, {"gather", &result->m_gatherSimilar},
            {"blur", &result->m_blur}};
        for (uint32_t similar = 0; similar < 2; ++similar)
            if (gpu::Program::compute(device, shaders, "ao/far_field/box_average.comp", {{0, similar}}, result->m_boxAverage[similar]) !=
                gpu::Status::ok)
                return nullptr;
        if (Gather::create(device, shaders, result->m_gather) != Status::ok ||
            FarFieldLayers::create(device, shaders, result->m_layers) != gpu::Status::ok)
            return nullptr;
        if (gpu::Program::compute(device, shaders, "ao/far_field/obscurance_layers.comp", {{0, uint32_t(Averaging::pyramid)}},
                result->m_layered) != gpu::Status::ok)
            return nullptr;
        for (const auto& [name, program] : programs)
            if (gpu::Program::compute(device, shaders, std::string("ao/far_field/") + name + ".comp", {}, *program) != gpu::Status::ok)
                return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const shared::View& view = inputs.view;
        const bool layered = inputs.layers.thickness && readsLayers(values);
        const float thickness = values["thickness"];
        const uint32_t side = thickness > 0.0f ? 1 : tileSide(values);
        auto averaging = Averaging(values.count("averaging"));
        if (thickness > 0.0f && averaging != Averaging::direct) averaging = Averaging::none;
        const uint32_t directions = std::min(sharedOut(values.count("directions"), side), 32u / (side * side) * side * side),
                       lineStep = 1u << values.count("lines");
        const FarFieldLimits limits{uint64_t(values.count("memory")) << 20, graph.device().caps().maxImageSize};
        FarFieldGrid grid = farFieldGrid(view.size, directions, values.count("interval"), lineStep, averaging, limits);
        if (grid.interval != values.count("interval") && grid.interval != m_widened)
            graph.device().log(gpu::Severity::warning,
                fmt::format("far_field: interval is {} px, because the points of a direction do not fit into memory = {} MB and images of "
                            "{} rows",
                    grid.interval, values.count("memory"), limits.rows));
        m_widened = grid.interval;
        if (std::string text = withoutEffect(values); text != m_withoutEffect) {
            if (!text.empty()) graph.device().log(gpu::Severity::warning, "far_field: " + text);
            m_withoutEffect = std::move(text);
        }
        const float slope = std::abs(values["slope"]) < 0.01f ? 1.0f : values["slope"];
        setAxes(grid, view, slope);
        const float connections[] = {0.0f, 1.0f, 0.75f};
        shared::FarFieldConstants constants{};
        constants.directions = directions;
        constants.stride = 1;
        constants.segments = values.count("segments");
        constants.levels = grid.levels;
        constants.interval = float(grid.interval);
        constants.perInterval = 256.0f / constants.interval;
        constants.lineStep = float(lineStep);
        constants.connection = connections[values.count("estimator")];
        constants.longest = values["longest"];
        constants.unit = inputs.falloffDesc.length;
        constants.taps = values.count("near");
        constants.parts = values.count("parts") ? values.count("parts") : shared::kNearPart | shared::kFarPart;
        constants.paired = grid.half < directions;
        constants.count = grid.half;
        constants.thickness = thickness;
        constants.jitter = values["jitter"];
        constants.alternate = side == 1 && constants.jitter <= 0.0f && values.count("alternate");

        const FarFieldLayers::Fields fields =
            layered ? m_layers.split(graph, inputs, values["sheet"]) : FarFieldLayers::Fields{inputs.depth, {}};
        Scanned scanned{grid,
            graph.upload("far_field.directions", grid.directions.data(), grid.directions.size() * sizeof(shared::Direction)), fields, {},
            inputs.normals, {}, averaging, constants};
        if (averaging != Averaging::direct) scanned.cells = graph.image("far_field.cells", {grid.format, shared::kCellsWide, grid.rows});
        if (side > 1) return interleaved(graph, inputs, scanned, side, values.count("neighbours"), values["blur"]);
        const auto& visible = view.visible;
        const graph::ImageId result = graph.image("far_field.obscurance", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph::ImageId sums;
        if (grid.batch < grid.half) sums = graph.image("far_field.sums", {VK_FORMAT_R32G32_SFLOAT, visible.x, visible.y});
        for (uint32_t first = 0; first < grid.half; first += grid.batch) {
            scan(graph, inputs, scanned, first);
            if (!obscurance(graph, inputs, scanned, "far_field.obscurance", result, sums)) return graph::ImageId{};
        }
        return result;
    }

    // Without layers even the farthest surface is endless.
    Blocking blocking(const Inputs& inputs, const Values& values) const override {
        const Blocking bare{Blocking::kEndless, values["thickness"] > 0.0f ? values["thickness"] : Blocking::kEndless};
        return readsLayers(values) ? blockingWithLayers(bare, inputs, values) : bare;
    }

private:
    struct Scanned {
        const FarFieldGrid& grid;
        graph::BufferId grids;
        FarFieldLayers::Fields fields;  // without layers the background alone
        graph::ImageId table;
        graph::ImageId cells;        // bound but not read if there are no cells
        graph::ImageId objectCells;  // with layers
        Averaging averaging;
        shared::FarFieldConstants constants;
    };

    // Cells of the batch that begins with a direction; they replace those before it. The first time also the table.
    void scan(graph::Graph& graph, const Inputs& inputs, Scanned& scanned, uint32_t first) {
        const FarFieldGrid& grid = scanned.grid;
        shared::FarFieldConstants& constants = scanned.constants;
        constants.first = first;
        constants.count = std::min(grid.batch, grid.half - first);
        if (scanned.averaging != Averaging::direct) cells(graph, inputs, scanned);
        if (first == 0) scanned.table = m_table.add(graph, inputs, "far_field.table");
        if (scanned.fields.objects)
            scanned.objectCells = m_layers.scan(graph, inputs, scanned.fields.objects, scanned.grids, grid, constants);
    }

    void cells(graph::Graph& graph, const Inputs& inputs, const Scanned& scanned) {
        const FarFieldGrid& grid = scanned.grid;
        const shared::FarFieldConstants& constants = scanned.constants;
        const uint32_t run = scanned.averaging == Averaging::pyramid ? 1 : 1u << (grid.levels - 1),
                       directions = constants.paired ? 2 * constants.count : constants.count;
        graph.pass("far_field.scan", m_scan[uint32_t(scanned.averaging)])
            .read(inputs.viewBlock)
            .read(scanned.fields.background)
            .read(scanned.grids)
            .write(scanned.cells)
            .constants(constants)
            .dispatch(grid.lines, grid.intervals / run, constants.count);
        if (scanned.averaging == Averaging::prefixSums)
            graph.pass("far_field.prefix sums", m_prefix)
                .read(scanned.grids)
                .write(scanned.cells)
                .constants(constants)
                .dispatch(grid.intervals, grid.levels, directions);
        for (uint32_t from = 0; scanned.averaging == Averaging::pyramid && from + 1 < grid.levels; from += 3) {
            const uint32_t block = 8u << from;
            graph.pass("far_field.pyramid", m_pyramid)
                .read(inputs.viewBlock)
                .read(scanned.grids)
                .write(scanned.cells)
                .constants(shared::FarFieldPyramid{constants, from})
                .dispatch((grid.lines + block - 1) / block, (grid.intervals + block - 1) / block, directions);
        }
    }

    // A program for batches of directions, made when it is first needed: images that need them are large. Null if it cannot be made.
    gpu::Program* batched(const char* pass, Averaging averaging, bool thin = false) {
        gpu::Program& program = m_batched[{pass, averaging, thin}];
        std::vector<gpu::Constant> constants{{0, uint32_t(averaging)}};
        if (thin) constants.push_back({1, 1});
        const char* end = averaging == Averaging::prefixSums ? ".comp:SUMS,BATCH" : ".comp:BATCH";
        if (!program &&
            gpu::Program::compute(m_device, m_shaders, std::string("ao/far_field/") + pass + end, constants, program) != gpu::Status::ok)
            return nullptr;
        return &program;
    }

    // Adds to `sums`, of batches of directions, unless there is one batch. False if a program cannot be made.
    bool obscurance(graph::Graph& graph, const Inputs& inputs, const Scanned& scanned, const char* name, graph::ImageId result,
        graph::ImageId sums = {}) {
        const bool thin = scanned.constants.thickness > 0.0f, layered = bool(scanned.objectCells);
        gpu::Program* program = layered ? &m_layered : &(thin ? m_thin : m_obscurance)[uint32_t(scanned.averaging)];
        if (sums) program = batched(layered ? "obscurance_layers" : "obscurance", scanned.averaging, thin);
        if (!program) return false;
        graph::Pass& pass = graph.pass(name, *program)
                                .read(inputs.viewBlock)
                                .read(scanned.fields.background)
                                .read(inputs.normals)
                                .read(scanned.grids)
                                .read(scanned.cells)
                                .read(scanned.table)
                                .write(result)
                                .constants(scanned.constants);
        if (layered) pass.read(scanned.fields.objects).read(scanned.objectCells).read(inputs.depth);
        if (sums) pass.write(sums);
        pass.dispatch(inputs.view.visible.x, inputs.view.visible.y);
        return true;
    }

    static bool readsLayers(const Values& values) {
        return layerModeOf(values) != LayerMode::none && Averaging(values.count("averaging")) == Averaging::pyramid &&
               values["thickness"] <= 0.0f && tileSide(values) == 1;
    }

    // [Timonen 2013, sec. 10]: every pixel evaluates its whole near field; the far field is interleaved over a tile.
    graph::ImageId interleaved(graph::Graph& graph, const Inputs& inputs, Scanned& scanned, uint32_t side, bool similar, float threshold) {
        const auto& visible = inputs.view.visible;
        scanned.constants.side = side;
        Scanned near = scanned;
        near.constants.segments = 1;
        // Stride 2 is not in the paper: it halves the time and adds an error of 0.002.
        near.constants.stride = scanned.averaging == Averaging::pyramid && scanned.constants.directions >= 16 ? 2 : 1;
        near.constants.alternate = near.constants.stride > 1 && near.constants.jitter <= 0.0f;  // nine directions have no mirror image
        near.constants.parts &= shared::kNearPart;
        scanned.constants.parts &= shared::kFarPart;
        const graph::ImageId nearField = graph.image("far_field.near field", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        const graph::ImageId surfaces = graph.image("far_field.surfaces", {VK_FORMAT_R32G32_UINT, visible.x, visible.y});
        const graph::ImageId shares = graph.image("far_field.shares", {VK_FORMAT_R16G16_SFLOAT, visible.x, visible.y});
        for (uint32_t first = 0; first < scanned.grid.half; first += scanned.grid.batch) {
            scan(graph, inputs, scanned, first);
            if (first == 0) {
                near.table = scanned.table;
                obscurance(graph, inputs, near, "far_field.near field", nearField);
                graph.pass("far_field.box average", m_boxAverage[similar])
                    .read(inputs.viewBlock)
                    .read(inputs.depth)
                    .read(inputs.normals)
                    .write(surfaces)
                    .constants(shared::FarFieldBoxAverage{side})
                    .dispatch(visible.x, visible.y);
            }
            gpu::Program* program = &m_interleaved[uint32_t(scanned.averaging)];
            if (scanned.grid.batch < scanned.grid.half) program = batched("interleaved", scanned.averaging);
            if (!program) return {};
            graph.pass("far_field.obscurance", *program)
                .read(inputs.viewBlock)
                .read(inputs.depth)
                .read(surfaces)
                .read(scanned.grids)
                .read(scanned.cells)
                .read(scanned.table)
                .write(shares)
                .constants(scanned.constants)
                .dispatch(visible.x, visible.y);
        }
        const graph::ImageId gathered =
            similar ? graph.image("far_field.gathered", graph.desc(nearField)) : m_gather.add(graph, inputs, shares, side, nearField);
        if (similar)
            graph.pass("far_field.gather", m_gatherSimilar)
                .read(inputs.viewBlock)
                .read(inputs.depth)
                .read(inputs.normals)
                .read(shares)
                .read(nearField)
                .write(gathered)
                .constants(shared::Gather{side})
                .dispatch(visible.x, visible.y);
        if (threshold <= 0.0f) return gathered;
        const graph::ImageId blurred = graph.image("far_field.blurred", graph.desc(gathered));
        graph.pass("far_field.blur", m_blur)
            .read(inputs.viewBlock)
            .read(inputs.depth)
            .read(gathered)
            .write(blurred)
            .constants(shared::FarFieldBlur{threshold})
            .dispatch(visible.x, visible.y);
        return blurred;
    }

    gpu::Device& m_device;
    const gpu::ShaderLibrary& m_shaders;
    uint32_t m_widened = 0;       // the interval of the last frame, for the log
    std::string m_withoutEffect;  // as logged last
    FalloffTable m_table;
    std::map<std::tuple<std::string, Averaging, bool>, gpu::Program> m_batched;
    gpu::Program m_scan[4], m_obscurance[4], m_thin[4], m_interleaved[4];  // by averaging
    gpu::Program m_boxAverage[2];                                          // neighbours by plane, by depth
    gpu::Program m_prefix, m_pyramid, m_gatherSimilar, m_blur, m_layered;
    FarFieldLayers m_layers;
    Gather m_gather;
};

}  // namespace

MethodEntry entry() { return {.info = &kInfo, .create = &FarField::create, .perFalloff = false}; }

}  // namespace obscura::ao::far_field
