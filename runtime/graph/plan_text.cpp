// The plan in words, for tests and for people, and as a Graphviz drawing.
#include <fmt/format.h>

#include "graph/plan.h"

namespace obscura::graph {
namespace {

struct Bit {
    uint64_t bit;
    const char* name;
};

constexpr Bit kStages[] = {{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute"}, {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "vertex"},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment"}, {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "color"},
    {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT, "early"}, {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "late"},
    {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer"}, {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, "attributes"},
    {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, "indices"}, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, "all"},
    {VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT, "end"}, {VK_PIPELINE_STAGE_2_HOST_BIT, "host"}};

constexpr Bit kAccesses[] = {{VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, "sample"}, {VK_ACCESS_2_SHADER_STORAGE_READ_BIT, "read"},
    {VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, "write"}, {VK_ACCESS_2_UNIFORM_READ_BIT, "uniform"},
    {VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT, "blend"}, {VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, "draw"},
    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, "test"}, {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, "depthWrite"},
    {VK_ACCESS_2_TRANSFER_READ_BIT, "copyFrom"}, {VK_ACCESS_2_TRANSFER_WRITE_BIT, "copyTo"},
    {VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT, "vertexRead"}, {VK_ACCESS_2_INDEX_READ_BIT, "indexRead"},
    {VK_ACCESS_2_HOST_READ_BIT, "hostRead"}, {VK_ACCESS_2_MEMORY_READ_BIT, "anyRead"}, {VK_ACCESS_2_MEMORY_WRITE_BIT, "anyWrite"}};

template <size_t N> std::string bits(uint64_t value, const Bit (&table)[N]) {
    std::string result;
    for (const Bit& entry : table) {
        if (!(value & entry.bit)) continue;
        if (!result.empty()) result += '+';
        result += entry.name;
        value &= ~entry.bit;
    }
    if (value) result += fmt::format("{}{:#x}", result.empty() ? "" : "+", value);
    return result.empty() ? "-" : result;
}

const char* layoutName(VkImageLayout layout) {
    switch (layout) {
        case VK_IMAGE_LAYOUT_UNDEFINED: return "undefined";
        case VK_IMAGE_LAYOUT_GENERAL: return "general";
        case VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL: return "sampled";
        case VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL: return "color";
        case VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL: return "depth";
        case VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL: return "depthRead";
        case VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL: return "transferSrc";
        case VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL: return "transferDst";
        case VK_IMAGE_LAYOUT_PRESENT_SRC_KHR: return "present";
        default: return "other";
    }
}

std::string line(const Recording& recording, const Barrier& barrier) {
    const Resource& resource = recording.resources[barrier.resource];
    std::string what = resource.name;
    if (!resource.isBuffer && resource.desc.mips > 1)
        what += barrier.mips == 1 ? fmt::format("[{}]", barrier.firstMip)
                                  : fmt::format("[{}-{}]", barrier.firstMip, barrier.firstMip + barrier.mips - 1);
    const std::string layouts =
        resource.isBuffer || barrier.from == barrier.to ? "" : fmt::format(" {}>{}", layoutName(barrier.from), layoutName(barrier.to));
    return fmt::format("  {}: {}({}) > {}({}){}\n", what, bits(barrier.srcStages, kStages), bits(barrier.srcAccess, kAccesses),
        bits(barrier.dstStages, kStages), bits(barrier.dstAccess, kAccesses), layouts);
}

}  // namespace

std::string Plan::text(const Recording& recording) const {
    std::string result;
    std::vector<bool> runs(recording.passes.size(), false);
    for (const Step& step : steps) {
        runs[step.pass] = true;
        result += recording.passes[step.pass].name + "\n";
        for (const Barrier& barrier : step.barriers) result += line(recording, barrier);
    }
    if (!closing.empty()) result += "end\n";
    for (const Barrier& barrier : closing) result += line(recording, barrier);
    for (size_t i = 0; i < runs.size(); ++i)
        if (!runs[i]) result += "culled " + recording.passes[i].name + "\n";
    for (size_t s = 0; s < slots.size(); ++s) {
        std::string names;
        for (size_t i = 0; i < slotOf.size(); ++i)
            if (slotOf[i] == int(s)) names += " " + recording.resources[i].name;
        if (!names.empty()) result += fmt::format("{} {}:{}\n", slots[s].bytes ? "buffer" : "image", s, names);
    }
    for (const std::string& problem : problems) result += "problem: " + problem + "\n";
    return result;
}

std::string Plan::dot(const Recording& recording) const {
    std::string result = "digraph frame {\n  rankdir=LR;\n  node [fontname=\"sans-serif\"];\n";
    std::vector<bool> shown(recording.resources.size(), false);
    for (const Step& step : steps) {
        const PassDesc& pass = recording.passes[step.pass];
        result += fmt::format("  p{} [label=\"{}\" shape=box style=filled fillcolor=\"#ffe9c9\"];\n", step.pass, pass.name);
        for (const Use& use : pass.uses) {
            if (!shown[use.resource])
                result += fmt::format("  r{} [label=\"{}\" shape=ellipse];\n", use.resource, recording.resources[use.resource].name);
            shown[use.resource] = true;
            const AccessInfo& access = info(use.access);
            if (access.writes) result += fmt::format("  p{} -> r{} [label=\"{}\"];\n", step.pass, use.resource, access.name);
            else result += fmt::format("  r{} -> p{} [label=\"{}\"];\n", use.resource, step.pass, access.name);
        }
    }
    return result + "}\n";
}

}  // namespace obscura::graph
