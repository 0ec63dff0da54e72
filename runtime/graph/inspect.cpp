// What a graph says of itself: what its passes write, its plan as text, the memory it holds or would hold.
#include <algorithm>

#include "graph/physical.h"

namespace obscura::graph {

std::vector<Graph::Written> Graph::written() const {
    std::vector<Written> result;
    for (const Pass& pass : m_passes) {
        const PassDesc& desc = m_recording.passes[pass.m_index];
        for (const Use& use : desc.uses)
            if (info(use.access).writes && m_recording.resources[use.resource].kind != Kind::buffer)
                result.push_back({desc.name, {use.resource}});
        for (const Pass::Bound& bound : pass.m_bound)
            if (bound.writes && !bound.isBuffer) result.push_back({desc.name, {bound.resource}});
    }
    return result;
}

std::string Graph::planText() const { return m_plan.text(m_recording); }
std::string Graph::planDot() const { return m_plan.dot(m_recording); }

uint64_t Graph::poolBytes() const {
    uint64_t total = 0;
    for (const PoolImage& image : m_pool) total += image.image.bytes();
    for (const PoolBuffer& buffer : m_buffers) total += buffer.buffer.bytes();
    return total;
}

uint64_t Graph::frameBytes() const {
    uint64_t total = 0;
    for (const PoolImage& image : m_pool)
        if (image.lastUsed == m_device.frame()) total += image.image.bytes();
    std::vector<VkBuffer> seen;
    for (uint32_t i = 0; i < m_recording.resources.size(); ++i) {
        const Physical& physical = m_physical[i];
        if (physical.owned && m_plan.slotOf[i] < 0) total += physical.owned->bytes();
        if (!physical.buffer || std::find(seen.begin(), seen.end(), physical.buffer) != seen.end()) continue;
        seen.push_back(physical.buffer);
        total += physical.bytes;
    }
    return total;
}

uint64_t Graph::rehearsedBytes() {
    if (!bindings()) return 0;
    const Plan rehearsed = plan(m_recording);
    for (const std::string& problem : rehearsed.problems) m_device.log(gpu::Severity::error, "graph: " + problem);
    if (!rehearsed.problems.empty()) return 0;
    uint64_t total = m_rehearsed;
    for (const Slot& slot : rehearsed.slots) total += gpu::Image::bytesOf(m_device, slot.desc);
    return total;
}

}  // namespace obscura::graph
