#include "render/deform.h"

namespace obscura::render {
namespace {

using gpu::Status;
using graph::Access;

constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                      VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

}  // namespace

Status Deform::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Deform& out) {
    out.m_device = &device;
    return gpu::Program::compute(device, shaders, "scene/deform.comp", {}, out.m_program);
}

// Allocates larger buffers and copies the old contents, so that other instances keep last frame's positions when one is added. Tangent
// frames are copied too: those of unchanged poses are not written again.
Status Deform::grow(graph::Graph& graph, uint32_t vertices) {
    gpu::Buffer old[3] = {std::move(m_positions[0]), std::move(m_positions[1]), std::move(m_frames)};
    gpu::Buffer* fresh[3] = {&m_positions[0], &m_positions[1], &m_frames};
    const uint32_t bytes[3] = {kPositionBytes, kPositionBytes, kFrameBytes};
    static constexpr const char* kNames[3] = {"posed 0", "posed 1", "posed frames"};
    for (int i = 0; i < 3; ++i) {
        const Status status =
            gpu::Buffer::create(*m_device, uint64_t(vertices) * bytes[i], kUsage, gpu::Memory::device, kNames[i], *fresh[i]);
        if (status != Status::ok) return status;
        m_ids[i] = graph.import(kNames[i], *fresh[i], graph::Graph::Shared::written);
        if (!old[i]) continue;
        const graph::BufferId from = graph.import("outgrown", old[i], graph::Graph::Shared::written);
        const VkBuffer source = old[i].handle(), target = fresh[i]->handle();
        const VkBufferCopy copy{0, 0, old[i].bytes()};
        graph.pass("deform.grow")
            .use(from, Access::transferRead)
            .use(m_ids[i], Access::transferWrite)
            .record([=](const graph::PassContext& c) { c.device.vk().CmdCopyBuffer(c.cmd, source, target, 1, &copy); });
    }
    m_capacity = vertices;
    return Status::ok;  // `old` is destroyed here; the device defers this until the GPU has finished the frame
}

Deform::Posed Deform::add(graph::Graph& graph, const Actors& actors) {
    Posed posed;
    if (actors.posedCapacity() == 0) return posed;
    if (actors.posedCapacity() > m_capacity) {
        if (grow(graph, actors.posedCapacity()) != Status::ok) return posed;
    } else {
        m_ids[0] = graph.import("posed 0", m_positions[0], graph::Graph::Shared::written);
        m_ids[1] = graph.import("posed 1", m_positions[1], graph::Graph::Shared::written);
        m_ids[2] = graph.import("posed frames", m_frames, graph::Graph::Shared::written);
    }
    m_current = 1 - m_current;
    posed.now = m_ids[m_current];
    posed.before = m_ids[1 - m_current];
    posed.frames = m_ids[2];
    posed.buffers = {m_positions[m_current].handle(), m_positions[1 - m_current].handle(), m_frames.handle()};
    if (actors.jobs().empty()) return posed;

    const glm::vec4 noJoint(0.0f);
    const shared::ActiveWeight noWeight{};
    const auto joints = actors.joints().empty() ? std::span(&noJoint, 1) : actors.joints();
    const auto weights = actors.weights().empty() ? std::span(&noWeight, 1) : actors.weights();
    graph.pass("deform", m_program)
        .read(graph.upload("joints", joints.data(), joints.size_bytes()))
        .read(graph.upload("morph weights", weights.data(), weights.size_bytes()))
        .write(posed.now)
        .write(posed.frames)
        .record([this, &actors](const graph::PassContext& c) {
            const ModelGpu* bound = nullptr;
            for (const Actors::Job& job : actors.jobs()) {
                if (job.model != bound) {
                    const VkDescriptorSet set = m_rest.of(
                        *m_device, m_program.setLayout(1), *job.model, {&job.model->rest, &job.model->influences, &job.model->targets});
                    if (set == VK_NULL_HANDLE) continue;
                    c.device.vk().CmdBindDescriptorSets(c.cmd, VK_PIPELINE_BIND_POINT_COMPUTE, c.program->layout(), 1, 1, &set, 0, nullptr);
                    bound = job.model;
                }
                c.push(&job.job, sizeof(job.job));
                c.device.vk().CmdDispatch(c.cmd, (job.job.vertices + c.program->workgroup()[0] - 1) / c.program->workgroup()[0], 1, 1);
            }
        });
    return posed;
}

}  // namespace obscura::render
