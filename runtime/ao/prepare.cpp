#include "ao/prepare.h"

#include "ao/common/constants.h"

namespace obscura::ao {
namespace {

shared::ConvertNormals normalConstants(const Frame& frame) {
    shared::ConvertNormals result{
        {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, shared::sizeOf(frame.size.width, frame.size.height), uint32_t(frame.normalEncoding), 0};
    const float* m = frame.eyeFromWorld;
    if (frame.normalKind == NormalKind::world)
        for (int row = 0; row < 3; ++row) result.rows[row] = {m[row], m[4 + row], m[8 + row], 0};
    return result;
}

}  // namespace

Status Prepare::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Prepare& out) {
    const struct {
        const char* name;
        gpu::Program* program;
    } programs[] = {{"ao/common/linearize.comp", &out.m_linearize}, {"ao/common/normals.comp", &out.m_packNormals},
        {"ao/common/normals_packed.comp", &out.m_repackNormals}, {"ao/common/normals_reconstruct.comp", &out.m_reconstruct}};
    for (const auto& [name, program] : programs)
        if (gpu::Program::compute(device, shaders, name, {}, *program) != gpu::Status::ok) return Status::shaderError;
    return Status::ok;
}

Inputs Prepare::add(graph::Graph& graph, const Frame& frame, const shared::View& view, const Sources& sources, const Falloff& falloff) {
    Inputs inputs;
    inputs.view = view;
    inputs.viewBlock = graph.upload("view", view);
    inputs.falloffDesc = falloff;
    inputs.falloff = falloffBlock(falloff);
    inputs.motion = sources.motion;
    inputs.motionScale[0] = frame.motionScale[0];
    inputs.motionScale[1] = frame.motionScale[1];
    if (sources.direct) {
        inputs.depth = sources.depth;
        inputs.normals = sources.normals;
        return inputs;
    }
    inputs.depth = graph.image("linear depth", {VK_FORMAT_R32_SFLOAT, view.size.x, view.size.y});
    graph.pass("prepare.depth", m_linearize)
        .read(inputs.viewBlock)
        .read(sources.depth)
        .write(inputs.depth)
        .constants(shared::Linearize{frame.depthKind == DepthKind::linear ? 1u : 0u})
        .dispatch(view.size.x, view.size.y);

    if (sources.packed) {
        inputs.normals = sources.normals;
        return inputs;
    }
    inputs.normals = graph.image("packed normals", {VK_FORMAT_R32_UINT, view.size.x, view.size.y});
    if (!sources.normals) {
        graph.pass("prepare.normals", m_reconstruct)
            .read(inputs.viewBlock)
            .read(inputs.depth)
            .write(inputs.normals)
            .dispatch(view.size.x, view.size.y);
    } else {
        gpu::Program& program = frame.normalEncoding == NormalEncoding::octahedral32 ? m_repackNormals : m_packNormals;
        graph.pass("prepare.normals", program)
            .read(sources.normals)
            .write(inputs.normals)
            .constants(normalConstants(frame))
            .dispatch(view.size.x, view.size.y);
    }
    return inputs;
}

}  // namespace obscura::ao
