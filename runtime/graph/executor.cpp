// Makes what a frame's plan needs: pooled images and buffers, uploads, histories, descriptor sets, queries. Every failure happens here.
#include "graph/executor.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "gpu/result.h"

namespace obscura::graph {
namespace {

using gpu::Status;

constexpr uint64_t kForgetAfter = 16;  // frames that something in the pool may lie unused

// False, logged, when the recording contradicts itself.
bool isSound(const gpu::Device& device, const Plan& plan) {
    for (const std::string& problem : plan.problems) device.log(gpu::Severity::error, "graph: " + problem);
    return plan.problems.empty();
}

}  // namespace

Executor::Executor(gpu::Device& device) : m_device(device) {
    for (uint32_t i = 0; i < device.framesInFlight(); ++i) m_frames.emplace_back(device);
}

uint64_t Executor::poolBytes() const {
    uint64_t total = 0;
    for (const Pooled& pooled : m_pool) total += pooled.bytes();
    return total;
}

uint64_t Executor::bytes(Graph& graph) const {
    if (!graph.resolve()) return 0;
    const Plan needed = graph::plan(graph.recording());
    if (!isSound(m_device, needed)) return 0;
    const MemoryOf memory{[&](const gpu::ImageDesc& desc) { return gpu::Image::bytesOf(m_device, desc); },
        [&](uint64_t size, VkBufferUsageFlags usage, gpu::Memory where) { return gpu::Buffer::bytesOf(m_device, size, usage, where); }};
    return graph::bytes(graph.recording(), needed, m_device.framesInFlight(), memory);
}

void Executor::trim() {
    std::erase_if(m_pool, [&](const Pooled& pooled) { return pooled.lastUsed != m_lastFrame; });
}

Status Executor::prepare(Graph& graph, Plan& plan, Pending& histories) {
    Frame& current = frame();
    timings();
    if (m_deviceLost) return gpu::fail(m_device, Status::deviceLost, "graph: the device is lost");
    current.sets.reset();
    if (!graph.resolve()) return Status::invalid;
    m_physical = graph.m_physical;
    for (uint32_t i = 0; i < m_physical.size(); ++i)
        if (graph.m_recording.resources[i].origin == Origin::imported && !m_physical[i].image && !m_physical[i].buffer.buffer)
            return m_device.failure() == Status::ok ? Status::invalid : m_device.failure();  // logged where it was made
    std::erase_if(m_pool, [&](const Pooled& pooled) { return pooled.lastUsed + kForgetAfter < m_device.frame(); });
    std::vector<Slot> slots;
    for (const Pooled& pooled : m_pool) slots.push_back(pooled.slot);
    std::vector<uint64_t> chunks;
    for (const gpu::Buffer& upload : current.uploads) chunks.push_back(upload.bytes());
    plan = graph::plan(graph.m_recording, std::move(slots), std::move(chunks));
    if (!isSound(m_device, plan)) return Status::invalid;

    Status status = makePool(graph.m_recording, plan);
    if (status == Status::ok) status = makeUploads(graph, plan);
    if (status == Status::ok) status = makeHistories(graph, histories);
    if (status == Status::ok && !current.sets.reserve(uint32_t(graph.passCount())))
        status = gpu::fail(m_device, Status::outOfMemory, "graph: no pool of descriptor sets");
    if (status == Status::ok) status = makeSets(graph, plan);
    if (status == Status::ok && timed()) status = current.timestamps.reserve(uint32_t(graph.passCount()) + 1);
    return status;
}

Status Executor::makePool(const Recording& recording, const Plan& plan) {
    for (size_t s = m_pool.size(); s < plan.slots.size(); ++s) {
        const Slot& slot = plan.slots[s];
        Pooled made{{slot.desc, slot.bytes, std::vector<State>(slot.state.size())}};
        made.lastUsed = m_device.frame();
        const Status status =
            slot.bytes ? gpu::Buffer::create(m_device, slot.bytes, kPoolBufferUsage, gpu::Memory::device, "graph buffer", made.buffer)
                       : gpu::Image::create(m_device, slot.desc, "graph image", made.image);
        if (status != Status::ok) return status;
        m_pool.push_back(std::move(made));
    }
    for (size_t i = 0; i < m_physical.size(); ++i) {
        if (plan.slotOf[i] < 0) continue;
        const Pooled& p = m_pool[size_t(plan.slotOf[i])];
        m_physical[i] = {p.image.handle(), p.image.view(), p.image ? &p.image : nullptr, {p.buffer.handle(), 0, p.buffer.bytes()}};
    }
    // In a capture, a pooled image or buffer bears the names of the transients that live in it this frame.
    for (size_t s = 0; s < m_pool.size() && m_device.caps().debugUtils; ++s) {
        Pooled& pooled = m_pool[s];
        const std::string name = plan.names(recording, s, " / ");
        if (name.empty() || name == pooled.name) continue;
        pooled.name = name;
        if (pooled.image) m_device.nameObject(VK_OBJECT_TYPE_IMAGE, uint64_t(pooled.image.handle()), name.c_str());
        else m_device.nameObject(VK_OBJECT_TYPE_BUFFER, uint64_t(pooled.buffer.handle()), name.c_str());
    }
    return Status::ok;
}

Status Executor::makeUploads(const Graph& graph, const Plan& plan) {
    std::vector<gpu::Buffer>& chunks = frame().uploads;
    while (chunks.size() < plan.chunks.size()) {
        gpu::Buffer made;
        const Status status =
            gpu::Buffer::create(m_device, plan.chunks[chunks.size()], kUploadUsage, gpu::Memory::upload, "graph upload", made);
        if (status != Status::ok) return status;
        chunks.push_back(std::move(made));
    }
    for (size_t i = 0; i < m_physical.size(); ++i) {
        const Resource& resource = graph.m_recording.resources[i];
        if (resource.origin != Origin::upload) continue;
        const auto& [chunk, offset] = plan.placements[i];
        std::memcpy(chunks[chunk].mapped() + offset, resource.data.data(), resource.bytes);
        m_physical[i].buffer = {chunks[chunk].handle(), offset, resource.bytes};
    }
    return Status::ok;
}

Status Executor::makeHistories(const Graph& graph, Pending& histories) {
    histories.resize(graph.m_histories.size());
    for (size_t i = 0; i < histories.size(); ++i) {
        const auto& [history, resources] = graph.m_histories[i];
        for (uint32_t k = 0; k < 2; ++k) {
            const Resource& resource = graph.m_recording.resources[resources[k]];
            const gpu::Image* image = &history->m_copies[k].image;
            if (image->desc() != resource.made()) {
                image = &histories[i][k];
                const Status status = gpu::Image::create(m_device, resource.made(), resource.name.c_str(), histories[i][k]);
                if (status != Status::ok) return status;
            }
            m_physical[resources[k]] = {image->handle(), image->view(), image};
        }
    }
    return Status::ok;
}

Status Executor::makeSets(const Graph& graph, const Plan& plan) {
    m_sets.assign(graph.m_passes.size(), VK_NULL_HANDLE);
    for (const Plan::Step& step : plan.steps) {
        const Pass& pass = graph.m_passes[step.pass];
        if (!pass.m_program || pass.m_bound.empty()) continue;
        std::vector<gpu::Descriptor> contents;
        for (const gpu::Binding& binding : pass.m_program->bindings(0)) {
            const Pass::Bound& bound = pass.m_bound[contents.size()];
            const Physical& physical = m_physical[bound.resource];
            const auto& [buffer, offset, bytes] = physical.buffer;
            VkDescriptorImageInfo image{VK_NULL_HANDLE, physical.mip(bound.firstMip), info(accessOf(binding)).layout};
            if (binding.kind == gpu::BindingKind::sampledImage) {
                if (bound.mips == VK_REMAINING_MIP_LEVELS) image.imageView = physical.view;
                image.sampler = m_device.sampler(bound.sampling);
                if (!image.sampler) return Status::outOfMemory;  // the device has said so
            }
            contents.push_back({image, {buffer, offset, bytes}});
        }
        m_sets[step.pass] = frame().sets.make(*pass.m_program, 0, contents);
        if (!m_sets[step.pass])
            return gpu::fail(m_device, Status::outOfMemory, fmt::format("graph: no descriptor set for {}", pass.m_program->name()));
    }
    return Status::ok;
}

Status Executor::execute(Graph& graph, VkCommandBuffer cmd) {
    Plan plan;
    Pending histories;
    if (const Status status = prepare(graph, plan, histories); status != Status::ok) return status;
    record(graph, plan, cmd);
    commit(graph, plan, histories);
    return Status::ok;
}

// Everything that outlives the frame moves on here and nowhere else.
void Executor::commit(Graph& graph, Plan& plan, Pending& histories) noexcept {
    m_lastFrame = m_device.frame();
    for (size_t s = 0; s < m_pool.size(); ++s) m_pool[s].slot.state.swap(plan.slots[s].state);
    for (const int slot : plan.slotOf)
        if (slot >= 0) m_pool[size_t(slot)].lastUsed = m_device.frame();
    m_frameBytes = 0;
    for (const Pooled& pooled : m_pool)
        if (pooled.lastUsed == m_device.frame()) m_frameBytes += pooled.bytes();
    for (size_t i = 0; i < m_physical.size(); ++i) {
        const Origin origin = graph.m_recording.resources[i].origin;
        const auto same = [&](const Physical& other) { return other.buffer == m_physical[i].buffer; };
        const bool counted = origin == Origin::transient || std::any_of(m_physical.begin(), m_physical.begin() + i, same);
        if (origin == Origin::history) m_frameBytes += m_physical[i].owned->bytes();
        else if (!counted) m_frameBytes += m_physical[i].buffer.bytes;
    }
    for (size_t i = 0; i < histories.size(); ++i) {
        const auto& [history, resources] = graph.m_histories[i];
        for (uint32_t k = 0; k < 2; ++k) {
            if (histories[i][k]) history->m_copies[k].image = std::move(histories[i][k]);
            history->m_copies[k].states.swap(plan.finalStates[resources[k]]);
        }
        history->m_current = 1 - history->m_current;
        history->m_valid = true;
    }
    for (const std::function<void()>& then : graph.m_onRecorded) then();
    m_plan = std::move(plan);
}

}  // namespace obscura::graph
