// A small renderer in raw Vulkan, independent of Obscura: its own instance and device under validation, two frames in flight,
// a depth buffer of a room with a box. Errors end the program.
#pragma once

#include <vulkan/vulkan.h>
#include <cstdint>
#include <vector>

struct Camera {
    float projection[16];  // by columns; reversed depth, infinite far plane, y down
    float near = 0.1f;
};

class Renderer {
public:
    static constexpr uint32_t kFrames = 2;  // in flight

    Renderer();
    ~Renderer();
    void resize(uint32_t width, uint32_t height);
    // begin() waits for the frame recorded kFrames frames ago; end() copies the image for read-back and submits.
    VkCommandBuffer begin();
    void end(VkImage picture, VkImageLayout layout, uint32_t bytesPerPixel);
    std::vector<uint8_t> wait();  // until the GPU is idle; returns the newest image, tightly packed

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;
    VkExtent2D size{};
    Camera camera;
    VkImage depth = VK_NULL_HANDLE;  // VK_FORMAT_D32_SFLOAT, in DEPTH_STENCIL_READ_ONLY_OPTIMAL
    VkImageView depthView = VK_NULL_HANDLE;
    uint64_t frame = 0;
    uint32_t validationMessages = 0;
    float depthAt(uint32_t x, uint32_t y) const { return m_scene[size_t(y) * size.width + x]; }  // metres; 0: sky

private:
    struct Buffer {
        VkBuffer buffer;
        VkDeviceMemory memory;
        void* mapped;
    };
    void createInstance();
    void createDevice();
    uint32_t memoryType(uint32_t bits, VkMemoryPropertyFlags wanted) const;
    Buffer createBuffer(VkDeviceSize bytes, VkBufferUsageFlags usage) const;
    void destroy(Buffer& buffer) const;
    void destroyDepth();

    VkDebugUtilsMessengerEXT m_messenger = VK_NULL_HANDLE;
    VkQueue m_queue = VK_NULL_HANDLE;
    VkCommandPool m_pool = VK_NULL_HANDLE;
    VkCommandBuffer m_commands[kFrames] = {};
    VkFence m_fences[kFrames] = {};
    VkDeviceMemory m_depthMemory = VK_NULL_HANDLE;
    Buffer m_upload{}, m_readback{};
    bool m_depthIsNew = false;
    size_t m_pictureBytes = 0;
    std::vector<float> m_scene;
};
