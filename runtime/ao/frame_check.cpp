#include "ao/frame_check.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "gpu/format_name.h"

namespace obscura::ao {
namespace {

Role depthRole(const Frame& frame) { return frame.depthKind == DepthKind::linear ? Role::linearDepth : Role::deviceDepth; }
Role normalsRole(const Frame& frame) {
    return frame.normalEncoding == NormalEncoding::signedFloat ? Role::signedNormals
           : frame.normalEncoding == NormalEncoding::biased    ? Role::unsignedNormals
                                                               : Role::packedNormals;
}

bool allFinite(std::span<const float> list) {
    return std::all_of(list.begin(), list.end(), [](float value) { return std::isfinite(value); });
}

struct GivenImage {
    const char* name;
    bool given;
    const ImageView& view;
    Role role;
    VkExtent2D size;
};

Status checkImage(const Context& context, const GivenImage& image, bool forecast) {
    const std::string field = std::string("Frame::") + image.name;
    const ImageView& v = image.view;
    if (!forecast) {
        const char* missing = !v.image ? "image" : !v.view ? "view" : v.format == VK_FORMAT_UNDEFINED ? "format" : "layout";
        if (!v.image || !v.view || v.format == VK_FORMAT_UNDEFINED || v.layout == VK_IMAGE_LAYOUT_UNDEFINED)
            return refuse(context, Status::invalid, fmt::format("{}.{} is missing", field, missing));
    }
    if (forecast && v.format == VK_FORMAT_UNDEFINED) return Status::ok;
    if (!fits(image.role, v.format))
        return refuse(context, Status::invalid,
            fmt::format("{}.format is {}; it must be {}", field, gpu::formatName(v.format), formatsOf(image.role)));
    const gpu::Device& device = *context.device;
    if (!device.formatSupports(v.format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
        return refuse(context, Status::unsupported,
            fmt::format("{}.format is {}, which this device cannot sample", field, gpu::formatName(v.format)));
    if (forecast) return Status::ok;
    // Vulkan does not tell an image's size, but its memory cannot be smaller than its texels: that catches one from before a resize.
    VkMemoryRequirements needs;
    device.vk().GetImageMemoryRequirements(device.handle(), v.image, &needs);
    const uint64_t least = uint64_t(image.size.width) * image.size.height * leastBytes(v.format);
    if (needs.size < least)
        return refuse(context, Status::invalid,
            fmt::format("{}.image has {} bytes; {} x {} texels of {} take {} or more", field, needs.size, image.size.width,
                image.size.height, gpu::formatName(v.format), least));
    return Status::ok;
}

}  // namespace

VkOffset2D originOf(const Frame& frame, VkExtent2D size) {
    const int32_t side = size.width == frame.size.width && size.height == frame.size.height ? 1 : 2;
    return {frame.origin.x / side, frame.origin.y / side};
}

VkExtent2D extentOf(const Frame& frame, VkExtent2D size) {
    const VkOffset2D origin = originOf(frame, size);
    return {uint32_t(origin.x) + size.width, uint32_t(origin.y) + size.height};
}

GivenImages imagesOf(const Frame& frame, bool forecast) {
    const auto is = [&](const ImageView& v) { return forecast ? v.format != VK_FORMAT_UNDEFINED : v.image || v.view; };
    return {is(frame.normals), is(frame.motion), is(frame.layers.thickness), is(frame.layers.second)};
}

Status checkFrame(const Context& context, const Frame& frame, bool forecast, shared::View& view) {
    const DepthLayers& layers = frame.layers;
    const auto invalid = [&](const std::string& line) { return refuse(context, Status::invalid, line); };
    const char* reason = nullptr;
    if (viewOf(frame, view, reason) != Status::ok) return invalid(reason);
    if ((reason = unfitEyeFromWorld(frame.eyeFromWorld))) return invalid(fmt::format("Frame::eyeFromWorld {}", reason));
    if (!allFinite(frame.motionScale)) return invalid("Frame::motionScale holds a value that is not finite");
    if (!allFinite(frame.jitter)) return invalid("Frame::jitter holds a value that is not finite");
    if (std::isnan(frame.skyDepth)) return invalid("Frame::skyDepth is not a number");
    const uint32_t most = context.device->caps().maxImageSize;
    if (std::max(frame.size.width, frame.size.height) > most)
        return refuse(context, Status::unsupported,
            fmt::format("Frame::size is {} x {}; this device allows {} a side", frame.size.width, frame.size.height, most));
    const VkExtent2D& largest = frame.maxSize;
    const bool dynamic = largest.width > 0 || largest.height > 0;
    if (dynamic && (frame.size.width > largest.width || frame.size.height > largest.height))
        return invalid(fmt::format("Frame::size is {} x {}, more than Frame::maxSize, {} x {}", frame.size.width, frame.size.height,
            largest.width, largest.height));
    if (std::max(largest.width, largest.height) > most)
        return refuse(context, Status::unsupported,
            fmt::format("Frame::maxSize is {} x {}; this device allows {} a side", largest.width, largest.height, most));
    if (frame.view >= context.views) return invalid(fmt::format("Frame::view is {}; DeviceDesc::views is {}", frame.view, context.views));
    const GivenImages given = imagesOf(frame, forecast);
    if (given.motion && (frame.motionScale[0] == 0.0f || frame.motionScale[1] == 0.0f))
        return invalid(
            fmt::format("Frame::motionScale is ({}, {}); it takes Frame::motion to pixels: for motion in UV it is the image's "
                        "size, for motion in pixels 1",
                frame.motionScale[0], frame.motionScale[1]));
    if (given.second && !given.thickness)
        return invalid("Frame::layers.second is given without Frame::layers.thickness; give both, or thickness alone");
    const auto isReduced = [&](uint32_t side) {
        return layers.secondSize.width == (frame.size.width + side - 1) / side &&
               layers.secondSize.height == (frame.size.height + side - 1) / side;
    };
    if (given.second && !isReduced(1) && !isReduced(2))
        return invalid(fmt::format("Frame::layers.secondSize is {} x {}; it must be Frame::size, {} x {}, or half of it rounded up",
            layers.secondSize.width, layers.secondSize.height, frame.size.width, frame.size.height));
    if (frame.origin.x < 0 || frame.origin.y < 0 || uint32_t(frame.origin.x) > most || uint32_t(frame.origin.y) > most)
        return invalid(
            fmt::format("Frame::origin is ({}, {}); it is the upper left pixel of a part of the images", frame.origin.x, frame.origin.y));
    if (given.second && !isReduced(1) && (frame.origin.x % 2 || frame.origin.y % 2))
        return invalid(
            fmt::format("Frame::origin is ({}, {}); with layers.second of half size it must be even", frame.origin.x, frame.origin.y));
    const VkExtent2D whole = extentOf(frame, frame.size), second = extentOf(frame, layers.secondSize);
    const GivenImage images[] = {{"depth", true, frame.depth, depthRole(frame), whole},
        {"normals", given.normals, frame.normals, normalsRole(frame), whole}, {"motion", given.motion, frame.motion, Role::motion, whole},
        {"layers.thickness", given.thickness, layers.thickness, Role::thickness, whole},
        {"layers.second", given.second, layers.second, Role::second, second}};
    for (const GivenImage& image : images) {
        if (!image.given) continue;
        if (const Status status = checkImage(context, image, forecast); status != Status::ok) return status;
    }
    shared::Volume volume;
    if (frame.volume.buffer && volumeOf(frame.volume, volume, reason) != Status::ok) return invalid(reason);
    return Status::ok;
}

}  // namespace obscura::ao
