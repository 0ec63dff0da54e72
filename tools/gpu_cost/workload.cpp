#include "gpu_cost/workload.h"

#include <cmath>
#include <cstddef>
#include <cstring>

#include <fmt/format.h>

#include "ao/common/constants.h"
#include "ao/layer_pass.h"
#include "ao/library.h"
#include "app/complaint.h"

namespace obscura::gpu_cost {
namespace {

ao::Frame frameOf(uint32_t width, uint32_t height) {
    ao::Frame frame;
    frame.size = {width, height};
    const float fy = 1.0f / std::tan(0.5236f), fx = fy * float(height) / float(width);  // 60 degrees high, infinite reversed depth
    const float projection[16] = {fx, 0, 0, 0, 0, -fy, 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0};
    std::memcpy(frame.projection, projection, sizeof(projection));
    frame.motionScale[0] = frame.motionScale[1] = 1.0f;
    return frame;
}

}  // namespace

Workload workloadOf(gpu::Device& device, const gpu::ShaderLibrary& shaders, const ao::Values& values, const ao::Falloff& falloff,
    uint32_t width, uint32_t height) {
    constexpr uint32_t kCells = 256, kLevels = 5;
    constexpr float kCellSize = 0.07f;
    ao::Library library(device, shaders);
    if (!library.prepare(values, falloff.kind))
        throw app::Complaint(fmt::format("{}: its pipelines cannot be made", values.info().id), app::kFailed);
    ao::Frame frame = frameOf(width, height);
    frame.volume.cells = kCells;
    frame.volume.levels = kLevels;
    for (int i = 0; i < 3; ++i) frame.volume.cellFromEye[5 * i] = 1.0f / kCellSize, frame.volume.cellFromEye[12 + i] = kCells / 2;
    frame.volume.cellFromEye[15] = 1.0f;

    graph::Graph graph(device);
    graph.begin();
    const auto given = [&](const char* name, VkFormat format, uint32_t divisor = 1) {
        graph::External external;
        external.desc = {format, width / divisor, height / divisor};
        return graph.import(name, external);
    };
    ao::Sources sources;
    sources.depth = given("depth", VK_FORMAT_D32_SFLOAT);
    sources.normals = given("normals", VK_FORMAT_R16G16B16A16_SFLOAT);
    sources.motion = given("motion", VK_FORMAT_R16G16_SFLOAT);
    const ao::LayerMode layers = values.has(ao::kDepthLayers.id) ? ao::layerModeOf(values) : ao::LayerMode::none;
    if (layers != ao::LayerMode::none) sources.layers.thickness = given("thickness", VK_FORMAT_R16_SFLOAT);
    if (layers == ao::LayerMode::secondHalf) sources.layers.second = given("second layer", VK_FORMAT_R16G16_SFLOAT, 2);
    if (layers == ao::LayerMode::second) sources.layers.second = given("second layer", VK_FORMAT_R16G16_SFLOAT);
    const std::vector<uint32_t> bits(size_t(kLevels) * kCells * kCells * kCells / 32);
    sources.volume = graph.upload("volume", bits.data(), bits.size() * sizeof(uint32_t));
    const ao::Library::Added added = library.add(graph, frame, sources, falloff, values);
    if (!added.visibility) throw app::Complaint(fmt::format("{}: its frame is refused", values.info().id), app::kFailed);

    graph.output(added.visibility);
    if (added.bentNormals) graph.output(added.bentNormals);
    if (!graph.resolve()) throw app::Complaint(fmt::format("{}: its passes contradict their shaders", values.info().id), app::kFailed);
    Workload load{width, height, {}};
    for (const graph::Plan::Step& step : graph::plan(graph.recording()).steps) {
        const graph::Pass& pass = graph.declared(step.pass);
        if (!pass.program()) continue;
        PassLoad one{graph.recording().passes[step.pass].name, pass.program()->shader(), pass.program()->specialization(), {}, 1, 0};
        one.constants.assign(pass.constants().begin(), pass.constants().end());
        if (one.shader.starts_with("ao/common/temporal.comp")) {  // the first frame has no history, all later ones have
            const uint32_t valid = 1;
            std::memcpy(one.constants.data() + offsetof(shared::Reproject, valid), &valid, sizeof(valid));
        }
        for (size_t axis = 0; axis < 3; ++axis) {
            const uint32_t group = pass.program()->workgroup()[axis];
            one.invocations *= (pass.invocations()[axis] + group - 1) / group * group;
        }
        for (const graph::Use& use : graph.recording().passes[step.pass].uses) {
            const graph::Resource& r = graph.recording().resources[use.resource];
            one.bytes += r.isBuffer ? r.bytes : uint64_t(r.desc.width) * r.desc.height * gpu::bytesPerTexel(r.desc.format);
        }
        load.passes.push_back(std::move(one));
    }
    return load;
}

}  // namespace obscura::gpu_cost
