#include "graph/plan.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace obscura::graph {
namespace {

constexpr uint64_t kUploadChunk = 256 << 10;  // bytes
constexpr uint64_t kUploadAlignment = 256;    // the largest minimum any Vulkan device asks for

// Which passes run: from the last one back, a pass is kept when it says so, or when it writes an output or what a kept later pass reads.
// Partial writes are common (mips, atomics), so a write does not make earlier writes needless.
std::vector<bool> alive(const Recording& recording) {
    std::vector<bool> needed;
    for (const Resource& resource : recording.resources) needed.push_back(resource.output);
    std::vector<bool> result(recording.passes.size(), false);
    for (size_t i = recording.passes.size(); i-- > 0;) {
        const PassDesc& pass = recording.passes[i];
        const auto counts = [&](const Use& use) { return info(use.access).writes && needed[use.resource]; };
        result[i] = pass.keep || std::any_of(pass.uses.begin(), pass.uses.end(), counts);
        if (!result[i]) continue;
        for (const Use& use : pass.uses)
            if (!info(use.access).writes || !use.discard) needed[use.resource] = true;
    }
    return result;
}

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
            if (!recording.resources[use.resource].isBuffer) usage[use.resource] |= info(use.access).imageUsage;
        }
    }
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < count; ++i)
        if (recording.resources[i].origin == Origin::transient && first[i] >= 0) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return first[a] < first[b]; });

    result.slotOf.assign(count, -1);
    std::vector<int> freeFrom(result.slots.size(), -1);  // pass after which a slot is free again
    for (uint32_t i : order) {
        const Resource& resource = recording.resources[i];
        gpu::ImageDesc desc = resource.made();
        desc.usage |= usage[i];
        size_t slot = 0;
        const auto fits = [&](const Slot& s) { return s.bytes == resource.madeBytes() && s.desc == desc && freeFrom[slot] < first[i]; };
        while (slot < result.slots.size() && !fits(result.slots[slot])) ++slot;
        if (slot == result.slots.size()) {
            result.slots.push_back({desc, resource.madeBytes(), std::vector<State>(desc.mips)});
            freeFrom.push_back(-1);
        }
        freeFrom[slot] = resource.output ? int(recording.passes.size()) : last[i];
        result.slotOf[i] = int(slot);
    }
}

// An upload goes behind the others in the first chunk that has the space.
void placeUploads(const Recording& recording, Plan& result) {
    result.placements.resize(recording.resources.size());
    std::vector<uint64_t> used(result.chunks.size(), 0);
    for (size_t i = 0; i < recording.resources.size(); ++i) {
        const Resource& resource = recording.resources[i];
        if (resource.origin != Origin::upload) continue;
        const uint64_t bytes = resource.madeBytes();
        uint32_t chunk = 0;
        while (chunk < used.size() && used[chunk] + bytes > result.chunks[chunk]) ++chunk;
        if (chunk == used.size()) {
            result.chunks.push_back(std::max(kUploadChunk, bytes));
            used.push_back(0);
        }
        result.placements[i] = {chunk, used[chunk]};
        used[chunk] += (bytes + kUploadAlignment - 1) / kUploadAlignment * kUploadAlignment;
    }
}

// Moves one mip's state to its next access and fills in the barrier between the two; true when it is needed.
bool advance(State& state, const AccessInfo& next, bool discard, Barrier& barrier) {
    const bool changesLayout = state.layout != next.layout;
    const bool writes = next.writes || changesLayout;  // waits for the last write and for everything that read it
    barrier.srcStages = state.writeStages | (writes ? state.readStages : 0);
    barrier.srcAccess = state.writeAccess;
    barrier.dstStages = next.stages;
    barrier.dstAccess = next.access;
    barrier.from = discard ? VK_IMAGE_LAYOUT_UNDEFINED : state.layout;
    barrier.to = next.layout;
    if (!writes) {
        state.readStages |= next.stages;
        const auto seesIt = [&](const State::Visible& v) { return (next.stages & ~v.stages) == 0 && (next.access & ~v.access) == 0; };
        if (state.writeStages == 0 || std::any_of(state.visible.begin(), state.visible.end(), seesIt)) return false;
        state.visible.push_back({next.stages, next.access});
        return true;
    }
    if (next.writes) state = {next.layout, next.stages, next.access};
    else state = {next.layout, next.stages, 0, next.stages, {{next.stages, next.access}}};  // the transition, visible to this reader
    return barrier.srcStages != 0 || changesLayout;
}

// Neighbouring mips that need the same share a barrier.
void append(std::vector<Barrier>& barriers, const Barrier& barrier) {
    if (!barriers.empty()) {
        Barrier next = barriers.back();
        next.firstMip += std::exchange(next.mips, 1);
        if (next == barrier) {
            ++barriers.back().mips;
            return;
        }
    }
    barriers.push_back(barrier);
}

struct Builder {
    const Recording& recording;
    Plan& result;
    std::vector<std::vector<bool>> written;  // by resource and mip, this frame

    // Adds the barriers before a use. `next`: what it does.
    void use(const std::string& pass, const Use& use, AccessInfo next, std::vector<Barrier>& barriers) {
        const Resource& resource = recording.resources[use.resource];
        const int slot = result.slotOf[use.resource];
        std::vector<State>& states = slot >= 0 ? result.slots[size_t(slot)].state : result.finalStates[use.resource];
        if (next.stages == 0) next.stages = use.stages;
        assert(next.stages != 0);
        if (resource.isBuffer) next.layout = VK_IMAGE_LAYOUT_UNDEFINED;
        for (uint32_t mip = use.firstMip; mip < use.firstMip + use.mips; ++mip) {
            const bool undefined = resource.origin == Origin::transient && !written[use.resource][mip];
            if (undefined && !next.writes && mip < resource.desc.mips)
                result.problems.push_back("pass '" + pass + "' reads '" + resource.name + "' before anything wrote it");
            if (next.writes) written[use.resource][mip] = true;
            Barrier barrier{use.resource, mip, 1};
            // The first write of a transient may discard its old contents.
            if (advance(states[mip], next, next.writes && (use.discard || undefined), barrier)) append(barriers, barrier);
        }
    }
};

}  // namespace

Plan plan(const Recording& recording, std::vector<Slot> slots, std::vector<uint64_t> chunks) {
    Plan result{.slots = std::move(slots), .chunks = std::move(chunks)};
    const std::vector<bool> live = alive(recording);
    assignSlots(recording, live, result);
    placeUploads(recording, result);

    Builder builder{recording, result, {}};
    for (const Resource& resource : recording.resources) {
        result.finalStates.push_back(resource.initial);
        result.finalStates.back().resize(resource.made().mips);
        builder.written.emplace_back(resource.made().mips, false);
    }
    for (uint32_t p = 0; p < recording.passes.size(); ++p) {
        if (!live[p]) continue;
        Plan::Step& step = result.steps.emplace_back(Plan::Step{p, {}});
        for (const Use& use : recording.passes[p].uses) builder.use(recording.passes[p].name, use, info(use.access), step.barriers);
    }
    // Imported images go back in the layout that was asked for.
    for (uint32_t i = 0; i < recording.resources.size(); ++i) {
        const Resource& resource = recording.resources[i];
        const AccessInfo leave{"leave", VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
            resource.finalLayout, 0, false};
        if (leave.layout != VK_IMAGE_LAYOUT_UNDEFINED) builder.use("", {i, 0, resource.desc.mips}, leave, result.closing);
    }
    return result;
}

uint64_t bytes(const Recording& recording, const Plan& plan, uint32_t framesInFlight, const MemoryOf& memory) {
    uint64_t total = 0;
    for (const Slot& slot : plan.slots)
        total += slot.bytes ? memory.buffer(slot.bytes, kPoolBufferUsage, gpu::Memory::device) : memory.image(slot.desc);
    for (const Resource& resource : recording.resources)
        if (resource.origin == Origin::history) total += memory.image(resource.made());
    for (const uint64_t chunk : plan.chunks) total += framesInFlight * memory.buffer(chunk, kUploadUsage, gpu::Memory::upload);
    return total;
}

}  // namespace obscura::graph
