// The host's door: adopts a device, imports a frame's images into a graph of its own, runs the same passes as the sample.
#include <cstring>
#include <optional>
#include <string>

#include "ao/library.h"

namespace obscura::ao {

struct Context {
    std::unique_ptr<gpu::Device> device;
    gpu::ShaderLibrary shaders;
    std::unique_ptr<graph::Graph> graph;
    std::unique_ptr<Library> library;
    std::vector<gpu::Image> outputs;  // a ring, so that the host may still read last frame's
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

void say(Context& context, const std::string& line) { context.device->log(gpu::Severity::error, "obscura: " + line); }

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

gpu::Status nextOutput(Context& context, VkExtent2D size, const gpu::Image*& out) {
    context.outputs.resize(context.device->framesInFlight() + 1);
    gpu::Image& image = context.outputs[context.device->frame() % context.outputs.size()];
    const gpu::ImageDesc desc{VK_FORMAT_R16_SFLOAT, size.width, size.height, 1, 1,
                              VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    out = &image;
    return image && image.desc() == desc ? gpu::Status::ok : gpu::Image::create(*context.device, desc, "obscura output", image);
}

}  // namespace

Status create(const DeviceDesc& desc, Context** context) {
    if (!context) return Status::invalid;
    *context = nullptr;
    const auto refuse = [&](const char* field) {
        if (desc.log) desc.log(desc.logUser, Severity::error, (std::string("obscura: DeviceDesc::") + field + " is null").c_str());
        return Status::invalid;
    };
    if (!desc.instance) return refuse("instance");
    if (!desc.physicalDevice) return refuse("physicalDevice");
    if (!desc.device) return refuse("device");
    if (!desc.getInstanceProcAddr) return refuse("getInstanceProcAddr");

    gpu::AdoptedDevice adopted;
    adopted.instance = desc.instance;
    adopted.physicalDevice = desc.physicalDevice;
    adopted.device = desc.device;
    adopted.queueFamily = desc.queueFamily;
    adopted.getInstanceProcAddr = desc.getInstanceProcAddr;
    adopted.framesInFlight = desc.framesInFlight ? desc.framesInFlight : 1;
    adopted.allocator = desc.allocator;
    if (desc.log)
        adopted.log = [log = desc.log, user = desc.logUser](gpu::Severity severity, const char* line) { log(user, Severity(severity), line); };
    std::string error;
    auto made = std::make_unique<Context>();
    made->device = gpu::Device::adopt(adopted, error);
    if (!made->device) {
        if (desc.log) desc.log(desc.logUser, Severity::error, ("obscura: " + error).c_str());
        return Status::unsupported;
    }
    made->shaders.add(shaders());
    made->graph = std::make_unique<graph::Graph>(*made->device);
    made->library = std::make_unique<Library>(*made->device, made->shaders);
    *context = made.release();
    return setMethod(*context, methods()[methods().size() > 1 ? 1 : 0]->id, {});
}

void destroy(Context* context) {
    if (!context) return;
    context->outputs.clear();
    context->library.reset();
    context->graph.reset();
    delete context;
}

Status setMethod(Context* context, const char* id, const MethodSettings& settings) {
    if (!context) return Status::invalid;
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
    for (const Setting& setting : settings.settings) {
        if (setting.id && values.set(setting.id, setting.value)) continue;
        std::string known;
        for (const Parameter& parameter : info->parameters) known += std::string(known.empty() ? "" : ", ") + parameter.id;
        say(*context, std::string(info->id) + " has no parameter '" + (setting.id ? setting.id : "(null)") + "'; it has " + known);
        return Status::invalid;
    }
    if (!(settings.falloff.length > 0.0f) || (settings.falloff.kind == FalloffKind::ramp && !(settings.falloff.end > settings.falloff.length))) {
        say(*context, "MethodSettings::falloff needs a length above zero (and, for ramp, an end above it)");
        return Status::invalid;
    }
    if (!context->library->prepare(*info)) return Status::shaderError;
    context->values = std::move(values);
    context->falloff = settings.falloff;
    return Status::ok;
}

Output record(Context* context, VkCommandBuffer cmd, const Frame& frame) {
    Output output;
    if (!context) return output;
    if (!cmd) return say(*context, "the command buffer is null"), output;
    if (!complete(frame.depth)) return say(*context, "Frame::depth lacks its image, view, format or layout"), output;
    const bool hasNormals = frame.normals.image || frame.normals.view;
    if (hasNormals && !complete(frame.normals)) return say(*context, "Frame::normals lacks its image, view, format or layout"), output;
    const bool hasMotion = frame.motion.image || frame.motion.view;
    if (hasMotion && !complete(frame.motion)) return say(*context, "Frame::motion lacks its image, view, format or layout"), output;
    const DepthLayers& layers = frame.layers;
    const bool hasThickness = layers.thickness.image || layers.thickness.view, hasSecond = layers.second.image || layers.second.view;
    if (hasThickness && !complete(layers.thickness)) return say(*context, "Frame::layers.thickness lacks its image, view, format or layout"), output;
    if (hasSecond && !complete(layers.second)) return say(*context, "Frame::layers.second lacks its image, view, format or layout"), output;
    if (hasSecond && !hasThickness) return say(*context, "Frame::layers.second is of no use without Frame::layers.thickness"), output;
    const auto isSize = [&](uint32_t side) {
        return layers.secondSize.width == (frame.size.width + side - 1) / side && layers.secondSize.height == (frame.size.height + side - 1) / side;
    };
    if (hasSecond && !isSize(1) && !isSize(2)) return say(*context, "Frame::layers.secondSize is neither Frame::size nor half of it"), output;
    shared::View view;
    const char* reason = nullptr;
    if (viewOf(frame, view, reason) != Status::ok) return say(*context, reason), output;

    shared::Volume volume;
    if (frame.volume.buffer && volumeOf(frame.volume, volume, reason) != Status::ok) return say(*context, reason), output;

    gpu::Device& device = *context->device;
    device.nextFrame();
    graph::Graph& graph = *context->graph;
    graph.begin();
    const VkExtent2D visible{view.visible.x, view.visible.y};
    const gpu::Image* target = nullptr;
    const gpu::Status made = nextOutput(*context, visible, target);
    if (made != gpu::Status::ok) return output.status = statusOf(made), output;

    Sources sources;
    sources.depth = importView(graph, "depth", frame.depth, frame.size);
    if (hasNormals) sources.normals = importView(graph, "normals", frame.normals, frame.size);
    if (hasMotion) sources.motion = importView(graph, "motion", frame.motion, frame.size);
    if (hasThickness) sources.layers.thickness = importView(graph, "thickness", layers.thickness, frame.size);
    if (hasSecond) sources.layers.second = importView(graph, "second layer", layers.second, layers.secondSize);
    if (frame.cut) context->library->reset();
    if (const Volume& v = frame.volume; v.buffer)
        sources.volume = graph.import("volume bits", {v.buffer, v.offset, v.structure == VolumeStructure::dense ? uint64_t(v.cells) * v.cells * v.cells / 8 : v.bytes});
    const graph::ImageId visibility = context->library->add(graph, frame, sources, context->falloff, *context->values);
    if (!visibility) return output.status = Status::shaderError, output;

    graph::External external;
    external.image = target->handle();
    external.view = target->view();
    external.desc = target->desc();
    external.layoutAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const graph::ImageId result = graph.import("output", external);
    graph.pass("output").use(visibility, graph::Access::transferRead).use(result, graph::Access::transferWrite, true)
        .record([visibility, result, visible](const graph::PassContext& c) {
            const VkImageCopy region{{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {visible.width, visible.height, 1}};
            c.device.vk().CmdCopyImage(c.cmd, c.image(visibility), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, c.image(result),
                                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        });
    output.status = statusOf(graph.execute(cmd));
    if (output.status != Status::ok) return output;
    output.image = target->handle();
    output.view = target->view();
    output.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return output;
}

uint64_t memoryUse(const Context* context) { return context ? context->device->memoryUse() : 0; }

List<PassTime> timings(Context* context) {
    if (!context) return {};
    Context& own = *context;  // the list lives in the context: the graph's moves on with the next record()
    own.timedNames.clear();
    own.timed.clear();
    for (const graph::PassTime& pass : own.graph->timings().passes) own.timedNames.push_back(pass.name);
    for (size_t i = 0; i < own.timedNames.size(); ++i) own.timed.push_back({own.timedNames[i].c_str(), own.graph->timings().passes[i].milliseconds});
    return {own.timed.data(), own.timed.size()};
}

}  // namespace obscura::ao
