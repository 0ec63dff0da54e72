// The host's door: adopts a device, imports a frame's images into a graph of its own, runs the same passes as the sample.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "ao/formats.h"
#include "ao/library.h"

namespace obscura::ao {

// Where lines go, also when there is no memory left to write one with.
struct HostLog {
    void (*log)(void* user, Severity severity, const char* line) = nullptr;
    void* user = nullptr;
    void operator()(const char* line) const {
        if (log) log(user, Severity::error, line);
        else std::fprintf(stderr, "%s\n", line);
    }
};

struct Context {
    HostLog log;
    VisibilityFormat format = VisibilityFormat::r16f;
    std::unique_ptr<gpu::Device> device;
    gpu::ShaderLibrary shaders;
    std::unique_ptr<graph::Graph> graph;
    std::unique_ptr<Library> library;
    gpu::Program narrow;              // r16f to r8, where that is asked for
    std::vector<gpu::Image> outputs;  // a ring, so that the host may still read last frame's
    bool failed = false;              // the last record(), after its frame had begun
    uint64_t methodBytes = 0;         // device memory that methods took when they were made
    std::optional<Values> values;
    Falloff falloff;
    std::vector<std::string> timedNames;
    std::vector<PassTime> timed;
};

namespace {

Status statusOf(gpu::Status status) {
    switch (status) {
        case gpu::Status::ok: return Status::ok;
        case gpu::Status::unsupported: return Status::unsupported;
        case gpu::Status::outOfMemory: return Status::outOfMemory;
        case gpu::Status::deviceLost: return Status::deviceLost;
        case gpu::Status::shaderError: return Status::shaderError;
        default: return Status::invalid;
    }
}

void say(const Context& context, const std::string& line) { context.log(("obscura: " + line).c_str()); }

// No exception crosses the door. Nothing here throws but the standard library, for want of memory.
template <class Work>
Status guarded(const HostLog& log, Work work) noexcept {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        log("obscura: out of host memory");
        return Status::outOfMemory;
    } catch (...) {
        log("obscura: an exception that nothing here throws; did a callback?");
        return Status::invalid;
    }
}

// Null image, view or layout with a format, or the other way round, is a mistake worth naming.
bool complete(const ImageView& v) { return v.image && v.view && v.format != VK_FORMAT_UNDEFINED && v.layout != VK_IMAGE_LAYOUT_UNDEFINED; }

graph::ImageId importView(graph::Graph& graph, const char* name, const ImageView& v, VkExtent2D size) {
    graph::External external;
    external.image = v.image;
    external.view = v.view;
    external.desc = {v.format, size.width, size.height};
    external.layout = v.layout;
    external.layoutAfter = v.layout;
    return graph.import(name, external);
}

// What a frame brings. In a rehearsal the images need not be there yet: one with a format counts.
struct Given {
    bool rehearsal = false, normals = false, motion = false, thickness = false, second = false;
};

Given givenBy(const Frame& frame, bool rehearsal) {
    const auto is = [&](const ImageView& v) { return rehearsal ? v.format != VK_FORMAT_UNDEFINED : v.image || v.view; };
    return {rehearsal, is(frame.normals), is(frame.motion), is(frame.layers.thickness), is(frame.layers.second)};
}

Role depthRole(const Frame& frame) { return frame.depthKind == DepthKind::linear ? Role::linearDepth : Role::deviceDepth; }
Role normalsRole(const Frame& frame) {
    return frame.normalEncoding == NormalEncoding::signedFloat    ? Role::signedNormals
           : frame.normalEncoding == NormalEncoding::unsignedHalf ? Role::unsignedNormals
                                                                  : Role::packedNormals;
}

// Whether the frame can be recorded; a line that names the field if not.
Status sensible(const Context& context, const Frame& frame, const Given& given, shared::View& view) {
    const gpu::Device& device = *context.device;
    const DepthLayers& layers = frame.layers;
    const auto refuse = [&](const std::string& line, Status status = Status::invalid) { return say(context, line), status; };
    const char* reason = nullptr;
    if (viewOf(frame, view, reason) != Status::ok) return refuse(reason);
    const auto finite = [](std::span<const float> list) { return std::all_of(list.begin(), list.end(), [](float value) { return std::isfinite(value); }); };
    if (!finite(frame.eyeFromWorld)) return refuse("Frame::eyeFromWorld holds a value that is not finite");
    if (!finite(frame.motionScale)) return refuse("Frame::motionScale holds a value that is not finite");
    if (std::isnan(frame.skyDepth)) return refuse("Frame::skyDepth is no number");
    const uint32_t most = device.caps().maxImageSize;
    if (std::max(frame.size.width, frame.size.height) > most) return refuse("Frame::size: the device allows " + std::to_string(most) + " a side", Status::unsupported);
    if (given.second && !given.thickness) return refuse("Frame::layers.second is of no use without Frame::layers.thickness");
    const auto isSize = [&](uint32_t side) {
        return layers.secondSize.width == (frame.size.width + side - 1) / side && layers.secondSize.height == (frame.size.height + side - 1) / side;
    };
    if (given.second && !isSize(1) && !isSize(2)) return refuse("Frame::layers.secondSize is neither Frame::size nor half of it");
    const struct { const char* name; bool given; const ImageView& view; Role role; VkExtent2D size; } images[] = {
        {"depth", true, frame.depth, depthRole(frame), frame.size}, {"normals", given.normals, frame.normals, normalsRole(frame), frame.size},
        {"motion", given.motion, frame.motion, Role::motion, frame.size}, {"layers.thickness", given.thickness, layers.thickness, Role::thickness, frame.size},
        {"layers.second", given.second, layers.second, Role::second, layers.secondSize}};
    for (const auto& image : images) {
        if (!image.given) continue;
        const std::string field = std::string("Frame::") + image.name;
        if (!given.rehearsal && !complete(image.view)) return refuse(field + " lacks its image, view, format or layout");
        const VkFormat format = image.view.format;
        if (given.rehearsal && format == VK_FORMAT_UNDEFINED) continue;
        if (!fits(image.role, format)) return refuse(field + " has format " + std::to_string(format) + "; what fits is " + formatsOf(image.role));
        if (!device.formatSupports(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)) return refuse(field + ": the device cannot sample format " + std::to_string(format), Status::unsupported);
        if (given.rehearsal) continue;
        // An image does not say its size, but it cannot be smaller than its texels: one left from before a resize is told by that.
        VkMemoryRequirements needs;
        device.vk().GetImageMemoryRequirements(device.handle(), image.view.image, &needs);
        if (needs.size < uint64_t(image.size.width) * image.size.height * leastBytes(format))
            return refuse(field + " is smaller than " + std::to_string(image.size.width) + " x " + std::to_string(image.size.height));
    }
    shared::Volume volume;
    if (frame.volume.buffer && volumeOf(frame.volume, volume, reason) != Status::ok) return refuse(reason);
    return Status::ok;
}

graph::ImageId declare(Context& context, graph::Graph& graph, const Frame& frame, const Given& given) {
    Sources sources;
    sources.depth = importView(graph, "depth", frame.depth, frame.size);
    if (given.normals) sources.normals = importView(graph, "normals", frame.normals, frame.size);
    if (given.motion) sources.motion = importView(graph, "motion", frame.motion, frame.size);
    if (given.thickness) sources.layers.thickness = importView(graph, "thickness", frame.layers.thickness, frame.size);
    if (given.second) sources.layers.second = importView(graph, "second layer", frame.layers.second, frame.layers.secondSize);
    if (const Volume& v = frame.volume; v.buffer)
        sources.volume = graph.import("volume bits", {v.buffer, v.offset, v.structure == VolumeStructure::dense ? uint64_t(v.cells) * v.cells * v.cells / 8 : v.bytes});
    return context.library->add(graph, frame, sources, context.falloff, *context.values);
}

gpu::ImageDesc outputDesc(const Context& context, VkExtent2D size) {
    const bool narrow = context.format == VisibilityFormat::r8;
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    return {narrow ? VK_FORMAT_R8_UNORM : VK_FORMAT_R16_SFLOAT, size.width, size.height, 1, 1, narrow ? usage | VK_IMAGE_USAGE_STORAGE_BIT : usage};
}

gpu::Status nextOutput(Context& context, VkExtent2D size, const gpu::Image*& out) {
    gpu::Image& image = context.outputs[context.device->frame() % context.outputs.size()];
    const gpu::ImageDesc desc = outputDesc(context, size);
    out = &image;
    return image && image.desc() == desc ? gpu::Status::ok : gpu::Image::create(*context.device, desc, "obscura output", image);
}

// The one place where every method's visibility becomes what the host reads.
void deliver(Context& context, graph::Graph& graph, graph::ImageId visibility, const gpu::Image& target) {
    graph::External external;
    external.image = target.handle();
    external.view = target.view();
    external.desc = target.desc();
    external.layoutAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const graph::ImageId result = graph.import("output", external);
    const VkExtent3D size{target.desc().width, target.desc().height, 1};
    if (context.format == VisibilityFormat::r8) {
        graph.pass("output", context.narrow).read(visibility).write(result).dispatch(size.width, size.height);
        return;
    }
    graph.pass("output").use(visibility, graph::Access::transferRead).use(result, graph::Access::transferWrite, true)
        .record([visibility, result, size](const graph::PassContext& c) {
            const VkImageCopy region{{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, size};
            c.device.vk().CmdCopyImage(c.cmd, c.image(visibility), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, c.image(result),
                                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        });
}

Status make(const DeviceDesc& desc, const HostLog& log, Context** context) {
    const auto refuse = [&](const char* text) { return log((std::string("obscura: DeviceDesc::") + text).c_str()), Status::invalid; };
    if (!desc.instance) return refuse("instance is null");
    if (!desc.physicalDevice) return refuse("physicalDevice is null");
    if (!desc.device) return refuse("device is null");
    if (!desc.getInstanceProcAddr) return refuse("getInstanceProcAddr is null");
    if (!desc.memory.allocate != !desc.memory.free) return refuse("memory has one of its two functions alone");
    if (desc.format != VisibilityFormat::r16f && desc.format != VisibilityFormat::r8) return refuse("format is none there is");

    gpu::AdoptedDevice adopted;
    adopted.instance = desc.instance;
    adopted.physicalDevice = desc.physicalDevice;
    adopted.device = desc.device;
    adopted.queueFamily = desc.queueFamily;
    adopted.getInstanceProcAddr = desc.getInstanceProcAddr;
    adopted.framesInFlight = desc.framesInFlight ? desc.framesInFlight : 1;
    adopted.allocator = desc.allocator;
    if (const MemoryCallbacks memory = desc.memory; memory.allocate) {
        adopted.memory.allocate = [memory](const VkMemoryRequirements& needs, bool mapped, bool image, gpu::MemoryBlock& block) {
            MemoryBlock given;
            const VkResult result = memory.allocate(memory.user, needs, mapped, image, given);
            block = {given.memory, given.offset, needs.size, static_cast<std::byte*>(given.mapped), given.token};
            return result;
        };
        adopted.memory.free = [memory](const gpu::MemoryBlock& block) { memory.free(memory.user, {block.memory, block.offset, block.mapped, block.token}); };
    }
    if (desc.log)
        adopted.log = [log = desc.log, user = desc.logUser](gpu::Severity severity, const char* line) { log(user, Severity(severity), line); };
    std::string error;
    struct Destroy { void operator()(Context* made) const { destroy(made); } };
    std::unique_ptr<Context, Destroy> made(new Context);
    made->log = log;
    made->format = desc.format;
    gpu::Status why = gpu::Status::ok;
    made->device = gpu::Device::adopt(adopted, error, &why);
    if (!made->device) return log(("obscura: " + error).c_str()), statusOf(why);
    made->outputs.resize(made->device->framesInFlight() + 1);
    made->shaders.add(shaders());
    made->graph = std::make_unique<graph::Graph>(*made->device);
    made->library = std::make_unique<Library>(*made->device, made->shaders);
    if (!made->library->ready()) return statusOf(made->device->failure());
    if (desc.format == VisibilityFormat::r8)
        if (const gpu::Status status = gpu::Program::compute(*made->device, made->shaders, "ao/common/output_r8.comp", {}, made->narrow); status != gpu::Status::ok)
            return statusOf(status);
    const Status status = setMethod(made.get(), "hbao", {});
    if (status == Status::ok) *context = made.release();
    return status;
}

Status choose(Context* context, const char* id, const MethodSettings& settings) {
    const MethodInfo* info = findMethod(id);
    if (!info) {
        std::string known;
        for (const MethodInfo* method : methods()) known += std::string(known.empty() ? "" : ", ") + method->id;
        say(*context, std::string("there is no method '") + (id ? id : "(null)") + "'; there are " + known);
        return Status::invalid;
    }
    Values values(*info);
    const Preset* preset = nullptr;
    for (const Preset& candidate : info->presets)
        if (settings.preset && std::strcmp(candidate.id, settings.preset) == 0) preset = &candidate;
    if (!preset) {
        std::string known;
        for (const Preset& candidate : info->presets) known += std::string(known.empty() ? "" : ", ") + candidate.id;
        say(*context, std::string(info->id) + " has no preset '" + (settings.preset ? settings.preset : "(null)") + "'; it has " + known);
        return Status::invalid;
    }
    values.apply(*preset);
    if (settings.resolve) {
        const Preset* resolve = findResolvePreset(settings.resolve);
        if (!resolve) {
            std::string known;
            for (const Preset& candidate : resolvePresets()) known += std::string(known.empty() ? "" : ", ") + candidate.id;
            say(*context, std::string("there is no resolve preset '") + settings.resolve + "'; there are " + known);
            return Status::invalid;
        }
        values.resolve(*resolve);
    }
    if (settings.settings.count && !settings.settings.items) return say(*context, "MethodSettings::settings has a count and no items"), Status::invalid;
    for (const Setting& setting : settings.settings) {
        if (setting.id && values.set(setting.id, setting.value)) continue;
        std::string known;
        for (const Parameter& parameter : info->parameters) known += std::string(known.empty() ? "" : ", ") + parameter.id;
        say(*context, std::string(info->id) + " has no parameter '" + (setting.id ? setting.id : "(null)") + "'; it has " + known);
        return Status::invalid;
    }
    if (!(settings.falloff.length > 0.0f) || !std::isfinite(reach(settings.falloff)) || (settings.falloff.kind == FalloffKind::ramp && !(settings.falloff.end > settings.falloff.length))) {
        say(*context, "MethodSettings::falloff needs a finite length above zero (and, for ramp, an end above it)");
        return Status::invalid;
    }
    const uint64_t before = context->device->memoryUse();
    if (!context->library->prepare(values)) return statusOf(context->device->failure());
    context->methodBytes += context->device->memoryUse() - before;
    context->values = std::move(values);
    context->falloff = settings.falloff;
    return Status::ok;
}

}  // namespace

Status create(const DeviceDesc& desc, Context** context) noexcept {
    const HostLog log{desc.log, desc.logUser};
    if (!context) return log("obscura: create() was given no place for the context"), Status::invalid;
    *context = nullptr;
    return guarded(log, [&] { return make(desc, log, context); });
}

void destroy(Context* context) noexcept {
    if (!context) return;
    context->outputs.clear();
    context->narrow = {};
    context->library.reset();
    context->graph.reset();
    delete context;
}

Status setMethod(Context* context, const char* id, const MethodSettings& settings) noexcept {
    return context ? guarded(context->log, [&] { return choose(context, id, settings); }) : Status::invalid;
}

Output record(Context* context, VkCommandBuffer cmd, const Frame& frame) noexcept {
    Output output;
    if (!context) return output;
    output.status = guarded(context->log, [&] {
        if (!cmd) return say(*context, "the command buffer is null"), Status::invalid;
        const Given given = givenBy(frame, false);
        shared::View view;
        if (const Status status = sensible(*context, frame, given, view); status != Status::ok) return status;
        // A record() that failed used nothing of its frame: the next one takes its place.
        if (!std::exchange(context->failed, true)) context->device->nextFrame();
        graph::Graph& graph = *context->graph;
        graph.begin();
        const gpu::Image* target = nullptr;
        if (const gpu::Status made = nextOutput(*context, {view.visible.x, view.visible.y}, target); made != gpu::Status::ok) return statusOf(made);
        if (frame.cut) context->library->reset();
        const graph::ImageId visibility = declare(*context, graph, frame, given);
        if (!visibility) return context->library->reset(), statusOf(context->device->failure());
        deliver(*context, graph, visibility, *target);
        const Status status = statusOf(graph.execute(cmd));
        if (status != Status::ok) return context->library->reset(), status;  // what the frame was to leave behind is not there
        context->failed = false;
        output.image = target->handle();
        output.view = target->view();
        output.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        return Status::ok;
    });
    return output;
}

uint64_t memoryUse(const Context* context) noexcept { return context ? context->device->memoryUse() : 0; }

uint64_t memoryUse(Context* context, const Frame& frame) noexcept {
    uint64_t bytes = 0;
    if (!context) return bytes;
    guarded(context->log, [&] {
        const Given given = givenBy(frame, true);
        shared::View view;
        if (const Status status = sensible(*context, frame, given, view); status != Status::ok) return status;
        graph::Graph rehearsal(*context->device, true);
        rehearsal.begin();
        const graph::ImageId visibility = declare(*context, rehearsal, frame, given);
        if (!visibility) return Status::shaderError;
        rehearsal.output(visibility);
        if (context->format == VisibilityFormat::r16f) rehearsal.pass("output").use(visibility, graph::Access::transferRead).keep().record({});
        const uint64_t passes = rehearsal.rehearsedBytes();
        const gpu::ImageDesc output = outputDesc(*context, {view.visible.x, view.visible.y});
        if (passes) bytes = context->methodBytes + passes + context->outputs.size() * gpu::Image::bytesOf(*context->device, output);
        return Status::ok;
    });
    return bytes;
}

List<PassTime> timings(Context* context) noexcept {
    if (!context) return {};
    Context& own = *context;  // the list lives in the context: the graph's moves on with the next record()
    guarded(own.log, [&] {
        own.timedNames.clear();
        own.timed.clear();
        for (const graph::PassTime& pass : own.graph->timings().passes) own.timedNames.push_back(pass.name);
        for (size_t i = 0; i < own.timedNames.size(); ++i) own.timed.push_back({own.timedNames[i].c_str(), own.graph->timings().passes[i].milliseconds});
        return Status::ok;
    });
    return {own.timed.data(), own.timed.size()};
}

}  // namespace obscura::ao
