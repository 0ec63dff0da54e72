// Running a planned frame. One function, run(), executes every pass: barriers, label, timestamp, bindings, work - so no
// pass can lack one of them.
#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>

#include "gpu/result.h"
#include "graph/physical.h"

namespace obscura::graph {
namespace {

constexpr uint32_t kSetsPerPool = 64;

VkSampler samplerOf(gpu::Device& device, Sampling sampling) {
    switch (sampling) {
        case Sampling::nearest: return device.sampler(gpu::Filter::nearest, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
        case Sampling::linear: return device.sampler(gpu::Filter::linear, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
        case Sampling::nearestRepeat: return device.sampler(gpu::Filter::nearest, VK_SAMPLER_ADDRESS_MODE_REPEAT);
        case Sampling::linearRepeat: return device.sampler(gpu::Filter::linear, VK_SAMPLER_ADDRESS_MODE_REPEAT);
        case Sampling::shadow: break;
    }
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = VK_FILTER_LINEAR;
    info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    info.borderColor = VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;
    info.compareEnable = VK_TRUE;
    info.compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
    info.maxLod = VK_LOD_CLAMP_NONE;
    return device.sampler(info);
}

VkDescriptorType typeOf(gpu::BindingKind kind) {
    switch (kind) {
        case gpu::BindingKind::sampledImage: return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        case gpu::BindingKind::storageImage: return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        case gpu::BindingKind::uniformBuffer: return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        case gpu::BindingKind::storageBuffer: break;
    }
    return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

VkDescriptorPool makePool(gpu::Device& device) {
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kSetsPerPool * 6},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, kSetsPerPool * 6},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kSetsPerPool * 3},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kSetsPerPool * 8}};
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.maxSets = kSetsPerPool;
    info.poolSizeCount = uint32_t(std::size(sizes));
    info.pPoolSizes = sizes;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    const VkResult result = device.vk().CreateDescriptorPool(device.handle(), &info, device.allocator(), &pool);
    return result == VK_SUCCESS ? pool : VK_NULL_HANDLE;
}

}  // namespace

void PassContext::push(const void* data, uint32_t bytes, uint32_t offset) const {
    assert(program && program->pushConstantBytes() >= offset + bytes);
    device.vk().CmdPushConstants(cmd, program->layout(), program->stages(), offset, bytes, data);
}
VkImageView PassContext::view(ImageId id, uint32_t mip) const {
    const Graph::Physical& physical = graph.m_physical[id.index];
    return mip == ~0u ? physical.view : physical.mip(mip);
}
ExternalBuffer PassContext::buffer(BufferId id) const {
    const Graph::Physical& physical = graph.m_physical[id.index];
    return {physical.buffer, physical.offset, physical.bytes};
}
VkImage PassContext::image(ImageId id) const { return graph.m_physical[id.index].image; }

void Graph::barriers(VkCommandBuffer cmd, const std::vector<Barrier>& list) {
    if (list.empty()) return;
    std::vector<VkImageMemoryBarrier2> images;
    std::vector<VkBufferMemoryBarrier2> buffers;
    for (const Barrier& b : list) {
        const Resource& resource = m_recording.resources[b.resource];
        const Physical& physical = m_physical[b.resource];
        if (resource.kind == Kind::buffer) {
            buffers.push_back({VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2, nullptr, b.srcStages, b.srcAccess, b.dstStages, b.dstAccess,
                               VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, physical.buffer, physical.offset, physical.bytes});
        } else {
            images.push_back({VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2, nullptr, b.srcStages, b.srcAccess, b.dstStages, b.dstAccess, b.from, b.to,
                              VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, physical.image,
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

// A pass's descriptor set, from this frame's pools.
gpu::Status Graph::fillSet(Pass& pass) {
    const gpu::Api& vk = m_device.vk();
    gpu::Program& program = *pass.m_program;
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkDescriptorSetLayout layout = program.setLayout(0);
    const auto none = [&] { return gpu::fail(m_device, gpu::Status::outOfMemory, fmt::format("graph: no descriptor set for {}", program.name())); };
    while (set == VK_NULL_HANDLE) {
        const bool fresh = m_frame->pool == m_frame->pools.size();
        if (fresh) {
            const VkDescriptorPool pool = makePool(m_device);
            if (pool == VK_NULL_HANDLE) return none();
            m_frame->pools.push_back(pool);
        }
        VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, m_frame->pools[m_frame->pool], 1, &layout};
        if (vk.AllocateDescriptorSets(m_device.handle(), &info, &set) == VK_SUCCESS) break;
        set = VK_NULL_HANDLE;
        if (fresh) return none();
        ++m_frame->pool;
    }

    std::vector<VkDescriptorImageInfo> images(pass.m_bound.size());
    std::vector<VkDescriptorBufferInfo> buffers(pass.m_bound.size());
    std::vector<VkWriteDescriptorSet> writes;
    size_t next = 0;
    for (const gpu::Binding& binding : program.bindings()) {
        if (binding.set != 0) continue;
        const Pass::Bound& bound = pass.m_bound[next];
        const Physical& physical = m_physical[bound.resource];
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, set, binding.binding, 0, 1, typeOf(binding.kind)};
        if (bound.isBuffer) {
            buffers[next] = {physical.buffer, physical.offset, physical.bytes};
            write.pBufferInfo = &buffers[next];
        } else {
            const bool sampled = binding.kind == gpu::BindingKind::sampledImage;
            const bool whole = bound.mip == ~0u && sampled;
            const VkSampler sampler = sampled ? samplerOf(m_device, bound.sampling) : VK_NULL_HANDLE;
            if (sampled && !sampler) return gpu::Status::outOfMemory;  // the device has said so
            images[next] = {sampler,
                            whole ? physical.view : physical.mip(bound.mip == ~0u ? 0 : bound.mip), info(accessOf(binding)).layout};
            write.pImageInfo = &images[next];
        }
        writes.push_back(write);
        ++next;
    }
    vk.UpdateDescriptorSets(m_device.handle(), uint32_t(writes.size()), writes.data(), 0, nullptr);
    pass.m_set = set;
    return gpu::Status::ok;
}

void Graph::bind(VkCommandBuffer cmd, const Pass& pass) {
    const gpu::Api& vk = m_device.vk();
    const gpu::Program& program = *pass.m_program;
    vk.CmdBindPipeline(cmd, program.bindPoint(), program.pipeline());
    if (!pass.m_constants.empty() && program.pushConstantBytes() > 0)
        vk.CmdPushConstants(cmd, program.layout(), program.stages(), 0, std::min(program.pushConstantBytes(), uint32_t(pass.m_constants.size())),
                            pass.m_constants.data());
    if (pass.m_set) vk.CmdBindDescriptorSets(cmd, program.bindPoint(), program.layout(), 0, 1, &pass.m_set, 0, nullptr);
}

void Graph::run(VkCommandBuffer cmd, Pass& pass) {
    const gpu::Api& vk = m_device.vk();
    VkExtent2D extent{0, 0};
    const bool attachments = !pass.m_colors.empty() || pass.m_depth;
    const auto attachment = [&](const Pass::Attachment& a, VkImageLayout layout) {
        const Resource& resource = m_recording.resources[a.resource];
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
            for (const Use& use : m_recording.passes[pass.m_index].uses) tested |= use.access == Access::depthTest;
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

// A software rasterizer bins a timestamp into work that is flushed later, so that a compute pass after a render pass would
// read near zero; a full barrier behind the timestamp makes it true. Real GPUs need none.
void Graph::timestamp(VkCommandBuffer cmd) {
    m_device.vk().CmdWriteTimestamp2(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, m_frame->queries, m_frame->queryCount++);
    if (!m_device.caps().software) return;
    VkMemoryBarrier2 all{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                         VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                         VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &all;
    m_device.vk().CmdPipelineBarrier2(cmd, &info);
}

void Graph::collectTimings(Frame& frame) {
    const uint32_t count = std::exchange(frame.queryCount, 0);
    if (count == 0) return;
    const gpu::Api& vk = m_device.vk();
    // A host may record a frame and never submit it. Its queries were not reset then, and reading them is an error.
    const VkResult executed = vk.GetEventStatus(m_device.handle(), frame.executed);
    m_lost |= executed == VK_ERROR_DEVICE_LOST;
    if (executed != VK_EVENT_SET) return;
    if (vk.ResetEvent(m_device.handle(), frame.executed) != VK_SUCCESS) {
        m_device.release(VK_OBJECT_TYPE_EVENT, frame.executed);
        frame.executed = VK_NULL_HANDLE;
    }
    if (count < 2) return;  // a frame without a pass
    std::vector<uint64_t> ticks(count);
    const VkResult result =
        vk.GetQueryPoolResults(m_device.handle(), frame.queries, 0, count, ticks.size() * 8, ticks.data(), 8, VK_QUERY_RESULT_64_BIT);
    m_lost |= result == VK_ERROR_DEVICE_LOST;
    if (result != VK_SUCCESS) return;
    const gpu::Caps& caps = m_device.caps();
    const auto milliseconds = [&](uint64_t from, uint64_t to) { return double((to - from) & caps.timestampMask) * caps.timestampPeriod * 1e-6; };
    m_timings.frame = frame.number;
    m_timings.passes.clear();
    for (uint32_t i = 0; i + 1 < count; ++i) m_timings.passes.push_back({frame.passNames[i], milliseconds(ticks[i], ticks[i + 1])});
    m_timings.milliseconds = milliseconds(ticks.front(), ticks.back());
}

// All that can fail, before anything is recorded.
gpu::Status Graph::prepare() {
    if (m_lost) return gpu::fail(m_device, gpu::Status::deviceLost, "graph: the device is lost");
    if (const gpu::Status status = realize(); status != gpu::Status::ok) return status;
    for (const Plan::Step& step : m_plan.steps) {
        Pass& pass = m_passes[step.pass];
        if (!pass.m_program || pass.m_bound.empty()) continue;
        if (const gpu::Status status = fillSet(pass); status != gpu::Status::ok) return status;
    }
    if (!m_timing || !m_device.caps().timestamps) return gpu::Status::ok;
    if (!m_frame->executed) {
        const VkEventCreateInfo info{VK_STRUCTURE_TYPE_EVENT_CREATE_INFO};
        VkEvent event = VK_NULL_HANDLE;
        if (const VkResult made = m_device.vk().CreateEvent(m_device.handle(), &info, m_device.allocator(), &event))
            return gpu::fail(m_device, gpu::fromVulkan(made), "graph: no event that tells whether a frame was executed");
        m_frame->executed = event;
    }
    const uint32_t wanted = uint32_t(m_plan.steps.size()) + 1;
    if (m_frame->queryCapacity >= wanted) return gpu::Status::ok;
    m_device.release(VK_OBJECT_TYPE_QUERY_POOL, m_frame->queries);
    m_frame->queries = VK_NULL_HANDLE;
    m_frame->queryCapacity = 0;
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = std::max(64u, wanted * 2);
    VkQueryPool queries = VK_NULL_HANDLE;
    if (const VkResult made = m_device.vk().CreateQueryPool(m_device.handle(), &info, m_device.allocator(), &queries))
        return gpu::fail(m_device, gpu::fromVulkan(made), "graph: no query pool for timestamps");
    m_frame->queries = queries;
    m_frame->queryCapacity = info.queryCount;
    return gpu::Status::ok;
}

gpu::Status Graph::execute(VkCommandBuffer cmd) {
    m_frame->passNames.clear();
    m_frame->queryCount = 0;
    // A frame that fails changes no image: the pool stays as it was left. In a destructor, for want of host memory shows as an exception.
    m_slotsBefore = m_plan.slots;
    struct Undo {
        Graph* graph;
        ~Undo() { if (graph) graph->m_plan.slots.swap(graph->m_slotsBefore); }
    } undo{this};
    if (const gpu::Status status = prepare(); status != gpu::Status::ok) return status;
    const gpu::Api& vk = m_device.vk();
    const bool timing = m_timing && m_device.caps().timestamps;
    if (timing) {
        vk.CmdResetQueryPool(cmd, m_frame->queries, 0, m_frame->queryCapacity);
        timestamp(cmd);
    }
    const bool labels = vk.CmdBeginDebugUtilsLabelEXT && vk.CmdEndDebugUtilsLabelEXT && m_device.caps().debugUtils;
    for (const Plan::Step& step : m_plan.steps) {
        Pass& pass = m_passes[step.pass];
        const std::string& name = m_recording.passes[step.pass].name;
        if (labels) {
            VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, name.c_str(), {}};
            vk.CmdBeginDebugUtilsLabelEXT(cmd, &label);
        }
        barriers(cmd, step.barriers);
        if (pass.m_program) bind(cmd, pass);
        run(cmd, pass);
        if (labels) vk.CmdEndDebugUtilsLabelEXT(cmd);
        if (timing) {
            timestamp(cmd);
            m_frame->passNames.push_back(name);
        }
    }
    barriers(cmd, m_plan.closing);
    if (timing) {
        const VkMemoryBarrier2 all{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0,
                                   VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0};
        VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        info.memoryBarrierCount = 1;
        info.pMemoryBarriers = &all;
        vk.CmdSetEvent2(cmd, m_frame->executed, &info);
    }
    undo.graph = nullptr;

    // Hand the states on to the next frame.
    for (uint32_t i = 0; i < m_physical.size(); ++i)
        if (m_physical[i].poolBuffer >= 0) m_buffers[size_t(m_physical[i].poolBuffer)].state = m_plan.finalStates[i][0];
    for (const PendingHistory& pending : m_histories) {
        History& history = *pending.history;
        history.m_states[1 - history.m_current] = m_plan.finalStates[pending.previous];
        history.m_states[history.m_current] = m_plan.finalStates[pending.current];
        history.m_current = 1 - history.m_current;
        history.m_valid = true;
    }
    return gpu::Status::ok;
}

}  // namespace obscura::graph
