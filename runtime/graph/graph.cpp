// Declaring a frame.
#include "graph/graph.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <fmt/format.h>

namespace obscura::graph {

Pass& Pass::bind(const Bound& bound) {
    m_bound.push_back(bound);
    return *this;
}

Pass& Pass::color(ImageId image, std::optional<VkClearColorValue> clear) {
    return attach(image, Access::color, clear ? std::optional(VkClearValue{.color = *clear}) : std::nullopt);
}

Pass& Pass::depth(ImageId image, std::optional<float> clear) {
    return attach(image, Access::depth, clear ? std::optional(VkClearValue{.depthStencil = {*clear, 0}}) : std::nullopt);
}

Pass& Pass::attach(ImageId image, Access access, std::optional<VkClearValue> clear) {
    m_attachments.push_back({image.index, access, clear});
    return use(image, access, clear.has_value());
}

Pass& Pass::use(ResourceId id, Access access, bool discard) {
    m_desc.uses.push_back({id.index, 0, VK_REMAINING_MIP_LEVELS, access, 0, discard});
    return *this;
}

Pass& Pass::keep() {
    m_desc.keep = true;
    return *this;
}

void Pass::dispatch(uint32_t x, uint32_t y, uint32_t z) {
    m_invocations = {x, y, z};
    m_work = [x, y, z](const PassContext& c) {
        const auto& [gx, gy, gz] = c.program->workgroup();
        c.device.vk().CmdDispatch(c.cmd, (x + gx - 1) / gx, (y + gy - 1) / gy, (z + gz - 1) / gz);
    };
}

void Pass::record(Record record) {
    m_work = std::move(record);
    m_recorded = true;
}

bool Capacity::Slot::holds(const Resource& resource) const {
    const gpu::ImageDesc& d = resource.desc;
    return desc.format == d.format && desc.width >= d.width && desc.height >= d.height && desc.depth >= d.depth && desc.mips >= d.mips &&
           bytes >= resource.bytes;
}

void Capacity::grow(const Graph& graph) {
    std::map<std::string, size_t> count;
    for (const Resource& resource : graph.m_recording.resources) {
        if (resource.origin == Origin::imported) continue;
        std::vector<Slot>& slots = m_slots[resource.name];
        const size_t index = count[resource.name]++;
        if (index == slots.size()) slots.emplace_back();
        Slot& slot = slots[index];
        const gpu::ImageDesc& d = resource.desc;
        slot.desc = {d.format, std::max(slot.desc.width, d.width), std::max(slot.desc.height, d.height), std::max(slot.desc.depth, d.depth),
            std::max(slot.desc.mips, d.mips)};
        slot.bytes = std::max(slot.bytes, resource.bytes);
    }
    m_passCount = std::max(m_passCount, uint32_t(graph.m_passes.size()));
}

void Graph::begin(const Timings* timings, const Capacity* capacity) {
    m_timings = timings ? timings : &kNoTimings;
    m_recording = {};
    m_passes.clear();
    m_physical.clear();
    m_histories.clear();
    m_onRecorded.clear();
    m_prefix.clear();
    m_capacity = capacity;
    m_declared.clear();
    m_fits = true;
}

uint32_t Graph::add(Resource resource, const Physical& physical) {
    if (m_capacity && resource.origin != Origin::imported) {
        const auto slots = m_capacity->m_slots.find(resource.name);
        const size_t index = m_declared[resource.name]++;
        const bool known = slots != m_capacity->m_slots.end() && index < slots->second.size();
        if (known && slots->second[index].holds(resource)) {
            resource.largest = slots->second[index].desc;
            resource.largest.usage = resource.desc.usage;
            resource.largestBytes = slots->second[index].bytes;
        } else {
            m_fits = false;
        }
    }
    m_recording.resources.push_back(std::move(resource));
    m_physical.push_back(physical);
    return uint32_t(m_physical.size() - 1);
}

ImageId Graph::image(std::string name, gpu::ImageDesc desc) {
    assert(desc.format != VK_FORMAT_UNDEFINED && desc.width > 0 && desc.height > 0);
    return {add({.name = std::move(name), .desc = desc})};
}

BufferId Graph::buffer(std::string name, uint64_t bytes) {
    assert(bytes > 0);
    return {add({.name = std::move(name), .isBuffer = true, .bytes = bytes})};
}

BufferId Graph::upload(std::string name, const void* data, size_t bytes) {
    assert(bytes > 0);
    const auto* first = static_cast<const std::byte*>(data);
    return {add({.name = std::move(name), .origin = Origin::upload, .isBuffer = true, .bytes = bytes, .data = {first, first + bytes}})};
}

ImageId Graph::import(std::string name, const External& external) {
    const VkAccessFlags2 written = external.layout == VK_IMAGE_LAYOUT_UNDEFINED ? 0 : VK_ACCESS_2_MEMORY_WRITE_BIT;
    return {add({.name = std::move(name),
                    .origin = Origin::imported,
                    .desc = external.desc,
                    .initial = {{external.layout, external.stages, written}},
                    .finalLayout = external.layoutAfter,
                    .output = true},
        {.image = external.image, .view = external.view, .firstMip = external.mip, .layer = external.layer})};
}

BufferId Graph::import(std::string name, const gpu::Buffer& buffer, Shared shared) {
    const BufferId id = import(std::move(name), ExternalBuffer{buffer.handle(), 0, buffer.bytes()});
    Resource& resource = m_recording.resources[id.index];
    resource.output = shared == Shared::written;
    if (shared == Shared::constant) resource.initial = {};
    return id;
}

BufferId Graph::import(std::string name, const ExternalBuffer& buffer) {
    const State written{VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT};
    return {add({.name = std::move(name), .origin = Origin::imported, .isBuffer = true, .bytes = buffer.bytes, .initial = {written}},
        {.buffer = buffer})};
}

Graph::HistoryPair Graph::history(std::string name, gpu::ImageDesc desc, History& history, bool discard) {
    desc.usage |=
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    const uint32_t write = history.m_current, read = 1 - write;
    HistoryUse use{&history, {}};
    for (const uint32_t k : {read, write}) {
        const History::Copy& copy = history.m_copies[k];
        use.resources[k] =
            add({.name = k == read ? name + ".previous" : name, .origin = Origin::history, .desc = desc, .output = k == write});
        Resource& resource = m_recording.resources[use.resources[k]];
        if (copy.image.desc() == resource.made()) resource.initial = copy.states;
    }
    m_histories.push_back(use);
    const ImageId previous{use.resources[read]};
    const bool valid = history.m_valid && history.m_copies[read].image.desc() == made(previous) && !discard;
    if (!valid)
        pass(std::move(name) + ".clear").use(previous, Access::transferWrite, true).record([previous](const PassContext& c) {
            const VkClearColorValue zero{};
            const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0, 1};
            c.device.vk().CmdClearColorImage(c.cmd, c.image(previous), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &zero, 1, &range);
        });
    return {previous, {use.resources[write]}, valid};
}

Pass& Graph::add(std::string name, gpu::Program* program) {
    Pass& pass = m_passes.emplace_back();
    pass.m_desc.name = m_prefix + std::move(name);
    pass.m_program = program;
    return pass;
}

std::vector<Graph::Written> Graph::written() const {
    std::vector<Written> result;
    for (const Pass& pass : m_passes) {
        const auto add = [&](uint32_t resource, bool writes) {
            if (writes && !m_recording.resources[resource].isBuffer) result.push_back({pass.m_desc.name, {resource}});
        };
        for (const Use& use : pass.m_desc.uses) add(use.resource, info(use.access).writes);
        for (const Pass::Bound& bound : pass.m_bound) add(bound.resource, bound.writes);
    }
    return result;
}

bool Graph::resolve() {
    m_recording.passes.clear();
    for (const Pass& pass : m_passes) {
        if (pass.m_program) pass.m_program->refresh();
        PassDesc& desc = m_recording.passes.emplace_back(pass.m_desc);
        for (Use& use : desc.uses) use.mips = m_recording.resources[use.resource].made().mips;
        if (const std::string problem = resolve(pass, desc.uses); !problem.empty()) {
            m_device.log(gpu::Severity::error, fmt::format("graph: pass '{}': {}", desc.name, problem));
            return false;
        }
    }
    return true;
}

// A pass against its shaders: as many bindings as reads and writes, each of the kind that was given. Returns what is wrong.
std::string Graph::resolve(const Pass& pass, std::vector<Use>& uses) const {
    if (!pass.m_work) return "neither dispatch nor record was called";
    if (!pass.m_program) return pass.m_bound.empty() && pass.m_recorded ? "" : "has no program to read, write or dispatch with";
    const gpu::Program& program = *pass.m_program;
    if (!program) return "its program was never made";
    const std::span<const gpu::Binding> bindings = program.bindings(0);
    for (size_t i = 0; i < bindings.size(); ++i) {
        const gpu::Binding& binding = bindings[i];
        if (i >= pass.m_bound.size())
            return fmt::format("{} declares '{}' as binding {}, but only {} resources were given", program.name(), binding.name,
                binding.binding, pass.m_bound.size());
        const Pass::Bound& bound = pass.m_bound[i];
        const Resource& resource = m_recording.resources[bound.resource];
        const bool wantsImage = binding.kind == gpu::BindingKind::sampledImage || binding.kind == gpu::BindingKind::storageImage;
        if (wantsImage == resource.isBuffer)
            return fmt::format("'{}' is {}, binding '{}' wants {}", resource.name, resource.isBuffer ? "a buffer" : "an image",
                binding.name, wantsImage ? "an image" : "a buffer");
        if (bound.writes != binding.writes)
            return fmt::format("'{}' is given as {}, the shader {} '{}'", resource.name, bound.writes ? "written" : "read",
                binding.writes ? "writes" : "only reads", binding.name);
        uses.push_back({bound.resource, bound.firstMip, std::min(bound.mips, resource.made().mips), accessOf(binding),
            gpu::pipelineStages(program.stagesOf(binding))});
    }
    if (bindings.size() != pass.m_bound.size())
        return fmt::format("{} resources were given, {} declares {}", pass.m_bound.size(), program.name(), bindings.size());
    if (program.pushConstantBytes() > pass.m_constants.size() && !pass.m_recorded)
        return fmt::format(
            "{} wants {} bytes of constants, {} were given", program.name(), program.pushConstantBytes(), pass.m_constants.size());
    return "";
}

}  // namespace obscura::graph
