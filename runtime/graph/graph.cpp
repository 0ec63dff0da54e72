// Declaring a frame.
#include "graph/graph.h"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

namespace obscura::graph {

Pass& Pass::read(ImageId image, Sampling sampling) { return readMip(image, ~0u, sampling); }
Pass& Pass::readMip(ImageId image, uint32_t mip, Sampling sampling) {
    m_bound.push_back({false, image.index, mip, sampling, false});
    return *this;
}
Pass& Pass::read(BufferId buffer) {
    m_bound.push_back({true, buffer.index, 0, Sampling::nearest, false});
    return *this;
}
Pass& Pass::write(ImageId image) { return writeMip(image, 0); }
Pass& Pass::writeMip(ImageId image, uint32_t mip) {
    m_bound.push_back({false, image.index, mip, Sampling::nearest, true});
    return *this;
}
Pass& Pass::write(BufferId buffer) {
    m_bound.push_back({true, buffer.index, 0, Sampling::nearest, true});
    return *this;
}

Pass& Pass::color(ImageId image, std::optional<VkClearColorValue> clear) {
    VkClearValue value{};
    if (clear) value.color = *clear;
    m_colors.push_back({image.index, clear.has_value(), value});
    return use(image, Access::color, clear.has_value());
}

Pass& Pass::depth(ImageId image, std::optional<float> clear) {
    VkClearValue value{};
    value.depthStencil.depth = clear.value_or(0.0f);
    m_depth = Attachment{image.index, clear.has_value(), value};
    return use(image, Access::depth, clear.has_value());
}

Pass& Pass::depthTest(ImageId image) {
    m_depth = Attachment{image.index, false, {}};
    return use(image, Access::depthTest);
}

Pass& Pass::use(ImageId image, Access access, bool discard) {
    std::vector<Use>& uses = m_graph->m_recording.passes[m_index].uses;
    uses.push_back({image.index, 0, m_graph->desc(image).mips, access, 0, discard});
    m_declaredUses = uses.size();
    return *this;
}

Pass& Pass::use(BufferId buffer, Access access) {
    std::vector<Use>& uses = m_graph->m_recording.passes[m_index].uses;
    uses.push_back({buffer.index, 0, 1, access, 0, false});
    m_declaredUses = uses.size();
    return *this;
}

Pass& Pass::keep() {
    m_graph->m_recording.passes[m_index].keep = true;
    return *this;
}

Pass& Pass::constants(const void* data, uint32_t bytes) {
    assert(bytes <= 128);
    const auto* first = static_cast<const std::byte*>(data);
    m_constants.assign(first, first + bytes);
    return *this;
}

void Pass::dispatch(uint32_t x, uint32_t y, uint32_t z) {
    m_work = Work::dispatch;
    m_size[0] = x;
    m_size[1] = y;
    m_size[2] = z;
}

void Pass::draw(uint32_t vertices, uint32_t instances) {
    m_work = Work::draw;
    m_size[0] = vertices;
    m_size[1] = instances;
}

void Pass::record(Record record) {
    m_work = Work::record;
    m_record = std::move(record);
}

void Graph::begin(const Timings* timings) {
    m_timings = timings;
    m_recording.resources.clear();
    m_recording.passes.clear();
    m_passes.clear();
    m_handles.clear();
    m_uploads.clear();
    m_histories.clear();
    m_onRecorded.clear();
    m_prefix.clear();
}

const Timings& Graph::timings() const {
    static const Timings kNone;
    return m_timings ? *m_timings : kNone;
}

uint32_t Graph::add(Resource resource, Handles handles) {
    m_recording.resources.push_back(std::move(resource));
    m_handles.push_back(handles);
    return uint32_t(m_recording.resources.size() - 1);
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
    const uint64_t offset = m_uploads.size();
    const auto* first = static_cast<const std::byte*>(data);
    m_uploads.insert(m_uploads.end(), first, first + bytes);
    return {add({.name = std::move(name), .origin = Origin::upload, .isBuffer = true, .bytes = bytes, .uploadOffset = offset})};
}

ImageId Graph::import(std::string name, const External& external) {
    State state;
    state.layout = external.layout;
    state.writeStages = external.stages;
    state.writeAccess = external.layout == VK_IMAGE_LAYOUT_UNDEFINED ? 0 : VK_ACCESS_2_MEMORY_WRITE_BIT;
    return {add({.name = std::move(name),
                    .origin = Origin::imported,
                    .desc = external.desc,
                    .initial = {state},
                    .finalLayout = external.layoutAfter,
                    .output = true},
        {external.image, external.view, {}})};
}

BufferId Graph::import(std::string name, const gpu::Buffer& buffer, Shared shared) {
    const bool written = shared == Shared::written;
    const BufferId id = import(std::move(name), ExternalBuffer{buffer.handle(), 0, buffer.bytes()});
    m_recording.resources[id.index].output = written;
    if (!written) m_recording.resources[id.index].initial.assign(1, State{});
    return id;
}

BufferId Graph::import(std::string name, const ExternalBuffer& buffer) {
    State state;
    state.writeStages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    state.writeAccess = VK_ACCESS_2_MEMORY_WRITE_BIT;
    return {add({.name = std::move(name), .origin = Origin::imported, .isBuffer = true, .bytes = buffer.bytes, .initial = {state}},
        {VK_NULL_HANDLE, VK_NULL_HANDLE, buffer})};
}

Graph::HistoryPair Graph::history(std::string name, gpu::ImageDesc desc, History& history, bool discard) {
    desc.usage |=
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    const uint32_t write = history.m_current, read = 1 - write;
    const auto side = [&](uint32_t which, std::string of, bool output) {
        const gpu::Image& image = history.m_images[which];
        std::vector<State> states = image && image.desc() == desc ? history.m_states[which] : std::vector<State>(desc.mips);
        return ImageId{
            add({.name = std::move(of), .origin = Origin::history, .desc = desc, .initial = std::move(states), .output = output})};
    };
    const bool fits = history.m_images[read] && history.m_images[read].desc() == desc;
    HistoryPair pair{side(read, name + ".previous", false), side(write, name, true), history.m_valid && fits && !discard};
    m_histories.push_back({&history, pair.previous.index, pair.current.index});
    if (!pair.valid) {
        const ImageId previous = pair.previous;
        pass(name + ".clear").use(previous, Access::transferWrite, true).record([previous](const PassContext& c) {
            const VkClearColorValue zero{};
            const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0, 1};
            c.device.vk().CmdClearColorImage(c.cmd, c.image(previous), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &zero, 1, &range);
        });
    }
    return pair;
}

Pass& Graph::pass(std::string name, gpu::Program& program) {
    Pass& result = pass(std::move(name));
    result.m_program = &program;
    return result;
}

Pass& Graph::pass(std::string name) {
    m_recording.passes.push_back({m_prefix + name, {}, false});
    Pass& result = m_passes.emplace_back();
    result.m_graph = this;
    result.m_index = uint32_t(m_passes.size() - 1);
    return result;
}

void Graph::output(ImageId image) { m_recording.resources[image.index].output = true; }

std::vector<Graph::Written> Graph::written() const {
    std::vector<Written> result;
    for (const Pass& pass : m_passes) {
        const PassDesc& desc = m_recording.passes[pass.m_index];
        for (size_t i = 0; i < pass.m_declaredUses; ++i)
            if (info(desc.uses[i].access).writes && !m_recording.resources[desc.uses[i].resource].isBuffer)
                result.push_back({desc.name, {desc.uses[i].resource}});
        for (const Pass::Bound& bound : pass.m_bound)
            if (bound.writes && !bound.isBuffer) result.push_back({desc.name, {bound.resource}});
    }
    return result;
}

// A pass against its shaders: as many bindings as reads and writes, each of the kind that was given.
bool Graph::check(const Pass& pass) const {
    const std::string& name = m_recording.passes[pass.m_index].name;
    const auto fail = [&](const std::string& what) {
        m_device.log(gpu::Severity::error, fmt::format("graph: pass '{}': {}", name, what));
        return false;
    };
    if (pass.m_work == Pass::Work::none) return fail("neither dispatch, draw nor record was called");
    if (!pass.m_program)
        return pass.m_bound.empty() && pass.m_work == Pass::Work::record ? true : fail("has no program to read, write or dispatch with");
    if (!*pass.m_program) return fail("its program was never made");
    size_t count = 0;
    for (const gpu::Binding& binding : pass.m_program->bindings()) {
        if (binding.set != 0) continue;
        if (count >= pass.m_bound.size())
            return fail(fmt::format("{} declares '{}' as binding {}, but only {} resources were given", pass.m_program->name(),
                binding.name, binding.binding, pass.m_bound.size()));
        const Pass::Bound& bound = pass.m_bound[count++];
        const std::string& resource = m_recording.resources[bound.resource].name;
        const bool wantsImage = binding.kind == gpu::BindingKind::sampledImage || binding.kind == gpu::BindingKind::storageImage;
        if (wantsImage == bound.isBuffer)
            return fail(fmt::format("'{}' is {}, binding '{}' wants {}", resource, bound.isBuffer ? "a buffer" : "an image", binding.name,
                wantsImage ? "an image" : "a buffer"));
        if (bound.writes != binding.writes)
            return fail(fmt::format("'{}' is given as {}, the shader {} '{}'", resource, bound.writes ? "written" : "read",
                binding.writes ? "writes" : "only reads", binding.name));
    }
    if (count != pass.m_bound.size())
        return fail(fmt::format("{} resources were given, {} declares {}", pass.m_bound.size(), pass.m_program->name(), count));
    if (pass.m_program->pushConstantBytes() > pass.m_constants.size() && pass.m_work != Pass::Work::record)
        return fail(fmt::format("{} wants {} bytes of constants, {} were given", pass.m_program->name(),
            pass.m_program->pushConstantBytes(), pass.m_constants.size()));
    return true;
}

bool Graph::resolve() {
    for (Pass& pass : m_passes) {
        if (pass.m_program) pass.m_program->refresh();
        if (!check(pass)) return false;
        std::vector<Use>& uses = m_recording.passes[pass.m_index].uses;
        uses.resize(pass.m_declaredUses);
        if (!pass.m_program) continue;
        size_t next = 0;
        for (const gpu::Binding& binding : pass.m_program->bindings()) {
            if (binding.set != 0) continue;
            const Pass::Bound& bound = pass.m_bound[next++];
            const bool all = bound.mip == ~0u;
            const uint32_t mips = bound.isBuffer || !all ? 1 : m_recording.resources[bound.resource].desc.mips;
            uses.push_back({bound.resource, bound.isBuffer || all ? 0 : bound.mip, mips, accessOf(binding),
                pipelineStages(pass.m_program->stagesOf(binding)), false});
        }
    }
    return true;
}

}  // namespace obscura::graph
