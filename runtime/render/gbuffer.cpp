#include "render/gbuffer.h"

namespace obscura::render {
namespace {

constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT, kNormals = VK_FORMAT_R32_UINT, kMotion = VK_FORMAT_R16G16_SFLOAT,
                   kBaseColor = VK_FORMAT_R8G8B8A8_SRGB, kMaterial = VK_FORMAT_R8G8B8A8_UNORM, kEmission = VK_FORMAT_B10G11R11_UFLOAT_PACK32;

}  // namespace

void addVertexInput(gpu::GraphicsState& state) {
    constexpr VkVertexInputRate kRate = VK_VERTEX_INPUT_RATE_VERTEX;
    state.vertexBindings = {{0, kPositionBytes, kRate}, {1, kPositionBytes, kRate}, {2, kFrameBytes, kRate}, {3, kCoordsBytes, kRate}};
    state.vertexAttributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},     {1, 1, VK_FORMAT_R32G32B32_SFLOAT, 0},
                              {2, 2, VK_FORMAT_R16G16B16A16_SNORM, 0},   {3, 2, VK_FORMAT_R16G16B16A16_SNORM, 8},
                              {4, 3, VK_FORMAT_R32G32B32A32_SFLOAT, 0},  {5, 3, VK_FORMAT_R16G16B16A16_SFLOAT, 16}};
}

gpu::Status GBufferPass::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, GBufferPass& out) {
    gpu::GraphicsState state;
    state.colorFormats = {kNormals, kNormals, kMotion, kBaseColor, kMaterial, kEmission};
    state.depthFormat = kDepth;
    state.depthTest = state.depthWrite = true;
    addVertexInput(state);
    const gpu::Status status = gpu::Program::graphics(device, shaders, "scene/gbuffer.vert", "scene/gbuffer.frag", state, {{0, 0}}, out.m_solid);
    return status == gpu::Status::ok ? gpu::Program::graphics(device, shaders, "scene/gbuffer.vert", "scene/gbuffer.frag", state, {{0, 1}}, out.m_masked)
                                     : status;
}

GBuffer GBufferPass::add(graph::Graph& graph, VkExtent2D size, graph::BufferId frame, graph::BufferId items, const DrawList& list,
                         const Deform::Posed& posed, Materials& materials) {
    const auto image = [&](const char* name, VkFormat format) { return graph.image(name, {format, size.width, size.height}); };
    const GBuffer g{image("depth", kDepth), image("normals", kNormals), image("shaded normals", kNormals), image("motion", kMotion),
                    image("base colour", kBaseColor), image("material", kMaterial), image("emission", kEmission)};
    const VkClearColorValue zero{};
    graph::Pass& pass = graph.pass("gbuffer", m_solid).read(frame).read(items);
    if (posed.now) pass.use(posed.now, graph::Access::vertex).use(posed.before, graph::Access::vertex).use(posed.frames, graph::Access::vertex);
    pass.color(g.geometric, zero).color(g.shaded, zero).color(g.motion, zero).color(g.baseColor, zero).color(g.material, zero).color(g.emission, zero)
        .depth(g.depth, 0.0f)
        .record([this, &list, posed, &materials](const graph::PassContext& c) {
            const gpu::Api& vk = c.device.vk();
            const auto draw = [&](const gpu::Program& program, const std::vector<Draw>& draws) {
                recordDraws(c.cmd, vk, draws, posed.buffers, kPosition | kPrevious | kFrame | kCoords, true, [&](const ModelGpu& model, uint32_t material) {
                    const VkDescriptorSet set = materials.get(model, material, program);
                    vk.CmdBindDescriptorSets(c.cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, program.layout(), 1, 1, &set, 0, nullptr);
                });
            };
            draw(m_solid, list.opaque);
            if (list.masked.empty()) return;
            m_masked.refresh();
            vk.CmdBindPipeline(c.cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, m_masked.pipeline());
            draw(m_masked, list.masked);
        });
    return g;
}

}  // namespace obscura::render
