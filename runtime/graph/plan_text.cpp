// The plan in words, for tests and for people, and as a Graphviz drawing.
#include <span>

#include <fmt/format.h>

#include "graph/plan.h"

namespace obscura::graph {
namespace {

struct Name {
    uint64_t value;
    const char* name;
};

constexpr Name kStages[] = {{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute"}, {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "vertex"},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment"}, {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "color"},
    {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT, "early"}, {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "late"},
    {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer"}, {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, "attributes"},
    {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, "indices"}, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, "all"},
    {VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT, "end"}, {VK_PIPELINE_STAGE_2_HOST_BIT, "host"}};

constexpr Name kAccesses[] = {{VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, "sample"}, {VK_ACCESS_2_SHADER_STORAGE_READ_BIT, "read"},
    {VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, "write"}, {VK_ACCESS_2_UNIFORM_READ_BIT, "uniform"},
    {VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT, "blend"}, {VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, "draw"},
    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, "test"}, {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, "depthWrite"},
    {VK_ACCESS_2_TRANSFER_READ_BIT, "copyFrom"}, {VK_ACCESS_2_TRANSFER_WRITE_BIT, "copyTo"},
    {VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT, "vertexRead"}, {VK_ACCESS_2_INDEX_READ_BIT, "indexRead"},
    {VK_ACCESS_2_HOST_READ_BIT, "hostRead"}, {VK_ACCESS_2_MEMORY_READ_BIT, "anyRead"}, {VK_ACCESS_2_MEMORY_WRITE_BIT, "anyWrite"}};

constexpr Name kLayouts[] = {{VK_IMAGE_LAYOUT_UNDEFINED, "undefined"}, {VK_IMAGE_LAYOUT_GENERAL, "general"},
    {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, "sampled"}, {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, "color"},
    {VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, "depth"}, {VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL, "depthRead"},
    {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, "transferSrc"}, {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, "transferDst"},
    {VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, "present"}};

// "compute+vertex"; what has no name in hexadecimal.
std::string bits(uint64_t value, std::span<const Name> table) {
    std::vector<std::string> names;
    for (const Name& entry : table) {
        if (value & entry.value) names.push_back(entry.name);
        value &= ~entry.value;
    }
    if (value) names.push_back(fmt::format("{:#x}", value));
    return names.empty() ? "-" : fmt::format("{}", fmt::join(names, "+"));
}

const char* layoutName(VkImageLayout layout) {
    for (const Name& entry : kLayouts)
        if (entry.value == uint64_t(layout)) return entry.name;
    return "other";
}

std::string line(const Recording& recording, const Barrier& b) {
    const Resource& resource = recording.resources[b.resource];
    std::string mips, layouts;
    if (resource.desc.mips > 1)
        mips = b.mips == 1 ? fmt::format("[{}]", b.firstMip) : fmt::format("[{}-{}]", b.firstMip, b.firstMip + b.mips - 1);
    if (b.from != b.to) layouts = fmt::format(" {}>{}", layoutName(b.from), layoutName(b.to));
    return fmt::format("  {}{}: {}({}) > {}({}){}\n", resource.name, mips, bits(b.srcStages, kStages), bits(b.srcAccess, kAccesses),
        bits(b.dstStages, kStages), bits(b.dstAccess, kAccesses), layouts);
}

}  // namespace

std::string Plan::names(const Recording& recording, size_t slot, const char* separator) const {
    std::string result;
    for (size_t i = 0; i < slotOf.size(); ++i)
        if (slotOf[i] == int(slot)) result += (result.empty() ? "" : separator) + recording.resources[i].name;
    return result;
}

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
    for (size_t s = 0; s < slots.size(); ++s)
        if (const std::string living = names(recording, s, " "); !living.empty())
            result += fmt::format("{} {}: {}\n", slots[s].bytes ? "buffer" : "image", s, living);
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
