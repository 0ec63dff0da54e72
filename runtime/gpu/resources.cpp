// Images and buffers: creation and destruction. Load-time transfers are in transfers.cpp.
#include "gpu/resources.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <fmt/format.h>

#include "gpu/format_name.h"
#include "gpu/result.h"

namespace obscura::gpu {

VkImageAspectFlags aspectOf(VkFormat format) {
    switch (format) {
        case VK_FORMAT_D16_UNORM:
        case VK_FORMAT_X8_D24_UNORM_PACK32:
        case VK_FORMAT_D32_SFLOAT: return VK_IMAGE_ASPECT_DEPTH_BIT;
        case VK_FORMAT_S8_UINT: return VK_IMAGE_ASPECT_STENCIL_BIT;
        case VK_FORMAT_D16_UNORM_S8_UINT:
        case VK_FORMAT_D24_UNORM_S8_UINT:
        case VK_FORMAT_D32_SFLOAT_S8_UINT: return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
        default: return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

uint32_t bytesPerTexel(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R8_UNORM:
        case VK_FORMAT_R8_SNORM:
        case VK_FORMAT_R8_UINT:
        case VK_FORMAT_R8_SINT:
        case VK_FORMAT_R8_SRGB: return 1;
        case VK_FORMAT_R8G8_UNORM:
        case VK_FORMAT_R8G8_SNORM:
        case VK_FORMAT_R8G8_UINT:
        case VK_FORMAT_R16_UNORM:
        case VK_FORMAT_R16_SNORM:
        case VK_FORMAT_R16_UINT:
        case VK_FORMAT_R16_SINT:
        case VK_FORMAT_R16_SFLOAT:
        case VK_FORMAT_D16_UNORM: return 2;
        case VK_FORMAT_R8G8B8A8_UNORM:
        case VK_FORMAT_R8G8B8A8_SNORM:
        case VK_FORMAT_R8G8B8A8_UINT:
        case VK_FORMAT_R8G8B8A8_SRGB:
        case VK_FORMAT_B8G8R8A8_UNORM:
        case VK_FORMAT_B8G8R8A8_SRGB:
        case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
        case VK_FORMAT_A2R10G10B10_UNORM_PACK32:
        case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
        case VK_FORMAT_E5B9G9R9_UFLOAT_PACK32:
        case VK_FORMAT_R16G16_UNORM:
        case VK_FORMAT_R16G16_SNORM:
        case VK_FORMAT_R16G16_UINT:
        case VK_FORMAT_R16G16_SFLOAT:
        case VK_FORMAT_R32_UINT:
        case VK_FORMAT_R32_SINT:
        case VK_FORMAT_R32_SFLOAT:
        case VK_FORMAT_X8_D24_UNORM_PACK32:
        case VK_FORMAT_D32_SFLOAT: return 4;
        case VK_FORMAT_R16G16B16A16_UNORM:
        case VK_FORMAT_R16G16B16A16_SNORM:
        case VK_FORMAT_R16G16B16A16_UINT:
        case VK_FORMAT_R16G16B16A16_SFLOAT:
        case VK_FORMAT_R32G32_UINT:
        case VK_FORMAT_R32G32_SFLOAT: return 8;
        case VK_FORMAT_R32G32B32A32_UINT:
        case VK_FORMAT_R32G32B32A32_SFLOAT: return 16;
        default: return 0;
    }
}

namespace {

const char* text(const char* name) { return name ? name : "(unnamed)"; }

// The first use the format does not allow on this device, or null.
const char* forbiddenUse(const Device& device, const ImageDesc& desc) {
    struct Use {
        VkImageUsageFlags usage;
        VkFormatFeatureFlags feature;
        const char* name;
    };
    constexpr Use kUses[] = {
        {VK_IMAGE_USAGE_SAMPLED_BIT, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, "a sampled image"},
        {VK_IMAGE_USAGE_STORAGE_BIT, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, "a storage image"},
        {VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, "a colour attachment"},
        {VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT, "a depth attachment"},
    };
    for (const Use& use : kUses)
        if ((desc.usage & use.usage) && !device.formatSupports(desc.format, use.feature)) return use.name;
    return nullptr;
}

VkImageCreateInfo infoOf(const ImageDesc& desc) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = desc.depth > 1 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.width, desc.height, desc.depth};
    info.mipLevels = desc.mips;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = desc.usage;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    return info;
}

VkBufferCreateInfo infoOf(uint64_t bytes, VkBufferUsageFlags usage, Memory memory) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes;
    // Device memory can only be filled and looked at by transfers.
    info.usage = memory == Memory::device ? usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT : usage;
    info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    return info;
}

}  // namespace

Image::~Image() {
    if (!m_device) return;
    for (VkImageView view : m_mipViews)
        if (view != m_view) m_device->release(VK_OBJECT_TYPE_IMAGE_VIEW, view);
    m_device->release(VK_OBJECT_TYPE_IMAGE_VIEW, m_view);
    m_device->release(VK_OBJECT_TYPE_IMAGE, m_image);
    m_device->releaseMemory(m_block);
}

void Image::swap(Image& other) noexcept {
    std::swap(m_device, other.m_device);
    std::swap(m_desc, other.m_desc);
    std::swap(m_image, other.m_image);
    std::swap(m_block, other.m_block);
    std::swap(m_view, other.m_view);
    std::swap(m_mipViews, other.m_mipViews);
}

Status Image::create(Device& device, const ImageDesc& desc, const char* name, Image& out) {
    out = Image();
    const auto bad = [&](Status status, const std::string& why) {
        return fail(device, status,
            fmt::format("image '{}' ({}x{}x{}, {}): {}", text(name), desc.width, desc.height, desc.depth, formatName(desc.format), why));
    };
    const uint32_t largest = std::max({desc.width, desc.height, desc.depth});
    if (desc.format == VK_FORMAT_UNDEFINED || desc.usage == 0) return bad(Status::invalid, "it has no format or no usage");
    if (desc.width == 0 || desc.height == 0 || desc.depth == 0) return bad(Status::invalid, "a side is zero");
    if (desc.mips == 0 || desc.mips > uint32_t(std::bit_width(largest)))
        return bad(Status::invalid, fmt::format("it cannot have {} mips", desc.mips));
    if (largest > device.caps().maxImageSize)
        return bad(Status::unsupported, fmt::format("{} allows {} a side", device.caps().deviceName, device.caps().maxImageSize));
    if (const char* use = forbiddenUse(device, desc))
        return bad(Status::unsupported, fmt::format("{} cannot use the format as {}", device.caps().deviceName, use));

    const Api& vk = device.vk();
    Image made;
    made.m_device = &device;
    made.m_desc = desc;
    const VkImageCreateInfo info = infoOf(desc);
    if (VkResult result = vk.CreateImage(device.handle(), &info, device.allocator(), &made.m_image)) {
        made.m_image = VK_NULL_HANDLE;
        return bad(fromVulkan(result), resultName(result));
    }
    VkMemoryRequirements needs;
    vk.GetImageMemoryRequirements(device.handle(), made.m_image, &needs);
    if (Status status = device.allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0, true, made.m_block); status != Status::ok)
        return bad(status, fmt::format("{} bytes of device memory: {}", needs.size, gpu::name(status)));
    if (VkResult result = vk.BindImageMemory(device.handle(), made.m_image, made.m_block.memory, made.m_block.offset))
        return bad(fromVulkan(result), resultName(result));

    constexpr VkImageUsageFlags kViewed = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if (desc.usage & kViewed) {
        VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        view.image = made.m_image;
        view.viewType = desc.depth > 1 ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D;
        view.format = desc.format;
        // Sampling wants one aspect, and stencil is never read here.
        const VkImageAspectFlags aspect = aspectOf(desc.format);
        view.subresourceRange = {
            aspect & VK_IMAGE_ASPECT_DEPTH_BIT ? VkImageAspectFlags(VK_IMAGE_ASPECT_DEPTH_BIT) : aspect, 0, desc.mips, 0, 1};
        if (VkResult result = vk.CreateImageView(device.handle(), &view, device.allocator(), &made.m_view)) {
            made.m_view = VK_NULL_HANDLE;
            return bad(fromVulkan(result), resultName(result));
        }
        device.nameObject(VK_OBJECT_TYPE_IMAGE_VIEW, (uint64_t)made.m_view, name);
        made.m_mipViews.assign(desc.mips, made.m_view);
        for (uint32_t mip = 0; desc.mips > 1 && mip < desc.mips; ++mip) {
            view.subresourceRange.baseMipLevel = mip;
            view.subresourceRange.levelCount = 1;
            VkImageView mipView = VK_NULL_HANDLE;
            if (VkResult result = vk.CreateImageView(device.handle(), &view, device.allocator(), &mipView))
                return bad(fromVulkan(result), resultName(result));
            made.m_mipViews[mip] = mipView;
        }
    } else {
        made.m_mipViews.assign(desc.mips, VK_NULL_HANDLE);  // for transfers only
    }
    device.nameObject(VK_OBJECT_TYPE_IMAGE, (uint64_t)made.m_image, name);
    out = std::move(made);
    return Status::ok;
}

uint64_t Image::bytesOf(Device& device, const ImageDesc& desc) {
    const VkImageCreateInfo info = infoOf(desc);
    VkImage image = VK_NULL_HANDLE;
    if (device.vk().CreateImage(device.handle(), &info, device.allocator(), &image) != VK_SUCCESS) return 0;
    VkMemoryRequirements needs;
    device.vk().GetImageMemoryRequirements(device.handle(), image, &needs);
    device.vk().DestroyImage(device.handle(), image, device.allocator());
    return needs.size;
}

Buffer::~Buffer() {
    if (!m_device) return;
    m_device->release(VK_OBJECT_TYPE_BUFFER, m_buffer);
    m_device->releaseMemory(m_block);
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(m_device, other.m_device);
    std::swap(m_buffer, other.m_buffer);
    std::swap(m_block, other.m_block);
    std::swap(m_size, other.m_size);
}

Status Buffer::create(Device& device, uint64_t bytes, VkBufferUsageFlags usage, Memory memory, const char* name, Buffer& out) {
    out = Buffer();
    const auto bad = [&](Status status, const std::string& why) {
        return fail(device, status, fmt::format("buffer '{}' ({} bytes): {}", text(name), bytes, why));
    };
    if (bytes == 0 || usage == 0) return bad(Status::invalid, "it has no size or no usage");
    const Api& vk = device.vk();
    Buffer made;
    made.m_device = &device;
    made.m_size = bytes;
    const VkBufferCreateInfo info = infoOf(bytes, usage, memory);
    if (VkResult result = vk.CreateBuffer(device.handle(), &info, device.allocator(), &made.m_buffer)) {
        made.m_buffer = VK_NULL_HANDLE;
        return bad(fromVulkan(result), resultName(result));
    }
    VkMemoryRequirements needs;
    vk.GetBufferMemoryRequirements(device.handle(), made.m_buffer, &needs);
    constexpr VkMemoryPropertyFlags kMapped = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryPropertyFlags wanted = memory == Memory::device ? VkMemoryPropertyFlags(VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) : kMapped;
    const VkMemoryPropertyFlags preferred = memory == Memory::readback ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT : 0;
    if (Status status = device.allocate(needs, wanted, preferred, false, made.m_block); status != Status::ok)
        return bad(status,
            fmt::format("{} bytes of {} memory: {}", needs.size, memory == Memory::device ? "device" : "host-visible", gpu::name(status)));
    if (VkResult result = vk.BindBufferMemory(device.handle(), made.m_buffer, made.m_block.memory, made.m_block.offset))
        return bad(fromVulkan(result), resultName(result));
    device.nameObject(VK_OBJECT_TYPE_BUFFER, (uint64_t)made.m_buffer, name);
    out = std::move(made);
    return Status::ok;
}

uint64_t Buffer::bytesOf(Device& device, uint64_t bytes, VkBufferUsageFlags usage, Memory memory) {
    const VkBufferCreateInfo info = infoOf(bytes, usage, memory);
    VkBuffer buffer = VK_NULL_HANDLE;
    if (device.vk().CreateBuffer(device.handle(), &info, device.allocator(), &buffer) != VK_SUCCESS) return 0;
    VkMemoryRequirements needs;
    device.vk().GetBufferMemoryRequirements(device.handle(), buffer, &needs);
    device.vk().DestroyBuffer(device.handle(), buffer, device.allocator());
    return needs.size;
}

}  // namespace obscura::gpu
