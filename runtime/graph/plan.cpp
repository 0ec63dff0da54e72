#include "graph/plan.h"

#include <algorithm>
#include <cassert>

namespace obscura::graph {
namespace {

constexpr uint64_t kUploadChunk = 256 << 10;  // bytes
constexpr uint64_t kUploadAlignment = 256;    // the largest minimum any Vulkan device asks for

// Which passes run: from the last one back, a pass is kept when it says so, or when it writes an output or what a kept later pass reads.
// Partial writes are common (mips, atomics), so a write does not make earlier writes needless.
std::vector<bool> alive(const Recording& recording) {
    std::vector<bool> needed(recording.resources.size(), false);
    for (size_t i = 0; i < needed.size(); ++i) needed[i] = recording.resources[i].output;
    std::vector<bool> result(recording.passes.size(), false);
    for (size_t i = recording.passes.size(); i-- > 0;) {
        const PassDesc& pass = recording.passes[i];
        bool live = pass.keep;
        for (const Use& use : pass.uses) live |= info(use.access).writes && needed[use.resource];
        if (!live) continue;
        result[i] = true;
        for (const Use& use : pass.uses)
            if (!info(use.access).writes || !use.discard) needed[use.resource] = true;
    }
    return result;
}

bool isVisible(const State& state, VkPipelineStageFlags2 stages, VkAccessFlags2 access) {
    return std::any_of(state.visible.begin(), state.visible.end(),
        [&](const State::Visible& v) { return (v.stages & stages) == stages && (v.access & access) == access; });
}

// Moves one mip's state to its next use; true when a barrier must stand before it, then filled in.
bool advance(State& state, const AccessInfo& next, VkPipelineStageFlags2 stages, bool isImage, VkImageLayout layout, bool discard,
    Barrier& barrier) {
    const bool changesLayout = isImage && state.layout != layout;
    barrier.dstStages = stages;
    barrier.dstAccess = next.access;
    barrier.from = discard ? VK_IMAGE_LAYOUT_UNDEFINED : state.layout;
    barrier.to = isImage ? layout : VK_IMAGE_LAYOUT_UNDEFINED;

    if (!next.writes && !changesLayout) {
        const bool pending = state.writeStages != 0 && !isVisible(state, stages, next.access);
        state.readStages |= stages;
        if (!pending) return false;
        barrier.srcStages = state.writeStages;
        barrier.srcAccess = state.writeAccess;
        barrier.from = state.layout;  // no transition: contents stay
        state.visible.push_back({stages, next.access});
        return true;
    }
    // A write, or a layout change (which writes): after the last write and everything that read it.
    barrier.srcStages = state.writeStages | state.readStages;
    barrier.srcAccess = state.writeAccess;
    const bool needed = barrier.srcStages != 0 || changesLayout;
    state.layout = layout;
    state.writeStages = stages;
    if (next.writes) {
        state.writeAccess = next.access;
        state.readStages = 0;
        state.visible.clear();
    } else {  // the transition is the write; it is visible to this reader
        state.writeAccess = 0;
        state.readStages = stages;
        state.visible.assign(1, {stages, next.access});
    }
    return needed;
}

bool sameBut(const Barrier& a, const Barrier& b) {
    return a.resource == b.resource && a.firstMip + a.mips == b.firstMip && a.srcStages == b.srcStages && a.dstStages == b.dstStages &&
           a.srcAccess == b.srcAccess && a.dstAccess == b.dstAccess && a.from == b.from && a.to == b.to;
}

struct Builder {
    const Recording& recording;
    Plan& result;
    std::vector<std::vector<State>> states;  // per resource, of what it is bound to now
    std::vector<std::vector<bool>> written;  // per resource and mip, this frame

    std::vector<State>& stateOf(uint32_t resource) {
        const int slot = result.slotOf[resource];
        return slot >= 0 ? result.slots[slot].state : states[resource];
    }

    void use(const PassDesc& pass, const Use& use, std::vector<Barrier>& barriers) {
        const Resource& resource = recording.resources[use.resource];
        const AccessInfo& next = info(use.access);
        const bool isImage = !resource.isBuffer;
        std::vector<State>& state = stateOf(use.resource);
        const VkPipelineStageFlags2 stages = next.stages ? next.stages : use.stages;
        assert(stages != 0);
        for (uint32_t mip = use.firstMip; mip < use.firstMip + use.mips; ++mip) {
            const bool first = !written[use.resource][mip];
            if (!next.writes && first && resource.origin == Origin::transient)
                result.problems.push_back("pass '" + pass.name + "' reads '" + resource.name + "' before anything wrote it");
            if (next.writes) written[use.resource][mip] = true;
            // The first write of a transient may discard its old contents.
            const bool discard = next.writes && (use.discard || (resource.origin == Origin::transient && first));
            Barrier barrier{use.resource, mip, 1};
            if (!advance(state[mip], next, stages, isImage, next.layout, discard, barrier)) continue;
            if (!barriers.empty() && sameBut(barriers.back(), barrier)) ++barriers.back().mips;
            else barriers.push_back(barrier);
        }
    }

    // Imported images go back in the layout that was asked for.
    void close(uint32_t index) {
        const VkImageLayout layout = recording.resources[index].finalLayout;
        if (layout == VK_IMAGE_LAYOUT_UNDEFINED) return;
        const AccessInfo leave{
            "leave", VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT, layout, 0, false};
        for (uint32_t mip = 0; mip < states[index].size(); ++mip) {
            Barrier barrier{index, mip, 1};
            if (!advance(states[index][mip], leave, leave.stages, true, layout, false, barrier)) continue;
            if (!result.closing.empty() && sameBut(result.closing.back(), barrier)) ++result.closing.back().mips;
            else result.closing.push_back(barrier);
        }
    }
};

// A transient takes the first slot of its description that is free while it is in use.
void assignSlots(const Recording& recording, const std::vector<bool>& live, Plan& result) {
    const size_t count = recording.resources.size();
    std::vector<int> first(count, -1), last(count, -1);  // passes that use it
    std::vector<VkImageUsageFlags> usage(count, 0);
    for (size_t p = 0; p < recording.passes.size(); ++p) {
        if (!live[p]) continue;
        for (const Use& use : recording.passes[p].uses) {
            if (first[use.resource] < 0) first[use.resource] = int(p);
            last[use.resource] = int(p);
            usage[use.resource] |= info(use.access).imageUsage;
        }
    }
    result.slotOf.assign(count, -1);
    std::vector<int> freeFrom(result.slots.size(), -1);  // pass after which a slot is free again
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < count; ++i)
        if (recording.resources[i].origin == Origin::transient && first[i] >= 0) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return first[a] < first[b]; });
    for (uint32_t i : order) {
        const Resource& resource = recording.resources[i];
        gpu::ImageDesc desc = resource.desc;
        if (!resource.isBuffer) desc.usage |= usage[i];
        size_t chosen = 0;
        while (chosen < result.slots.size() &&
               !(result.slots[chosen].bytes == resource.bytes && result.slots[chosen].desc == desc && freeFrom[chosen] < first[i]))
            ++chosen;
        if (chosen == result.slots.size()) {
            result.slots.push_back({desc, resource.bytes, std::vector<State>(resource.isBuffer ? 1 : desc.mips)});
            freeFrom.push_back(-1);
        }
        freeFrom[chosen] = resource.output ? int(recording.passes.size()) : last[i];
        result.slotOf[i] = int(chosen);
    }
}

// An upload goes behind the others in the first chunk that has the space.
void placeUploads(const Recording& recording, Plan& result) {
    result.placements.resize(recording.resources.size());
    std::vector<uint64_t> used(result.chunks.size(), 0);
    for (size_t i = 0; i < recording.resources.size(); ++i) {
        const Resource& resource = recording.resources[i];
        if (resource.origin != Origin::upload) continue;
        uint32_t chunk = 0;
        while (chunk < used.size() && used[chunk] + resource.bytes > result.chunks[chunk]) ++chunk;
        if (chunk == used.size()) {
            result.chunks.push_back(std::max(kUploadChunk, resource.bytes));
            used.push_back(0);
        }
        result.placements[i] = {chunk, used[chunk]};
        used[chunk] += (resource.bytes + kUploadAlignment - 1) / kUploadAlignment * kUploadAlignment;
    }
}

}  // namespace

Plan plan(const Recording& recording, std::vector<Slot> slots, std::vector<uint64_t> chunks) {
    Plan result;
    result.slots = std::move(slots);
    result.chunks = std::move(chunks);
    const std::vector<bool> live = alive(recording);
    assignSlots(recording, live, result);
    placeUploads(recording, result);

    Builder builder{recording, result, {}, {}};
    for (const Resource& resource : recording.resources) {
        const uint32_t mips = resource.isBuffer ? 1 : resource.desc.mips;
        builder.states.push_back(resource.initial);
        builder.states.back().resize(mips);
        builder.written.emplace_back(mips, false);
    }
    for (uint32_t p = 0; p < recording.passes.size(); ++p) {
        if (!live[p]) continue;
        Plan::Step step{p, {}};
        for (const Use& use : recording.passes[p].uses) builder.use(recording.passes[p], use, step.barriers);
        result.steps.push_back(std::move(step));
    }
    for (uint32_t i = 0; i < recording.resources.size(); ++i) builder.close(i);
    result.finalStates = std::move(builder.states);
    return result;
}

uint64_t bytes(const Recording& recording, const Plan& plan, uint32_t framesInFlight, const MemoryOf& memory) {
    uint64_t total = 0;
    for (const Slot& slot : plan.slots)
        total += slot.bytes ? memory.buffer(slot.bytes, kPoolBufferUsage, gpu::Memory::device) : memory.image(slot.desc);
    for (const Resource& resource : recording.resources)
        if (resource.origin == Origin::history) total += memory.image(resource.desc);
    for (const uint64_t chunk : plan.chunks) total += framesInFlight * memory.buffer(chunk, kUploadUsage, gpu::Memory::upload);
    return total;
}

}  // namespace obscura::graph
