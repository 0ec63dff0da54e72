// Declaring a frame: resources, passes, and turning them into a plan with images behind it.
#include "graph/graph.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include <fmt/format.h>

#include "graph/physical.h"

namespace obscura::graph {
namespace {

constexpr uint64_t kUploadChunk = 256 << 10;  // bytes
constexpr uint64_t kUploadAlignment = 256;    // the largest minimum any Vulkan device asks for
constexpr uint64_t kForgetAfter = 16;         // frames a pooled image may lie unused
constexpr VkBufferUsageFlags kUploadUsage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
constexpr VkBufferUsageFlags kBufferUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                            VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

}  // namespace

// ---- Pass -----------------------------------------------------------------------------------------------------------

Pass& Pass::read(ImageId image, Sampling sampling) { return readMip(image, ~0u, sampling); }
Pass& Pass::readMip(ImageId image, uint32_t mip, Sampling sampling) { m_bound.push_back({false, image.index, mip, sampling, false}); return *this; }
Pass& Pass::read(BufferId buffer) { m_bound.push_back({true, buffer.index, 0, Sampling::nearest, false}); return *this; }
Pass& Pass::write(ImageId image) { return writeMip(image, 0); }
Pass& Pass::writeMip(ImageId image, uint32_t mip) { m_bound.push_back({false, image.index, mip, Sampling::nearest, true}); return *this; }
Pass& Pass::write(BufferId buffer) { m_bound.push_back({true, buffer.index, 0, Sampling::nearest, true}); return *this; }

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
    const gpu::ImageDesc& desc = m_graph->m_recording.resources[image.index].desc;
    m_graph->m_recording.passes[m_index].uses.push_back({image.index, 0, desc.mips, access, 0, discard});
    return *this;
}

Pass& Pass::use(BufferId buffer, Access access) {
    m_graph->m_recording.passes[m_index].uses.push_back({buffer.index, 0, 1, access, 0, false});
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
    m_size[0] = x; m_size[1] = y; m_size[2] = z;
}

void Pass::draw(uint32_t vertices, uint32_t instances) {
    m_work = Work::draw;
    m_size[0] = vertices; m_size[1] = instances;
}

void Pass::record(Record record) {
    m_work = Work::record;
    m_record = std::move(record);
}

// ---- Graph ----------------------------------------------------------------------------------------------------------

Graph::Graph(gpu::Device& device, bool rehearsal) : m_device(device), m_rehearsal(rehearsal) {
    for (uint32_t i = 0; i < device.framesInFlight(); ++i) m_frames.push_back(std::make_unique<Frame>());
}

Graph::~Graph() {
    for (auto& frame : m_frames) {
        for (VkDescriptorPool pool : frame->pools) m_device.release(VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool);
        m_device.release(VK_OBJECT_TYPE_QUERY_POOL, frame->queries);
        m_device.release(VK_OBJECT_TYPE_EVENT, frame->executed);
    }
}

void Graph::begin() {
    m_recording = {};
    m_prefix.clear();
    m_passes.clear();
    m_physical.clear();
    m_histories.clear();
    for (PoolBuffer& buffer : m_buffers) buffer.taken = false;
    std::erase_if(m_buffers, [&](const PoolBuffer& b) { return b.lastUsed + kForgetAfter < m_device.frame(); });

    m_frame = m_frames[m_device.frame() % m_frames.size()].get();
    collectTimings(*m_frame);
    m_frame->number = m_device.frame();
    m_frame->pool = 0;
    for (VkDescriptorPool pool : m_frame->pools) m_device.vk().ResetDescriptorPool(m_device.handle(), pool, 0);
    for (Frame::Upload& upload : m_frame->uploads) upload.used = 0;
}

uint32_t Graph::add(Resource resource) {
    m_recording.resources.push_back(std::move(resource));
    m_physical.emplace_back();
    return uint32_t(m_recording.resources.size() - 1);
}

ImageId Graph::image(std::string name, gpu::ImageDesc desc) {
    assert(desc.format != VK_FORMAT_UNDEFINED && desc.width > 0 && desc.height > 0);
    return {add({std::move(name), Kind::transient, desc})};
}

ImageId Graph::import(std::string name, const External& external) {
    Resource resource{std::move(name), Kind::imported, external.desc};
    State state;
    state.layout = external.layout;
    state.writeStages = external.stages;
    state.writeAccess = external.layout == VK_IMAGE_LAYOUT_UNDEFINED ? 0 : VK_ACCESS_2_MEMORY_WRITE_BIT;
    resource.initial.assign(1, state);
    resource.finalLayout = external.layoutAfter;
    resource.output = true;
    const uint32_t index = add(std::move(resource));
    m_physical[index].image = external.image;
    m_physical[index].view = external.view;
    return {index};
}

BufferId Graph::import(std::string name, const gpu::Buffer& buffer, Shared shared) {
    Resource resource{std::move(name), Kind::buffer};
    State state;
    if (shared == Shared::written) {
        state.writeStages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        state.writeAccess = VK_ACCESS_2_MEMORY_WRITE_BIT;
        resource.output = true;
    }
    resource.initial.assign(1, state);
    const uint32_t index = add(std::move(resource));
    m_physical[index].buffer = buffer.handle();
    m_physical[index].bytes = buffer.bytes();
    return {index};
}

BufferId Graph::import(std::string name, const ExternalBuffer& buffer) {
    Resource resource{std::move(name), Kind::buffer};
    State state;
    state.writeStages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    state.writeAccess = VK_ACCESS_2_MEMORY_WRITE_BIT;
    resource.initial.assign(1, state);
    const uint32_t index = add(std::move(resource));
    m_physical[index].buffer = buffer.buffer;
    m_physical[index].offset = buffer.offset;
    m_physical[index].bytes = buffer.bytes;
    return {index};
}

BufferId Graph::upload(std::string name, const void* data, size_t bytes) {
    Frame::Upload* chunk = nullptr;
    for (Frame::Upload& upload : m_frame->uploads)
        if (upload.used + bytes <= upload.bytes) { chunk = &upload; break; }
    const uint32_t index = add({std::move(name), Kind::buffer, {}, std::vector<State>(1)});
    if (!chunk) {
        Frame::Upload fresh;
        fresh.bytes = std::max<uint64_t>(kUploadChunk, bytes);
        if (m_rehearsal)
            m_rehearsed += m_frames.size() * gpu::Buffer::bytesOf(m_device, fresh.bytes, kUploadUsage, gpu::Memory::upload);
        else if (gpu::Buffer::create(m_device, fresh.bytes, kUploadUsage, gpu::Memory::upload, "graph upload", fresh.buffer) != gpu::Status::ok)
            return {index};  // execute() fails: the buffer is null
        m_frame->uploads.push_back(std::move(fresh));
        chunk = &m_frame->uploads.back();
    }
    if (!m_rehearsal) std::memcpy(chunk->buffer.mapped() + chunk->used, data, bytes);
    m_physical[index].buffer = chunk->buffer.handle();
    m_physical[index].offset = chunk->used;
    m_physical[index].bytes = bytes;
    chunk->used += (bytes + kUploadAlignment - 1) / kUploadAlignment * kUploadAlignment;
    return {index};
}

BufferId Graph::buffer(std::string name, uint64_t bytes) {
    if (m_rehearsal) {
        m_rehearsed += gpu::Buffer::bytesOf(m_device, bytes, kBufferUsage, gpu::Memory::device);
        return {add({std::move(name), Kind::buffer, {}, std::vector<State>(1)})};
    }
    auto found = std::find_if(m_buffers.begin(), m_buffers.end(), [&](const PoolBuffer& b) { return !b.taken && b.buffer.bytes() == bytes; });
    if (found == m_buffers.end()) {
        PoolBuffer fresh;
        gpu::Buffer::create(m_device, bytes, kBufferUsage, gpu::Memory::device, name.c_str(), fresh.buffer);
        found = m_buffers.insert(m_buffers.end(), std::move(fresh));
    }
    found->taken = true;
    found->lastUsed = m_device.frame();
    const uint32_t index = add({std::move(name), Kind::buffer, {}, std::vector<State>(1, found->state)});
    m_physical[index].buffer = found->buffer.handle();
    m_physical[index].bytes = bytes;
    m_physical[index].poolBuffer = int(found - m_buffers.begin());
    return {index};
}

Graph::HistoryPair Graph::history(std::string name, gpu::ImageDesc desc, History& history) {
    desc.usage |= VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (m_rehearsal) {
        m_rehearsed += 2 * gpu::Image::bytesOf(m_device, desc);
        const ImageId previous{add({name + ".previous", Kind::imported, desc, std::vector<State>(desc.mips)})};
        const ImageId current{add({name, Kind::imported, desc, std::vector<State>(desc.mips)})};
        output(current);
        return {previous, current, false};
    }
    for (int i = 0; i < 2; ++i) {
        if (history.m_images[i] && history.m_images[i].desc() == desc) continue;
        history.m_states[i].assign(desc.mips, State{});
        history.m_valid = false;
        if (gpu::Image::create(m_device, desc, name.c_str(), history.m_images[i]) != gpu::Status::ok) break;  // execute() then fails
    }
    HistoryPair pair{{}, {}, history.m_valid};
    for (int i = 0; i < 2; ++i) {
        const uint32_t which = i == 0 ? 1 - history.m_current : history.m_current;
        const uint32_t index = add({name + (i == 0 ? ".previous" : ""), Kind::imported, desc, history.m_states[which]});
        m_recording.resources[index].output = i == 1;
        m_physical[index].image = history.m_images[which].handle();
        m_physical[index].view = history.m_images[which].view();
        m_physical[index].owned = &history.m_images[which];
        (i == 0 ? pair.previous : pair.current) = {index};
    }
    m_histories.push_back({&history, pair.previous.index, pair.current.index});
    if (!history.m_valid) {
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
const gpu::ImageDesc& Graph::desc(ImageId id) const { return m_recording.resources[id.index].desc; }
const std::string& Graph::name(ImageId id) const { return m_recording.resources[id.index].name; }

// A pass against its shaders: as many bindings as reads and writes, each of the kind that was given.
bool Graph::check(const Pass& pass) {
    const std::string& name = m_recording.passes[pass.m_index].name;
    const auto fail = [&](const std::string& what) {
        m_device.log(gpu::Severity::error, fmt::format("graph: pass '{}': {}", name, what));
        return false;
    };
    if (pass.m_work == Pass::Work::none) return fail("neither dispatch, draw nor record was called");
    if (!pass.m_program) return pass.m_bound.empty() && pass.m_work == Pass::Work::record ? true : fail("has no program to read, write or dispatch with");
    if (!*pass.m_program) return fail("its program was never made");
    size_t count = 0;
    for (const gpu::Binding& binding : pass.m_program->bindings()) {
        if (binding.set != 0) continue;
        if (count >= pass.m_bound.size())
            return fail(fmt::format("{} declares '{}' as binding {}, but only {} resources were given", pass.m_program->name(), binding.name,
                                    binding.binding, pass.m_bound.size()));
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
        return fail(fmt::format("{} wants {} bytes of constants, {} were given", pass.m_program->name(), pass.m_program->pushConstantBytes(),
                                pass.m_constants.size()));
    return true;
}

// What each pass binds, as its shader says how.
bool Graph::bindings() {
    for (Pass& pass : m_passes) {
        if (pass.m_program) pass.m_program->refresh();
        if (!check(pass)) return false;
        if (!pass.m_program) continue;
        size_t next = 0;
        for (const gpu::Binding& binding : pass.m_program->bindings()) {
            if (binding.set != 0) continue;
            const Pass::Bound& bound = pass.m_bound[next++];
            const bool all = bound.mip == ~0u;
            const uint32_t mips = bound.isBuffer || !all ? 1 : m_recording.resources[bound.resource].desc.mips;
            m_recording.passes[pass.m_index].uses.push_back({bound.resource, bound.isBuffer || all ? 0 : bound.mip, mips, accessOf(binding),
                                                             pipelineStages(pass.m_program->stagesOf(binding)), false});
        }
    }
    return true;
}

gpu::Status Graph::realize() {
    if (!bindings()) return gpu::Status::invalid;
    for (uint32_t i = 0; i < m_recording.resources.size(); ++i) {
        const Kind kind = m_recording.resources[i].kind;
        if (kind == Kind::buffer ? !m_physical[i].buffer : kind == Kind::imported && !m_physical[i].image)
            return m_device.failure() == gpu::Status::ok ? gpu::Status::invalid : m_device.failure();  // whoever failed to make it has said so
    }
    // Pool images that nobody wanted for a while go; the rest lend their states to the plan.
    for (size_t i = m_pool.size(); i-- > 0;) {
        if (m_pool[i].lastUsed + kForgetAfter >= m_device.frame()) continue;
        m_pool.erase(m_pool.begin() + ptrdiff_t(i));
        m_plan.slots.erase(m_plan.slots.begin() + ptrdiff_t(i));
    }
    m_slotsBefore = m_plan.slots;
    Plan next = plan(m_recording, m_plan.slots);
    for (const std::string& problem : next.problems) m_device.log(gpu::Severity::error, "graph: " + problem);
    if (!next.problems.empty()) return gpu::Status::invalid;
    m_pool.reserve(next.slots.size());
    m_slotsBefore.reserve(next.slots.size());  // so that both grow or neither
    while (m_pool.size() < next.slots.size()) {
        PoolImage fresh;
        fresh.lastUsed = m_device.frame();
        const Slot& slot = next.slots[m_pool.size()];
        if (const gpu::Status status = gpu::Image::create(m_device, slot.desc, "graph image", fresh.image); status != gpu::Status::ok) return status;
        m_slotsBefore.push_back({slot.desc, slot.ordinal, std::vector<State>(slot.desc.mips)});
        m_pool.push_back(std::move(fresh));
    }
    m_plan = std::move(next);

    for (uint32_t i = 0; i < m_recording.resources.size(); ++i) {
        Physical& physical = m_physical[i];
        if (m_plan.slotOf[i] < 0) continue;
        PoolImage& pooled = m_pool[size_t(m_plan.slotOf[i])];
        pooled.lastUsed = m_device.frame();
        physical.image = pooled.image.handle();
        physical.view = pooled.image.view();
        physical.owned = &pooled.image;
    }
    return gpu::Status::ok;
}

}  // namespace obscura::graph
