#include "ao/offscreen.h"

#include <algorithm>
#include <utility>

#include "ao/offscreen/constants.h"
#include "ao/view.h"

namespace obscura::ao {
namespace {

constexpr uint32_t kScale = 2;      // a map of a quarter of the pixels
constexpr float kOffset = 2.0f;     // cells; the cells that touch a plane end sqrt(3) above it
constexpr float kGrain = 2.0f;      // px: finer noise flickers as the camera moves
constexpr uint32_t kOctave = 3;     // 8 steps an octave
constexpr float kWindow = 16.0f;    // px
constexpr float kRange = 0.25f;     // of the falloff's reach
constexpr float kFarthest = 1e18f;  // its square fits in a float

}  // namespace

Status OffScreenPass::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff, OffScreenPass& out) {
    const struct {
        const char* name;
        gpu::Program* program;
    } programs[] = {{"ao/offscreen/trace.comp", &out.m_trace[0]}, {"ao/offscreen/trace.comp:VOLUME_NANOVDB", &out.m_trace[1]},
        {"ao/offscreen/trace.comp:DEPTH_LAYERS", &out.m_layered[0]},
        {"ao/offscreen/trace.comp:VOLUME_NANOVDB,DEPTH_LAYERS", &out.m_layered[1]}};
    for (const auto& [name, program] : programs)
        if (gpu::Program::compute(device, shaders, name, {falloffConstant(falloff)}, *program) != gpu::Status::ok)
            return Status::shaderError;
    if (LayerPass::create(device, shaders, out.m_layerPass) != Status::ok) return Status::shaderError;
    return Upsample::create(device, shaders, out.m_upsample);
}

graph::ImageId OffScreenPass::add(
    graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const Blocking& blocking, const OffScreenSettings& settings) {
    if (settings.what == OffScreen::off) return visibility;
    if (!inputs.volume) {
        if (!std::exchange(m_warned, true))
            graph.device().log(
                gpu::Severity::warning, "offscreen: the frame has no volume (Frame::volume); only occluders in the image count");
        return visibility;
    }
    const auto& visible = inputs.view.visible;
    const uint32_t width = (visible.x + kScale - 1) / kScale, height = (visible.y + kScale - 1) / kScale;
    const graph::ImageId map = graph.image("offscreen.map", {VK_FORMAT_R16_SFLOAT, width, height});
    const graph::ImageId receivers = graph.image("offscreen.receivers", {VK_FORMAT_R32G32_UINT, width, height});
    const shared::OffscreenTrace trace{shared::sizeOf(width, height), inputs.falloff, settings.rays, settings.stride, kScale,
        settings.what == OffScreen::hidden ? 1u : 0u, kOffset, kGrain, std::min(blocking.reach, kFarthest), blocking.thickness, kOctave,
        volumeRaySteps(inputs.volume.volume, inputs.falloff.reach, settings.stride, kOctave), 0};
    const graph::ImageId layers = blocking.sheet >= 0.0f ? m_layerPass.add(graph, inputs, blocking.sheet) : graph::ImageId{};
    graph::Pass& pass = graph.pass("offscreen.trace", (layers ? m_layered : m_trace)[size_t(inputs.volume.structure)]);
    pass.read(inputs.viewBlock)
        .read(inputs.volume.block)
        .read(inputs.volume.bits)
        .read(inputs.depth)
        .read(inputs.normals)
        .write(map)
        .write(receivers);
    if (layers) pass.read(layers);
    pass.constants(trace).dispatch(width, height);
    return m_upsample.add(graph, inputs, {map, receivers}, {kScale, kWindow, kRange * inputs.falloff.reach}, "offscreen", visibility);
}

}  // namespace obscura::ao
