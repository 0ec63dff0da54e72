// record() and what it tells: imports a frame's images into a graph, runs the same passes as the sample, hands out visibility.
#include "ao/context.h"

#include <algorithm>

#include "ao/common/constants.h"
#include "ao/frame_check.h"

namespace obscura::ao {

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

Status refuse(const Context& context, Status status, const std::string& line) {
    context.log(("obscura: " + line).c_str());
    return status;
}

namespace {

graph::ImageId importView(graph::Graph& graph, const char* name, const ImageView& v, VkExtent2D size) {
    graph::External external;
    external.image = v.image;
    external.view = v.view;
    external.desc = {v.format, size.width, size.height};
    external.layout = v.layout;
    external.layoutAfter = v.layout;
    external.mip = v.mip;
    external.layer = v.layer;
    return graph.import(name, external);
}

Library::Added declare(Context& context, graph::Graph& graph, const Frame& frame, bool forecast) {
    const GivenImages given = imagesOf(frame, forecast);
    Sources sources;
    bool made = true;
    const auto import = [&](const char* name, const ImageView& v, VkExtent2D size, Crop::Texel texel) {
        const graph::ImageId whole = importView(graph, name, v, extentOf(frame, size));
        const bool multisampled = v.samples > VK_SAMPLE_COUNT_1_BIT;
        if (frame.origin.x == 0 && frame.origin.y == 0 && !multisampled) return whole;
        const graph::ImageId part =
            context.crop.add(*context.device, context.shaders, graph, whole, {originOf(frame, size), size, 1, false, multisampled}, texel);
        made = made && part;
        return part;
    };
    const bool packed = frame.normalEncoding == NormalEncoding::octahedral32;
    using enum Crop::Texel;
    sources.depth = import("depth", frame.depth, frame.size, floats2);
    if (given.normals) sources.normals = import("normals", frame.normals, frame.size, packed ? integer : floats4);
    if (given.motion) sources.motion = import("motion", frame.motion, frame.size, floats2);
    if (given.thickness) sources.layers.thickness = import("thickness", frame.layers.thickness, frame.size, floats2);
    if (given.second) sources.layers.second = import("second layer", frame.layers.second, frame.layers.secondSize, floats2);
    if (!made) return {};
    if (const Volume& v = frame.volume; v.buffer)
        sources.volume = graph.import("volume bits",
            {v.buffer, v.offset, v.structure == VolumeStructure::dense ? uint64_t(v.levels) * v.cells * v.cells * v.cells / 8 : v.bytes});
    return context.library->add(graph, frame, sources, context.falloff, *context.values);
}

bool isDynamic(const Frame& frame) { return frame.maxSize.width > 0; }

VkExtent2D largestOf(VkExtent2D a, VkExtent2D b) { return {std::max(a.width, b.width), std::max(a.height, b.height)}; }

// Declares a frame. Within a Frame::maxSize its images are as large as those of the largest frame, which `capacity` keeps.
Library::Added declareWithin(Context& context, graph::Graph& graph, graph::Capacity& capacity, const Frame& frame, bool forecast) {
    const auto declared = [&] {
        graph.begin(nullptr, isDynamic(frame) ? &capacity : nullptr);
        return declare(context, graph, frame, forecast);
    };
    Library::Added added = declared();
    if (!added.visibility || graph.fits()) return added;
    Frame largest = frame;
    largest.size = frame.maxSize;
    const bool half = frame.layers.secondSize.width < frame.size.width || frame.layers.secondSize.height < frame.size.height;
    largest.layers.secondSize = half ? VkExtent2D{(largest.size.width + 1) / 2, (largest.size.height + 1) / 2} : largest.size;
    graph::Graph most(*context.device);  // not executed
    if (!declare(context, most, largest, forecast).visibility) return {};
    capacity.grow(most);
    capacity.grow(graph);
    return declared();
}

// The visible size of the largest frame.
VkExtent2D mostVisible(const Frame& frame, VkExtent2D visible) {
    const VkExtent2D twice{2 * frame.guard.width, 2 * frame.guard.height}, &most = frame.maxSize;
    if (!isDynamic(frame)) return visible;
    return largestOf(visible, {std::max(most.width, twice.width) - twice.width, std::max(most.height, twice.height) - twice.height});
}

constexpr VkImageUsageFlags kOutputUsage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

gpu::ImageDesc outputDesc(const Context& context, VkExtent2D size) {
    const bool r8 = context.format == VisibilityFormat::r8;
    return {r8 ? VK_FORMAT_R8_UNORM : VK_FORMAT_R16_SFLOAT, size.width, size.height, 1, 1,
        r8 ? kOutputUsage | VK_IMAGE_USAGE_STORAGE_BIT : kOutputUsage};
}

gpu::ImageDesc bentDesc(VkExtent2D size) { return {VK_FORMAT_R8G8B8A8_SNORM, size.width, size.height, 1, 1, kOutputUsage}; }

gpu::Status nextOf(Context& context, std::vector<gpu::Image>& ring, const gpu::ImageDesc& desc, const char* name, const gpu::Image*& out) {
    gpu::Image& image = ring[context.device->frame() % ring.size()];
    out = &image;
    return image && image.desc() == desc ? gpu::Status::ok : gpu::Image::create(*context.device, desc, name, image);
}

// The one place where every method's results become what the host reads. `target` may be null in a frame that is not executed.
void deliver(graph::Graph& graph, graph::ImageId drawn, VkExtent2D visible, const gpu::ImageDesc& desc, const gpu::Image* target,
    const char* name, gpu::Program* convert) {
    graph::External external;
    if (target) external.image = target->handle(), external.view = target->view();
    external.desc = desc;
    external.layoutAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const graph::ImageId result = graph.import(name, external);
    const VkExtent3D size{visible.width, visible.height, 1};
    if (convert) {
        graph.pass(name, *convert)
            .read(drawn)
            .write(result)
            .constants(shared::Whole{shared::sizeOf(size.width, size.height)})
            .dispatch(size.width, size.height);
        return;
    }
    graph.pass(name)
        .use(drawn, graph::Access::transferRead)
        .use(result, graph::Access::transferWrite, true)
        .record([drawn, result, size](const graph::PassContext& c) {
            const VkImageCopy region{{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, size};
            c.device.vk().CmdCopyImage(c.cmd, c.image(drawn), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, c.image(result),
                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        });
}

void deliverAll(Context& context, graph::Graph& graph, const Library::Added& added, VkExtent2D visible, VkExtent2D size,
    const gpu::Image* target, const gpu::Image* bent) {
    deliver(graph, added.visibility, visible, outputDesc(context, size), target, "output",
        context.format == VisibilityFormat::r8 ? &context.toR8 : nullptr);
    if (added.bentNormals) deliver(graph, added.bentNormals, visible, bentDesc(size), bent, "output.bent", nullptr);
}

}  // namespace

Output record(Context* context, VkCommandBuffer cmd, const Frame& frame) noexcept {
    Output output;
    if (!context) return output;
    output.status = guarded(context->log, [&] {
        if (!cmd) return refuse(*context, Status::invalid, "record(): the command buffer is null");
        shared::View view;
        if (const Status status = checkFrame(*context, frame, false, view); status != Status::ok) return status;
        // A record() that failed used nothing of its frame: the next one takes its place.
        if (context->executor->lastFrame() == context->device->frame()) context->device->nextFrame();
        const VkExtent2D visible{view.visible.x, view.visible.y};
        if (frame.maxSize.width != context->maxSize.width || frame.maxSize.height != context->maxSize.height) {
            context->maxSize = frame.maxSize;
            context->capacity.clear();
            context->outputSize = {};
        }
        context->outputSize = isDynamic(frame) ? largestOf(context->outputSize, mostVisible(frame, visible)) : visible;
        graph::Graph& graph = *context->graph;
        const gpu::Image *target = nullptr, *bent = nullptr;
        gpu::Status made = nextOf(*context, context->outputs, outputDesc(*context, context->outputSize), "obscura output", target);
        if (made == gpu::Status::ok && context->values->bentNormals)
            made = nextOf(*context, context->bent, bentDesc(context->outputSize), "obscura bent normals", bent);
        else context->bent[context->device->frame() % context->bent.size()] = {};
        if (made != gpu::Status::ok) return statusOf(made);
        const Library::Added added = declareWithin(*context, graph, context->capacity, frame, false);
        if (!added.visibility) return statusOf(context->device->failure());
        deliverAll(*context, graph, added, visible, context->outputSize, target, bent);
        const Status status = statusOf(context->executor->execute(graph, cmd));
        if (status != Status::ok) return status;
        output.image = target->handle();
        output.view = target->view();
        output.size = visible;
        output.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        if (bent) output.bentNormals = bent->handle(), output.bentNormalsView = bent->view();
        return Status::ok;
    });
    return output;
}

uint64_t memoryUse(const Context* context) noexcept { return context ? context->device->memoryUse() : 0; }

uint64_t memoryUse(Context* context, const Frame& frame) noexcept {
    uint64_t bytes = 0;
    if (!context) return bytes;
    guarded(context->log, [&] {
        shared::View view;
        if (const Status status = checkFrame(*context, frame, true, view); status != Status::ok) return status;
        graph::Graph asked(*context->device);  // declared, not executed
        graph::Capacity capacity;
        const Library::Added added = declareWithin(*context, asked, capacity, frame, true);
        if (!added.visibility) return Status::shaderError;
        const VkExtent2D visible{view.visible.x, view.visible.y}, most = mostVisible(frame, visible);
        deliverAll(*context, asked, added, visible, most, nullptr, nullptr);
        uint64_t outputs = gpu::Image::bytesOf(*context->device, outputDesc(*context, most));
        if (added.bentNormals) outputs += gpu::Image::bytesOf(*context->device, bentDesc(most));
        const uint64_t passes = context->executor->bytes(asked);
        if (passes) bytes = context->library->methodBytes() + passes + context->outputs.size() * outputs;
        return Status::ok;
    });
    return bytes;
}

void trim(Context* context) noexcept {
    if (!context) return;
    guarded(context->log, [&] {
        context->executor->trim();
        context->library->trim(*context->values, context->falloff.kind);
        context->capacity.clear();
        context->outputSize = {};
        return Status::ok;
    });
}

List<PassTime> timings(Context* context) noexcept {
    if (!context) return {};
    Context& own = *context;
    guarded(own.log, [&] {
        own.timedNames.clear();
        own.timed.clear();
        for (const gpu::PassTime& pass : own.executor->timings().passes) own.timedNames.push_back(pass.name);
        for (size_t i = 0; i < own.timedNames.size(); ++i)
            own.timed.push_back({own.timedNames[i].c_str(), own.executor->timings().passes[i].milliseconds});
        return Status::ok;
    });
    return {own.timed.data(), own.timed.size()};
}

}  // namespace obscura::ao
