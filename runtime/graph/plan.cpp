#include "graph/plan.h"

#include <algorithm>
#include <cassert>

namespace obscura::graph {
namespace {

// Which passes have an effect somebody sees: from the last one back, a pass lives when it must be kept, or writes what is
// an output or what a living later pass reads. Partial writes are common (mips, atomics), so a write never ends a need.
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
    return std::any_of(state.visible.begin(), state.visible.end(), [&](const State::Visible& v) {
        return (v.stages & stages) == stages && (v.access & access) == access;
    });
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
        const bool isImage = resource.kind != Kind::buffer;
        std::vector<State>& state = stateOf(use.resource);
        const VkPipelineStageFlags2 stages = next.stages ? next.stages : use.stages;
        assert(stages != 0);
        for (uint32_t mip = use.firstMip; mip < use.firstMip + use.mips; ++mip) {
            const bool first = !written[use.resource][mip];
            if (!next.writes && first && resource.kind == Kind::transient)
                result.problems.push_back("pass '" + pass.name + "' reads '" + resource.name + "' before anything wrote it");
            if (next.writes) written[use.resource][mip] = true;
            // What a transient held in another frame or another life is nobody's: no need to keep it.
            const bool discard = next.writes && (use.discard || (resource.kind == Kind::transient && first));
            Barrier barrier{use.resource, mip, 1};
            if (!advance(state[mip], next, stages, isImage, next.layout, discard, barrier)) continue;
            if (!barriers.empty() && sameBut(barriers.back(), barrier)) ++barriers.back().mips;
            else barriers.push_back(barrier);
        }
    }

    void close(uint32_t index) {
        const Resource& resource = recording.resources[index];
        if (resource.kind != Kind::imported) return;
        const bool named = resource.finalLayout != VK_IMAGE_LAYOUT_UNDEFINED;
        if (!named && resource.finalAccess == Access::none) return;
        const AccessInfo& end = info(resource.finalAccess);
        const VkImageLayout layout = named ? resource.finalLayout : end.layout;
        const VkPipelineStageFlags2 stages = !named && end.stages ? end.stages : VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        const AccessInfo leave{"leave", stages, named ? VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT : end.access, layout, 0, false};
        for (uint32_t mip = 0; mip < states[index].size(); ++mip) {
            Barrier barrier{index, mip, 1};
            if (!advance(states[index][mip], leave, stages, true, layout, false, barrier)) continue;
            if (!result.closing.empty() && sameBut(result.closing.back(), barrier)) ++result.closing.back().mips;
            else result.closing.push_back(barrier);
        }
    }
};

}  // namespace

Plan plan(const Recording& recording, const std::vector<Slot>& slots) {
    Plan result;
    const size_t count = recording.resources.size();
    const std::vector<bool> live = alive(recording);

    // Lifetimes and usage, then slots: a transient takes the first free image of its description.
    std::vector<int> first(count, -1), last(count, -1);
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
    result.slots = slots;
    std::vector<int> freeFrom(slots.size(), -1);  // pass after which a slot is free again
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < count; ++i)
        if (recording.resources[i].kind == Kind::transient && first[i] >= 0) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return first[a] < first[b]; });
    for (uint32_t i : order) {
        gpu::ImageDesc desc = recording.resources[i].desc;
        desc.usage |= usage[i];
        uint32_t ordinal = 0;
        int chosen = -1;
        for (size_t s = 0; s < result.slots.size(); ++s) {
            if (!(result.slots[s].desc == desc)) continue;
            if (freeFrom[s] < first[i]) { chosen = int(s); break; }
            ++ordinal;
        }
        if (chosen < 0) {
            chosen = int(result.slots.size());
            result.slots.push_back({desc, ordinal, std::vector<State>(desc.mips)});
            freeFrom.push_back(-1);
        }
        freeFrom[chosen] = recording.resources[i].output ? int(recording.passes.size()) : last[i];
        result.slotOf[i] = chosen;
    }

    Builder builder{recording, result, {}, {}};
    for (const Resource& resource : recording.resources) {
        const uint32_t mips = resource.kind == Kind::buffer ? 1 : resource.desc.mips;
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
    for (uint32_t i = 0; i < count; ++i) builder.close(i);
    result.finalStates = std::move(builder.states);
    return result;
}

}  // namespace obscura::graph
