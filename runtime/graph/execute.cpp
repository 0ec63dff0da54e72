// Recording a planned frame's commands: one loop gives every pass its label, barriers, bindings, work and timestamp.
#include <algorithm>
#include <cassert>

#include "graph/physical.h"

namespace obscura::graph {

void PassContext::push(const void* data, uint32_t bytes, uint32_t offset) const {
    assert(program && program->pushConstantBytes() >= offset + bytes);
    device.vk().CmdPushConstants(cmd, program->layout(), program->stages(), offset, bytes, data);
}
VkImageView PassContext::view(ImageId id, uint32_t mip) const {
    const Executor::Physical& physical = executor.m_physical[id.index];
    return mip == ~0u ? physical.view : physical.mip(mip);
}
ExternalBuffer PassContext::buffer(BufferId id) const { return executor.m_physical[id.index].buffer; }
VkImage PassContext::image(ImageId id) const { return executor.m_physical[id.index].image; }

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
                {gpu::aspectOf(resource.desc.format), b.firstMip, b.mips, 0, 1}});
        }
    }
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = uint32_t(images.size());
    info.pImageMemoryBarriers = images.data();
    info.bufferMemoryBarrierCount = uint32_t(buffers.size());
    info.pBufferMemoryBarriers = buffers.data();
    m_device.vk().CmdPipelineBarrier2(cmd, &info);
}

void Executor::bind(VkCommandBuffer cmd, const Pass& pass) {
    const gpu::Api& vk = m_device.vk();
    const gpu::Program& program = *pass.m_program;
    vk.CmdBindPipeline(cmd, program.bindPoint(), program.pipeline());
    if (!pass.m_constants.empty() && program.pushConstantBytes() > 0)
        vk.CmdPushConstants(cmd, program.layout(), program.stages(), 0,
            std::min(program.pushConstantBytes(), uint32_t(pass.m_constants.size())), pass.m_constants.data());
    if (const VkDescriptorSet set = m_sets[pass.m_index])
        vk.CmdBindDescriptorSets(cmd, program.bindPoint(), program.layout(), 0, 1, &set, 0, nullptr);
}

void Executor::run(const Recording& recording, VkCommandBuffer cmd, const Pass& pass) {
    const gpu::Api& vk = m_device.vk();
    VkExtent2D extent{0, 0};
    const bool attachments = !pass.m_colors.empty() || pass.m_depth;
    const auto attachment = [&](const Pass::Attachment& a, VkImageLayout layout) {
        const Resource& resource = recording.resources[a.resource];
        extent = {resource.desc.width, resource.desc.height};
        VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        info.imageView = m_physical[a.resource].mip(0);
        info.imageLayout = layout;
        info.loadOp = a.clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
        info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        info.clearValue = a.value;
        return info;
    };
    if (attachments) {
        std::vector<VkRenderingAttachmentInfo> colors;
        for (const Pass::Attachment& a : pass.m_colors) colors.push_back(attachment(a, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL));
        VkRenderingAttachmentInfo depth{};
        bool tested = false;
        if (pass.m_depth) {
            for (const Use& use : recording.passes[pass.m_index].uses) tested |= use.access == Access::depthTest;
            depth = attachment(*pass.m_depth, tested ? VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
            if (tested) depth.storeOp = VK_ATTACHMENT_STORE_OP_NONE;
        }
        VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
        info.renderArea.extent = extent;
        info.layerCount = 1;
        info.colorAttachmentCount = uint32_t(colors.size());
        info.pColorAttachments = colors.data();
        info.pDepthAttachment = pass.m_depth ? &depth : nullptr;
        vk.CmdBeginRendering(cmd, &info);
        const VkViewport viewport{0, 0, float(extent.width), float(extent.height), 0, 1};
        const VkRect2D scissor{{0, 0}, extent};
        vk.CmdSetViewport(cmd, 0, 1, &viewport);
        vk.CmdSetScissor(cmd, 0, 1, &scissor);
        vk.CmdSetCullMode(cmd, VK_CULL_MODE_NONE);
        vk.CmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    }
    if (pass.m_work == Pass::Work::dispatch) {
        const auto& group = pass.m_program->workgroup();
        vk.CmdDispatch(cmd, (pass.m_size[0] + group[0] - 1) / group[0], (pass.m_size[1] + group[1] - 1) / group[1],
            (pass.m_size[2] + group[2] - 1) / group[2]);
    } else if (pass.m_work == Pass::Work::draw) {
        vk.CmdDraw(cmd, pass.m_size[0], pass.m_size[1], 0, 0);
    } else {
        pass.m_record({cmd, m_device, pass.m_program, *this, extent});
    }
    if (attachments) vk.CmdEndRendering(cmd);
}

const Timings& Executor::timings() {
    if (frame().number != m_device.frame()) collectTimings(frame());
    return m_timings;
}

void Executor::collectTimings(Frame& frame) {
    std::vector<double> times;
    m_deviceLost |= frame.timestamps.read(times) == gpu::Status::deviceLost;
    if (times.empty()) return;
    m_timings.frame = frame.number;
    m_timings.passes.clear();
    m_timings.milliseconds = 0.0;
    for (size_t i = 0; i < times.size(); ++i) {
        m_timings.passes.push_back({frame.passNames[i], times[i]});
        m_timings.milliseconds += times[i];
    }
}

void Executor::record(const Graph& graph, const Plan& plan, VkCommandBuffer cmd) {
    const gpu::Api& vk = m_device.vk();
    Frame& current = frame();
    current.number = m_device.frame();
    current.passNames.clear();
    const bool timing = m_timing && m_device.caps().timestamps;
    if (timing) current.timestamps.begin(cmd);
    const bool labels = vk.CmdBeginDebugUtilsLabelEXT && vk.CmdEndDebugUtilsLabelEXT && m_device.caps().debugUtils;
    for (const Plan::Step& step : plan.steps) {
        const Pass& pass = graph.m_passes[step.pass];
        const std::string& name = graph.m_recording.passes[step.pass].name;
        if (labels) {
            const VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, name.c_str(), {}};
            vk.CmdBeginDebugUtilsLabelEXT(cmd, &label);
        }
        barriers(graph.m_recording, cmd, step.barriers);
        if (pass.m_program) bind(cmd, pass);
        run(graph.m_recording, cmd, pass);
        if (labels) vk.CmdEndDebugUtilsLabelEXT(cmd);
        if (timing) {
            current.timestamps.write(cmd);
            current.passNames.push_back(name);
        }
    }
    barriers(graph.m_recording, cmd, plan.closing);
    if (timing) current.timestamps.end(cmd);
}

}  // namespace obscura::graph
