// Recording a planned frame's commands: one loop gives every pass its label, barriers, bindings, work and timestamp.
#include <algorithm>

#include "graph/executor.h"

namespace obscura::graph {

void Executor::barriers(const Recording& recording, VkCommandBuffer cmd, const std::vector<Barrier>& list) {
    if (list.empty()) return;
    std::vector<VkImageMemoryBarrier2> images;
    std::vector<VkBufferMemoryBarrier2> buffers;
    for (const Barrier& b : list) {
        const Resource& resource = recording.resources[b.resource];
        const Physical& physical = m_physical[b.resource];
        if (resource.isBuffer) {
            buffers.push_back({VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2, nullptr, b.srcStages, b.srcAccess, b.dstStages, b.dstAccess,
                VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, physical.buffer.buffer, physical.buffer.offset, physical.buffer.bytes});
        } else {
            images.push_back({VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2, nullptr, b.srcStages, b.srcAccess, b.dstStages, b.dstAccess, b.from,
                b.to, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, physical.image,
                {gpu::aspectOf(resource.desc.format), physical.firstMip + b.firstMip, b.mips, physical.layer, 1}});
        }
    }
    const VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO, nullptr, 0, 0, nullptr, uint32_t(buffers.size()), buffers.data(),
        uint32_t(images.size()), images.data()};
    m_device.vk().CmdPipelineBarrier2(cmd, &info);
}

void Executor::run(const Recording& recording, VkCommandBuffer cmd, const Pass& pass, VkDescriptorSet set) {
    PassContext context{cmd, m_device, pass.m_program, m_physical, {}};
    if (const gpu::Program* program = pass.m_program) {
        program->bind(cmd, set);
        if (const uint32_t bytes = std::min(program->pushConstantBytes(), uint32_t(pass.m_constants.size())))
            program->push(cmd, pass.m_constants.data(), bytes, 0);
    }
    std::vector<VkRenderingAttachmentInfo> colors;
    std::optional<VkRenderingAttachmentInfo> depth;
    for (const Pass::Attachment& attachment : pass.m_attachments) {
        const gpu::ImageDesc& desc = recording.resources[attachment.resource].desc;
        context.extent = {desc.width, desc.height};
        const AccessInfo& access = info(attachment.access);
        VkRenderingAttachmentInfo target{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        target.imageView = m_physical[attachment.resource].mip(0);
        target.imageLayout = access.layout;
        target.loadOp = attachment.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
        target.storeOp = access.writes ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_NONE;
        target.clearValue = attachment.clear.value_or(VkClearValue{});
        if (attachment.access == Access::color) colors.push_back(target);
        else depth = target;
    }
    const bool renders = !pass.m_attachments.empty();
    if (renders) gpu::beginRendering(m_device, cmd, context.extent, colors, depth ? &*depth : nullptr);
    pass.m_work(context);
    if (renders) m_device.vk().CmdEndRendering(cmd);
}

const Timings& Executor::timings() {
    std::vector<gpu::PassTime> passes;
    if (frame().number != m_device.frame()) m_deviceLost |= frame().timestamps.read(passes) == gpu::Status::deviceLost;
    if (passes.empty()) return m_timings;
    m_timings = {frame().number, std::move(passes), 0.0};
    for (const gpu::PassTime& pass : m_timings.passes) m_timings.milliseconds += pass.milliseconds;
    return m_timings;
}

void Executor::record(const Graph& graph, const Plan& plan, VkCommandBuffer cmd) {
    Frame& current = frame();
    current.number = m_device.frame();
    if (timed()) current.timestamps.begin(cmd);
    for (const Plan::Step& step : plan.steps) {
        const std::string& name = graph.m_recording.passes[step.pass].name;
        m_device.beginLabel(cmd, name.c_str());
        barriers(graph.m_recording, cmd, step.barriers);
        run(graph.m_recording, cmd, graph.m_passes[step.pass], m_sets[step.pass]);
        m_device.endLabel(cmd);
        if (timed()) current.timestamps.write(cmd, name);
    }
    barriers(graph.m_recording, cmd, plan.closing);
    if (timed()) current.timestamps.end(cmd);
}

}  // namespace obscura::graph
