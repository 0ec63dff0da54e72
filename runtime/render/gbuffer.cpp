#include "render/gbuffer.h"

namespace obscura::render {
namespace {

constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT, kNormals = VK_FORMAT_R32_UINT, kMotion = VK_FORMAT_R16G16_SFLOAT,
                   kBaseColor = VK_FORMAT_R8G8B8A8_SRGB, kMaterial = VK_FORMAT_R8G8B8A8_UNORM,
                   kEmission = VK_FORMAT_B10G11R11_UFLOAT_PACK32;

}  // namespace

void addVertexInput(gpu::GraphicsState& state) {
    constexpr VkVertexInputRate kRate = VK_VERTEX_INPUT_RATE_VERTEX;
    state.vertexBindings = {{0, kPositionBytes, kRate}, {1, kPositionBytes, kRate}, {2, kFrameBytes, kRate}, {3, kCoordsBytes, kRate}};
    state.vertexAttributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}, {1, 1, VK_FORMAT_R32G32B32_SFLOAT, 0},
        {2, 2, VK_FORMAT_R16G16B16A16_SNORM, 0}, {3, 2, VK_FORMAT_R16G16B16A16_SNORM, 8}, {4, 3, VK_FORMAT_R32G32B32A32_SFLOAT, 0},
        {5, 3, VK_FORMAT_R16G16B16A16_SFLOAT, 16}};
}

gpu::Status GBufferPass::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, GBufferPass& out) {
    gpu::GraphicsState depth;
    depth.depthFormat = kDepth;
    depth.depthTest = depth.depthWrite = true;
    depth.vertexBindings = {{0, kPositionBytes, VK_VERTEX_INPUT_RATE_VERTEX}};
    depth.vertexAttributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}};
    gpu::Status status = gpu::Program::graphics(device, shaders, "scene/depth.vert", "", depth, {}, out.m_depth);
    gpu::GraphicsState state;
    state.colorFormats = {kNormals, kNormals, kMotion, kBaseColor, kMaterial, kEmission};
    state.depthFormat = kDepth;
    state.depthTest = state.depthWrite = true;
    addVertexInput(state);
    if (status == gpu::Status::ok)
        status = MaterialProgram::create(device, shaders, "scene/gbuffer.vert", "scene/gbuffer.frag", state, out.m_surface);
    return status;
}

GBuffer GBufferPass::add(graph::Graph& graph, VkExtent2D size, graph::BufferId frame, graph::BufferId items, const DrawList& list,
    const Deform::Posed& posed, Materials& materials) {
    const auto image = [&](const char* name, VkFormat format) { return graph.image(name, {format, size.width, size.height}); };
    const GBuffer g{image("depth", kDepth), image("normals", kNormals), image("shaded normals", kNormals), image("motion", kMotion),
        image("base colour", kBaseColor), image("material", kMaterial), image("emission", kEmission)};
    const VkClearColorValue zero{};
    std::optional<float> far = 0.0f;
    if (!list.textured.empty()) {
        graph::Pass& prepass = graph.pass("depth", m_depth).read(frame).read(items);
        if (posed.now) prepass.use(posed.now, graph::Access::vertex);
        prepass.depth(g.depth, far).record([&list, posed](const graph::PassContext& c) {
            recordDraws(c.cmd, c.device.vk(), list.textured, posed.buffers, kPosition, true, nullptr);
        });
        far.reset();
    }
    graph::Pass& pass = graph.pass("gbuffer", m_surface.base()).read(frame).read(items);
    if (posed.now)
        pass.use(posed.now, graph::Access::vertex).use(posed.before, graph::Access::vertex).use(posed.frames, graph::Access::vertex);
    pass.color(g.geometric, zero)
        .color(g.shaded, zero)
        .color(g.motion, zero)
        .color(g.baseColor, zero)
        .color(g.material, zero)
        .color(g.emission, zero)
        .depth(g.depth, far)
        .record([this, &list, posed, &materials](const graph::PassContext& c) {
            VkPipeline bound = c.program->pipeline();
            for (const std::vector<Draw>* draws : {&list.opaque, &list.masked})
                recordDraws(c.cmd, c.device.vk(), *draws, posed.buffers, kPosition | kPrevious | kFrame | kCoords, true,
                    [&](const ModelGpu& model, uint32_t material) { m_surface.bind(c.cmd, model, material, materials, bound); });
        });
    return g;
}

}  // namespace obscura::render
