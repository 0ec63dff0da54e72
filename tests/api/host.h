// Fixture: a minimal host engine with a device, images in the host's formats and layouts, and a command buffer.
#pragma once

#include <map>

#include "ao/room.h"
#include "api/encode.h"

namespace obscura::test {

// A geometry and the encodings in which a host passes it.
struct Shot {
    Geometry geometry;
    DepthCoding depth;
    NormalCoding normals;
};

class Host {
public:
    explicit Host(gpu::Device& device) : m_device(device) {}
    ~Host() { clear(); }
    Host(const Host&) = delete;
    void clear() {
        m_device.waitIdle();
        ao::destroy(context);
        context = nullptr;
        m_bits = {};
        m_images.clear();
        if (m_pool) m_device.vk().DestroyCommandPool(m_device.handle(), m_pool, nullptr);
        m_pool = VK_NULL_HANDLE;
    }

    ao::DeviceDesc desc() {
        ao::DeviceDesc d;
        d.instance = m_device.instance();
        d.physicalDevice = m_device.physical();
        d.device = m_device.handle();
        d.queueFamily = m_device.queueFamily();
        d.getInstanceProcAddr = m_device.vk().GetInstanceProcAddr;
        d.log = [](void* host, ao::Severity, const char* line) { static_cast<Host*>(host)->lines.emplace_back(line); };
        d.logUser = this;
        return d;
    }

    // Uploads an image and leaves it in `layout`. Images are cached by name and recreated when their description changes.
    ao::ImageView image(
        const std::string& name, VkFormat format, VkExtent2D size, const std::vector<std::byte>& texels, VkImageLayout layout) {
        const VkImageAspectFlags aspect = gpu::aspectOf(format) & VK_IMAGE_ASPECT_DEPTH_BIT ? VkImageAspectFlags(VK_IMAGE_ASPECT_DEPTH_BIT)
                                                                                            : VkImageAspectFlags(VK_IMAGE_ASPECT_COLOR_BIT);
        const VkImageUsageFlags attachment = aspect == VK_IMAGE_ASPECT_DEPTH_BIT ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : 0;
        const gpu::ImageDesc desc{
            format, size.width, size.height, 1, 1, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | attachment};
        gpu::Image& made = m_images[name];
        if (!made || !(made.desc() == desc)) {
            EXPECT_EQ(gpu::Image::create(m_device, desc, name.c_str(), made), gpu::Status::ok);
        }
        EXPECT_EQ(texels.size(), size_t(size.width) * size.height * texelBytes(format)) << name;
        gpu::Buffer staging;
        EXPECT_EQ(gpu::Buffer::create(m_device, texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Memory::upload, "staging", staging),
            gpu::Status::ok);
        std::memcpy(staging.mapped(), texels.data(), texels.size());
        EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) {
            change(cmd, made.handle(), gpu::aspectOf(format), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
            const VkBufferImageCopy region{0, 0, 0, {aspect, 0, 0, 1}, {}, {size.width, size.height, 1}};
            m_device.vk().CmdCopyBufferToImage(cmd, staging.handle(), made.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
            change(cmd, made.handle(), gpu::aspectOf(format), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout);
        }),
            gpu::Status::ok);
        return {made.handle(), made.view(), format, layout};
    }
    ao::ImageView floats(const std::string& name, VkFormat format, VkExtent2D size, const std::vector<float>& texels) {
        std::vector<std::byte> bytes(texels.size() * sizeof(float));
        std::memcpy(bytes.data(), texels.data(), bytes.size());
        return image(name, format, size, bytes, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }

    // `picture`: trace() of the shot's geometry. Images are cached by name: frames that are used at the same time need different `set`s.
    ao::Frame frame(const Shot& shot, const Picture& picture, const std::string& set = {}) {
        const Geometry& g = shot.geometry;
        ao::Frame f;
        f.size = g.size();
        f.guard = g.guard;
        projectionOf(g, shot.depth, f.projection);
        const glm::dmat3 axes = g.camera.axes();
        const glm::dvec3 eye = g.camera.eye * g.scale + g.origin, moved = -(glm::transpose(axes) * eye);
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row) f.eyeFromWorld[4 * column + row] = float(axes[row][column]);
        for (int row = 0; row < 3; ++row) f.eyeFromWorld[12 + row] = float(moved[row]);
        f.depthKind = shot.depth.kind == Depth::linear ? ao::DepthKind::linear : ao::DepthKind::device;
        f.depth = image("depth" + set, shot.depth.format, f.size, encodeDepth(g, shot.depth, picture), shot.depth.layout);
        if (shot.depth.kind == Depth::linear) f.skyDepth = float(9e3 * g.scale);
        if (!shot.normals.none) {
            f.normals = image("normals" + set, shot.normals.format, f.size, encodeNormals(g, shot.normals, picture),
                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
            f.normalKind = shot.normals.kind;
            f.normalEncoding = shot.normals.encoding;
        }
        f.layers.thickness = floats("thickness" + set, VK_FORMAT_R32_SFLOAT, f.size, picture.thickness);
        f.layers.second = floats("second" + set, VK_FORMAT_R32G32_SFLOAT, f.size, picture.second);
        f.layers.secondSize = f.size;
        volume(g, f.volume);
        f.cut = true;
        return f;
    }

    bool submits = true;      // false: nothing is submitted, so the driver compiles nothing; constant for the life of a context
    int* ownCalls = nullptr;  // incremented during the host's own Vulkan calls in record(), in which drivers and layers allocate
    // Submits the commands and waits, unless record() failed: then the command buffer is discarded.
    ao::Output record(const ao::Frame& frame) {
        int none = 0, &own = ownCalls ? *ownCalls : none;
        ++own;
        const gpu::Api& vk = m_device.vk();
        if (!m_pool) {
            const VkCommandPoolCreateInfo pool{
                VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, VK_COMMAND_POOL_CREATE_TRANSIENT_BIT, m_device.queueFamily()};
            EXPECT_EQ(vk.CreateCommandPool(m_device.handle(), &pool, nullptr, &m_pool), VK_SUCCESS);
            const VkCommandBufferAllocateInfo one{
                VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, m_pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
            EXPECT_EQ(vk.AllocateCommandBuffers(m_device.handle(), &one, &m_cmd), VK_SUCCESS);
        }
        const VkCommandBufferBeginInfo begin{
            VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
        EXPECT_EQ(vk.ResetCommandPool(m_device.handle(), m_pool, 0), VK_SUCCESS);
        EXPECT_EQ(vk.BeginCommandBuffer(m_cmd, &begin), VK_SUCCESS);
        --own;
        const ao::Output output = ao::record(context, m_cmd, frame);
        ++own;
        EXPECT_EQ(vk.EndCommandBuffer(m_cmd), VK_SUCCESS);
        if (submits && output.status == ao::Status::ok) {
            const VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, m_cmd, 0};
            VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
            submit.commandBufferInfoCount = 1;
            submit.pCommandBufferInfos = &buffer;
            EXPECT_EQ(vk.QueueSubmit2(m_device.queue(), 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
            EXPECT_EQ(vk.QueueWaitIdle(m_device.queue()), VK_SUCCESS);
        }
        --own;
        return output;
    }
    std::vector<float> pixels(const ao::Output& output, VkExtent2D size) {
        std::vector<std::byte> bytes;
        EXPECT_EQ(
            gpu::download(m_device, output.image, {VK_FORMAT_R16_SFLOAT, size.width, size.height}, output.layout, bytes), gpu::Status::ok);
        return halvesOf(bytes);
    }
    bool said(const std::string& part) const {
        return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) { return line.find(part) != std::string::npos; });
    }
    std::string allSaid() const {
        std::string all;
        for (const std::string& line : lines) all += line + "\n";
        return all;
    }

    ao::Context* context = nullptr;
    std::vector<std::string> lines;

    void change(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect, VkImageLayout from, VkImageLayout to) const {
        VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.oldLayout = from;
        barrier.newLayout = to;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = image;
        barrier.subresourceRange = {aspect, 0, 1, 0, 1};
        VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        info.imageMemoryBarrierCount = 1;
        info.pImageMemoryBarriers = &barrier;
        m_device.vk().CmdPipelineBarrier2(cmd, &info);
    }
    // The cells are the same at any scale and origin of the world: only cellFromEye and the window's origin change.
    void volume(const Geometry& g, ao::Volume& v) {
        if (!m_bits) {
            static const std::vector<uint32_t> bits = voxelize();
            EXPECT_EQ(
                gpu::Buffer::create(m_device, bits.size() * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::device, "bits", m_bits),
                gpu::Status::ok);
            EXPECT_EQ(gpu::upload(m_device, m_bits, std::as_bytes(std::span(bits))), gpu::Status::ok);
        }
        const glm::dmat3 axes = g.camera.axes();
        const glm::dvec3 at = g.camera.eye / kCell + 0.5 * kCells;
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) v.cellFromEye[4 * column + row] = float(axes[column][row] / (kCell * g.scale));
            v.cellFromEye[12 + row] = float(at[row]);
            v.origin[row] = int32_t(std::lround(g.origin[row] / (kCell * g.scale))) & ~int32_t(kCells - 1);
        }
        v.cellFromEye[15] = 1.0f;
        v.buffer = m_bits.handle();
        v.cells = kCells;
    }

    gpu::Device& m_device;
    gpu::Buffer m_bits;
    std::map<std::string, gpu::Image> m_images;
    VkCommandPool m_pool = VK_NULL_HANDLE;
    VkCommandBuffer m_cmd = VK_NULL_HANDLE;
};

inline std::vector<const char*> methodIds() {
    std::vector<const char*> ids;
    for (const ao::MethodInfo* info : ao::methods()) ids.push_back(info->id);
    return ids;
}

}  // namespace obscura::test
