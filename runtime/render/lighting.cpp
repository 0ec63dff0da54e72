#include "render/lighting.h"

#include <cstring>

#include "post/view.h"
#include "scene/lighting.h"

namespace obscura::render {
namespace {

using graph::Sampling;

constexpr VkFormat kLit = VK_FORMAT_R16G16B16A16_SFLOAT;

shared::vec4 toShared(const glm::vec3& v, float w) { return {v.x, v.y, v.z, w}; }

shared::LightingBlock blockOf(const Lighting::Inputs& in, uint32_t shadowSize) {
    shared::LightingBlock block{};
    block.view = in.view;
    const glm::mat4 shadowFromEye = in.shadow.fromWorld * glm::inverse(in.eyeFromWorld);
    static_assert(sizeof(block.shadowFromEye) == sizeof(shadowFromEye));
    std::memcpy(&block.shadowFromEye, &shadowFromEye, sizeof(shadowFromEye));
    const glm::mat3 turn(in.eyeFromWorld);
    block.toSun = toShared(turn * -glm::normalize(in.sun.direction), in.shadow.texel);
    block.sun = toShared(in.sun.radiance, 0.0f);
    block.sky = toShared(in.sun.sky, 0.0f);
    block.ground = toShared(in.sun.ground, 0.0f);
    block.up = toShared(turn * glm::vec3(0, 1, 0), float(shadowSize));
    block.shadow = {in.shadow.depthRange, in.sun.diameter, 0.0f, 0.0f};
    return block;
}

}  // namespace

gpu::Status Lighting::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Lighting& out) {
    gpu::Status status = gpu::Program::compute(device, shaders, "scene/lighting.comp", {}, out.m_light[0]);
    if (status == gpu::Status::ok) status = gpu::Program::compute(device, shaders, "scene/lighting.comp:BENT", {}, out.m_light[1]);
    if (status == gpu::Status::ok) status = gpu::Program::compute(device, shaders, "post/tonemap.comp", {}, out.m_tonemap);
    if (status != gpu::Status::ok) return status;
    gpu::GraphicsState state;
    state.colorFormats = {kLit};
    state.depthFormat = VK_FORMAT_D32_SFLOAT;
    state.depthTest = true;
    state.blend = true;
    addVertexInput(state);
    return MaterialProgram::create(device, shaders, "scene/gbuffer.vert", "scene/blend.frag", state, out.m_blend);
}

graph::ImageId Lighting::add(graph::Graph& graph, const Inputs& in, Materials& materials) {
    const shared::View& view = in.view;
    const graph::BufferId light = graph.upload("lighting", blockOf(in, graph.desc(in.shadow.image).width));
    // As large as the depth buffer, which blended surfaces are tested against; lit in the visible part only.
    const graph::ImageId lit = graph.image("lit", {kLit, view.size.x, view.size.y});
    const GBuffer& g = in.gbuffer;
    graph::Pass& lighting = graph.pass("lighting", m_light[in.bentNormals ? 1 : 0]);
    lighting.read(light)
        .read(in.linearDepth)
        .read(g.geometric)
        .read(g.shaded)
        .read(g.baseColor)
        .read(g.material)
        .read(g.emission)
        .read(in.visibility)
        .read(in.shadow.image)
        .read(in.shadow.image, Sampling::shadow)
        .write(lit);
    if (in.bentNormals) lighting.read(in.bentNormals);
    lighting.dispatch(view.visible.x, view.visible.y);

    if (!in.draws->blended.empty()) {
        graph::Pass& pass = graph.pass("blend", m_blend.base())
                                .read(in.frame)
                                .read(in.items)
                                .read(light)
                                .read(in.shadow.image)
                                .read(in.shadow.image, Sampling::shadow)
                                .read(in.linearDepth)
                                .read(in.visibility);
        if (in.posed.now)
            pass.use(in.posed.now, graph::Access::vertex)
                .use(in.posed.before, graph::Access::vertex)
                .use(in.posed.frames, graph::Access::vertex);
        const VkRect2D visible{{int32_t(view.guard.x), int32_t(view.guard.y)}, {view.visible.x, view.visible.y}};
        pass.color(lit).depthTest(g.depth).record(
            [this, visible, &materials, draws = in.draws, posed = in.posed](const graph::PassContext& c) {
                const gpu::Api& vk = c.device.vk();
                vk.CmdSetScissor(c.cmd, 0, 1, &visible);
                VkPipeline bound = c.program->pipeline();
                recordDraws(c.cmd, vk, draws->blended, posed.buffers, kPosition | kPrevious | kFrame | kCoords, true,
                    [&](const ModelGpu& model, uint32_t material) { m_blend.bind(c.cmd, model, material, materials, bound); });
            });
    }

    return lit;
}

graph::ImageId Lighting::toneMap(graph::Graph& graph, graph::ImageId lit, const shared::View& view, float exposure) {
    const graph::ImageId picture = graph.image("picture", {VK_FORMAT_R8G8B8A8_UNORM, view.visible.x, view.visible.y});
    shared::ViewBlock block{};
    block.visible = view.visible;
    if (graph.desc(lit).width != view.visible.x) block.offset = {float(view.guard.x), float(view.guard.y)};
    block.exposure = exposure;
    graph.pass("tone map", m_tonemap).read(lit).write(picture).constants(block).dispatch(view.visible.x, view.visible.y);
    return picture;
}

}  // namespace obscura::render
