// Images and buffers: move-only, destruction deferred by the device until the GPU is done with them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gpu/device.h"

namespace obscura::gpu {

struct ImageDesc {
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t width = 1, height = 1, depth = 1;  // depth > 1: a 3D image
    uint32_t mips = 1;
    VkImageUsageFlags usage = 0;
    bool operator==(const ImageDesc&) const = default;
};

VkImageAspectFlags aspectOf(VkFormat format);
uint32_t bytesPerTexel(VkFormat format);  // of uncompressed formats we use; 0 if unknown

class Image {
public:
    Image() = default;
    Image(Image&& other) noexcept { swap(other); }
    Image& operator=(Image&& other) noexcept {
        Image gone(std::move(other));
        swap(gone);
        return *this;
    }
    ~Image();
    // On failure `out` is empty and one line was logged.
    static Status create(Device& device, const ImageDesc& desc, const char* name, Image& out);

    explicit operator bool() const { return m_image != VK_NULL_HANDLE; }
    VkImage handle() const { return m_image; }
    VkImageView view() const { return m_view; }  // all mips
    VkImageView mipView(uint32_t mip) const { return m_mipViews[mip]; }
    const ImageDesc& desc() const { return m_desc; }
    uint64_t bytes() const { return m_block.bytes; }
    static uint64_t bytesOf(
        Device& device, const ImageDesc& desc);  // memory that one would take; allocates nothing; 0 if it cannot be made

private:
    void swap(Image& other) noexcept;
    Device* m_device = nullptr;
    ImageDesc m_desc;
    VkImage m_image = VK_NULL_HANDLE;
    MemoryBlock m_block;
    VkImageView m_view = VK_NULL_HANDLE;
    std::vector<VkImageView> m_mipViews;
};

enum class Memory : uint8_t { device, upload, readback };  // device-local; host writes (coherent); host reads (coherent)

class Buffer {
public:
    Buffer() = default;
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        Buffer gone(std::move(other));
        swap(gone);
        return *this;
    }
    ~Buffer();
    static Status create(Device& device, uint64_t bytes, VkBufferUsageFlags usage, Memory memory, const char* name, Buffer& out);

    explicit operator bool() const { return m_buffer != VK_NULL_HANDLE; }
    VkBuffer handle() const { return m_buffer; }
    uint64_t bytes() const { return m_size; }
    std::byte* mapped() const { return m_block.mapped; }                                               // null for Memory::device
    static uint64_t bytesOf(Device& device, uint64_t bytes, VkBufferUsageFlags usage, Memory memory);  // likewise

private:
    void swap(Buffer& other) noexcept;
    Device* m_device = nullptr;
    VkBuffer m_buffer = VK_NULL_HANDLE;
    MemoryBlock m_block;
    uint64_t m_size = 0;
};

// Load-time transfers: each waits until it is done.
Status upload(Device& device, Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset = 0);
// Fills mip 0 from tightly packed rows, leaves the image in `layout`; makes the other mips by linear blits when there are any.
Status upload(Device& device, Image& image, std::span<const std::byte> texels, VkImageLayout layout);
// Mip 0 of an image in `layout`, tightly packed rows top to bottom.
Status download(Device& device, VkImage image, const ImageDesc& desc, VkImageLayout layout, std::vector<std::byte>& out);

}  // namespace obscura::gpu
