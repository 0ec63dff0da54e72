// Makes what a frame's plan needs: pooled images and buffers, uploads, histories, descriptor sets, queries. Every failure happens here.
#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "gpu/result.h"
#include "graph/physical.h"

namespace obscura::graph {
namespace {

constexpr uint64_t kForgetAfter = 16;  // frames that something in the pool may lie unused

VkDescriptorType typeOf(gpu::BindingKind kind) {
    switch (kind) {
        case gpu::BindingKind::sampledImage: return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        case gpu::BindingKind::storageImage: return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        case gpu::BindingKind::uniformBuffer: return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        case gpu::BindingKind::storageBuffer: break;
    }
    return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

bool logProblems(const gpu::Device& device, const Plan& plan) {
    for (const std::string& problem : plan.problems) device.log(gpu::Severity::error, "graph: " + problem);
    return !plan.problems.empty();
}

}  // namespace

Executor::Executor(gpu::Device& device) : m_device(device) {
    for (uint32_t i = 0; i < device.framesInFlight(); ++i) m_frames.push_back(std::make_unique<Frame>(device));
}

Executor::~Executor() = default;

Executor::Frame& Executor::frame() const { return *m_frames[m_device.frame() % m_frames.size()]; }

uint64_t Executor::poolBytes() const {
    uint64_t total = 0;
    for (const Pooled& pooled : m_pool) total += pooled.image.bytes() + pooled.buffer.bytes();
    return total;
}

uint64_t Executor::frameBytes() const { return m_frameBytes; }

uint64_t Executor::bytes(Graph& graph) const {
    if (!graph.resolve()) return 0;
    const Plan needed = graph::plan(graph.recording());
    if (logProblems(m_device, needed)) return 0;
    const MemoryOf memory{[&](const gpu::ImageDesc& desc) { return gpu::Image::bytesOf(m_device, desc); },
        [&](uint64_t size, VkBufferUsageFlags usage, gpu::Memory where) { return gpu::Buffer::bytesOf(m_device, size, usage, where); }};
    return graph::bytes(graph.recording(), needed, m_device.framesInFlight(), memory);
}

gpu::Status Executor::prepare(Graph& graph, Plan& plan, std::vector<Pending>& histories) {
    Frame& current = frame();
    collectTimings(current);
    if (m_deviceLost) return gpu::fail(m_device, gpu::Status::deviceLost, "graph: the device is lost");
    current.sets.reset();
    if (!graph.resolve()) return gpu::Status::invalid;
    const std::vector<Resource>& resources = graph.m_recording.resources;
    for (uint32_t i = 0; i < resources.size(); ++i) {
        const Graph::Handles& handles = graph.m_handles[i];
        if (resources[i].origin == Origin::imported && !(resources[i].isBuffer ? bool(handles.buffer.buffer) : bool(handles.image)))
            return m_device.failure() == gpu::Status::ok ? gpu::Status::invalid : m_device.failure();  // logged where it was made
    }
    std::erase_if(m_pool, [&](const Pooled& pooled) { return pooled.lastUsed + kForgetAfter < m_device.frame(); });
    std::vector<Slot> slots;
    for (const Pooled& pooled : m_pool) slots.push_back(pooled.slot);
    std::vector<uint64_t> chunks;
    for (const gpu::Buffer& upload : current.uploads) chunks.push_back(upload.bytes());
    plan = graph::plan(graph.m_recording, std::move(slots), std::move(chunks));
    if (logProblems(m_device, plan)) return gpu::Status::invalid;

    if (const gpu::Status status = makePool(plan); status != gpu::Status::ok) return status;
    if (const gpu::Status status = makeUploads(graph, plan); status != gpu::Status::ok) return status;
    if (const gpu::Status status = makeHistories(graph, histories); status != gpu::Status::ok) return status;
    bindPhysical(graph, plan, histories);
    if (m_device.caps().debugUtils) namePool(graph, plan);
    if (const gpu::Status status = makeSets(graph, plan); status != gpu::Status::ok) return status;
    return m_timing && m_device.caps().timestamps ? current.timestamps.reserve(uint32_t(plan.steps.size()) + 1) : gpu::Status::ok;
}

gpu::Status Executor::makePool(const Plan& plan) {
    while (m_pool.size() < plan.slots.size()) {
        const Slot& slot = plan.slots[m_pool.size()];
        Pooled made;
        made.slot = {slot.desc, slot.bytes, std::vector<State>(slot.bytes ? 1 : slot.desc.mips)};
        made.lastUsed = m_device.frame();
        const gpu::Status status =
            slot.bytes ? gpu::Buffer::create(m_device, slot.bytes, kPoolBufferUsage, gpu::Memory::device, "graph buffer", made.buffer)
                       : gpu::Image::create(m_device, slot.desc, "graph image", made.image);
        if (status != gpu::Status::ok) return status;
        m_pool.push_back(std::move(made));
    }
    return gpu::Status::ok;
}

gpu::Status Executor::makeUploads(const Graph& graph, const Plan& plan) {
    std::vector<gpu::Buffer>& chunks = frame().uploads;
    while (chunks.size() < plan.chunks.size()) {
        gpu::Buffer made;
        const gpu::Status status =
            gpu::Buffer::create(m_device, plan.chunks[chunks.size()], kUploadUsage, gpu::Memory::upload, "graph upload", made);
        if (status != gpu::Status::ok) return status;
        chunks.push_back(std::move(made));
    }
    for (uint32_t i = 0; i < graph.m_recording.resources.size(); ++i) {
        const Resource& resource = graph.m_recording.resources[i];
        if (resource.origin != Origin::upload) continue;
        const Placement& placement = plan.placements[i];
        std::memcpy(chunks[placement.chunk].mapped() + placement.offset, graph.m_uploads.data() + resource.uploadOffset, resource.bytes);
    }
    return gpu::Status::ok;
}

gpu::Status Executor::makeHistories(const Graph& graph, std::vector<Pending>& histories) {
    histories.resize(graph.m_histories.size());
    for (size_t i = 0; i < histories.size(); ++i) {
        const Graph::HistoryUse& use = graph.m_histories[i];
        const Resource& resource = graph.m_recording.resources[use.current];
        for (uint32_t k = 0; k < 2; ++k) {
            if (use.history->m_images[k] && use.history->m_images[k].desc() == resource.desc) continue;
            const gpu::Status status = gpu::Image::create(m_device, resource.desc, resource.name.c_str(), histories[i].images[k]);
            if (status != gpu::Status::ok) return status;
        }
    }
    return gpu::Status::ok;
}

// What stands behind each id this frame.
void Executor::bindPhysical(const Graph& graph, const Plan& plan, const std::vector<Pending>& histories) {
    const std::vector<Resource>& resources = graph.m_recording.resources;
    m_physical.assign(resources.size(), {});
    const auto bindImage = [&](uint32_t resource, const gpu::Image& image) {
        m_physical[resource] = {image.handle(), image.view(), &image, {}};
    };
    for (uint32_t i = 0; i < resources.size(); ++i) {
        const Graph::Handles& handles = graph.m_handles[i];
        if (resources[i].origin == Origin::imported) m_physical[i] = {handles.image, handles.view, nullptr, handles.buffer};
        if (resources[i].origin == Origin::upload)
            m_physical[i].buffer = {frame().uploads[plan.placements[i].chunk].handle(), plan.placements[i].offset, resources[i].bytes};
        if (plan.slotOf[i] < 0) continue;
        const Pooled& pooled = m_pool[size_t(plan.slotOf[i])];
        if (resources[i].isBuffer) m_physical[i].buffer = {pooled.buffer.handle(), 0, resources[i].bytes};
        else bindImage(i, pooled.image);
    }
    for (size_t i = 0; i < histories.size(); ++i) {
        const Graph::HistoryUse& use = graph.m_histories[i];
        const uint32_t write = use.history->m_current;
        const auto imageOf = [&](uint32_t k) -> const gpu::Image& {
            return histories[i].images[k] ? histories[i].images[k] : use.history->m_images[k];
        };
        bindImage(use.previous, imageOf(1 - write));
        bindImage(use.current, imageOf(write));
    }
}

// In a capture, a pooled image or buffer bears the names of the transients that live in it this frame.
void Executor::namePool(const Graph& graph, const Plan& plan) {
    std::vector<std::string> names(m_pool.size());
    for (uint32_t i = 0; i < plan.slotOf.size(); ++i) {
        if (plan.slotOf[i] < 0) continue;
        std::string& name = names[size_t(plan.slotOf[i])];
        name += (name.empty() ? "" : " / ") + graph.m_recording.resources[i].name;
    }
    for (size_t s = 0; s < names.size(); ++s) {
        Pooled& pooled = m_pool[s];
        if (names[s].empty() || names[s] == pooled.name) continue;
        pooled.name = names[s];
        const bool isImage = bool(pooled.image);
        m_device.nameObject(isImage ? VK_OBJECT_TYPE_IMAGE : VK_OBJECT_TYPE_BUFFER,
            isImage ? uint64_t(pooled.image.handle()) : uint64_t(pooled.buffer.handle()), pooled.name.c_str());
    }
}

gpu::Status Executor::makeSets(const Graph& graph, const Plan& plan) {
    m_sets.assign(graph.m_passes.size(), VK_NULL_HANDLE);
    for (const Plan::Step& step : plan.steps) {
        const Pass& pass = graph.m_passes[step.pass];
        if (!pass.m_program || pass.m_bound.empty()) continue;
        if (const gpu::Status status = makeSet(pass, m_sets[step.pass]); status != gpu::Status::ok) return status;
    }
    return gpu::Status::ok;
}

gpu::Status Executor::makeSet(const Pass& pass, VkDescriptorSet& set) {
    const gpu::Program& program = *pass.m_program;
    set = frame().sets.allocate(program.setLayout(0));
    if (!set) return gpu::fail(m_device, gpu::Status::outOfMemory, fmt::format("graph: no descriptor set for {}", program.name()));
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
            buffers[next] = {physical.buffer.buffer, physical.buffer.offset, physical.buffer.bytes};
            write.pBufferInfo = &buffers[next];
        } else {
            const bool sampled = binding.kind == gpu::BindingKind::sampledImage;
            const bool whole = bound.mip == ~0u && sampled;
            const VkSampler sampler = sampled ? m_device.sampler(bound.sampling) : VK_NULL_HANDLE;
            if (sampled && !sampler) return gpu::Status::outOfMemory;  // the device has said so
            images[next] = {
                sampler, whole ? physical.view : physical.mip(bound.mip == ~0u ? 0 : bound.mip), info(accessOf(binding)).layout};
            write.pImageInfo = &images[next];
        }
        writes.push_back(write);
        ++next;
    }
    m_device.vk().UpdateDescriptorSets(m_device.handle(), uint32_t(writes.size()), writes.data(), 0, nullptr);
    return gpu::Status::ok;
}

gpu::Status Executor::execute(Graph& graph, VkCommandBuffer cmd) {
    Plan plan;
    std::vector<Pending> histories;
    if (const gpu::Status status = prepare(graph, plan, histories); status != gpu::Status::ok) return status;
    record(graph, plan, cmd);
    commit(graph, plan, histories);
    return gpu::Status::ok;
}

// Everything that outlives the frame moves on here and nowhere else.
void Executor::commit(Graph& graph, Plan& plan, std::vector<Pending>& histories) noexcept {
    m_lastFrame = m_device.frame();
    for (size_t s = 0; s < m_pool.size(); ++s) m_pool[s].slot.state.swap(plan.slots[s].state);
    for (const int slot : plan.slotOf)
        if (slot >= 0) m_pool[size_t(slot)].lastUsed = m_device.frame();
    m_frameBytes = 0;
    for (const Pooled& pooled : m_pool)
        if (pooled.lastUsed == m_device.frame()) m_frameBytes += pooled.image.bytes() + pooled.buffer.bytes();
    for (uint32_t i = 0; i < m_physical.size(); ++i) {
        const Resource& resource = graph.m_recording.resources[i];
        if (resource.origin == Origin::history) m_frameBytes += m_physical[i].owned->bytes();
        if (resource.origin == Origin::transient || !resource.isBuffer) continue;
        const auto same = [&](const Physical& other) {
            return other.buffer.buffer == m_physical[i].buffer.buffer && other.buffer.offset == m_physical[i].buffer.offset;
        };
        if (std::none_of(m_physical.begin(), m_physical.begin() + i, same)) m_frameBytes += resource.bytes;
    }
    for (size_t i = 0; i < histories.size(); ++i) {
        const Graph::HistoryUse& use = graph.m_histories[i];
        History& history = *use.history;
        for (uint32_t k = 0; k < 2; ++k)
            if (histories[i].images[k]) history.m_images[k] = std::move(histories[i].images[k]);
        history.m_states[1 - history.m_current].swap(plan.finalStates[use.previous]);
        history.m_states[history.m_current].swap(plan.finalStates[use.current]);
        history.m_current = 1 - history.m_current;
        history.m_valid = true;
    }
    for (const std::function<void()>& then : graph.m_onRecorded) then();
    m_plan = std::move(plan);
}

}  // namespace obscura::graph
