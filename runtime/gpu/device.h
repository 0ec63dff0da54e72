// A Vulkan 1.3 device, created by us or adopted from a host, with one queue. Owns deferred destruction: what is released
// during frame n is destroyed once frame n has left the GPU. Throws nothing; a failure is a Status and one log line.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gpu/memory.h"

namespace obscura::gpu {

enum class Status : uint8_t { ok, invalid, unsupported, outOfMemory, deviceLost, shaderError, outOfDate };
const char* name(Status);
Status fromVulkan(VkResult);

enum class Severity : uint8_t { info, warning, error };
using Log = std::function<void(Severity, const char* message)>;

struct DeviceOptions {
    std::string name;                             // part of a device name, case-insensitive; empty: discrete, integrated, virtual, software
    bool validation = false;                      // core validation; ignored with a warning when the layer is not installed
    bool synchronization = false;                 // synchronization validation as well
    std::vector<const char*> instanceExtensions;  // of the window system
    bool presentation = false;                    // enables VK_KHR_swapchain where offered
    bool compilerOnly = false;                    // for a device without hardware: makes pipelines, runs and waits for nothing
    bool statistics = false;  // of compiled pipelines (pipeline_statistics.h), where offered; drivers may then cache less
    uint32_t framesInFlight = 2;
    std::string pipelineCacheFile;  // read at creation, written at destruction when changed; empty: none
    Log log;
};

struct AdoptedDevice {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;  // may stay null: then immediate uploads are refused
    uint32_t queueFamily = 0;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    uint32_t framesInFlight = 2;
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;  // null: one of the device's own
    const VkAllocationCallbacks* allocator = nullptr;
    MemorySource memory;  // empty: vkAllocateMemory, once an image or buffer
    Log log;
};

struct Caps {
    std::string deviceName;
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    bool software = false;  // a CPU rasterizer: timestamps need a barrier behind them (see Timestamps)
    bool timestamps = false;
    double timestampPeriod = 1.0;  // nanoseconds a tick
    uint64_t timestampMask = ~0ull;
    bool debugUtils = false;
    bool validation = false;  // the Khronos layer is on
    bool presentation = false;
    bool compilerOnly = false;            // DeviceOptions::compilerOnly
    bool statistics = false;              // VK_KHR_pipeline_executable_properties is on
    bool fragmentWrites = false;          // fragment shaders may write images and use atomics; unknown, so false, on adopted devices
    float maxAnisotropy = 1.0f;           // 1 where the feature is off
    uint32_t maxImageSize = 4096;         // pixels a side, 2D
    uint64_t maxStorageRange = 1u << 27;  // bytes that a storage buffer's binding may span
};

// Clamp to edge unless said; `shadow` compares >= and reads 0 (far) outside.
enum class Sampling : uint8_t { nearest, linear, nearestRepeat, linearRepeat, shadow };

class Device {
public:
    static std::unique_ptr<Device> create(const DeviceOptions& options, std::string& error);
    static std::unique_ptr<Device> adopt(const AdoptedDevice& host, std::string& error, Status* why = nullptr);
    // Names of all devices, "name (type)", in the order `create` prefers.
    static std::vector<std::string> list();
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const Api& vk() const { return m_vk; }
    VkInstance instance() const { return m_instance; }
    VkPhysicalDevice physical() const { return m_physical; }
    VkDevice handle() const { return m_device; }
    VkQueue queue() const { return m_queue; }
    uint32_t queueFamily() const { return m_queueFamily; }
    const Caps& caps() const { return m_caps; }
    VkPipelineCache pipelineCache() const { return m_pipelineCache; }
    const VkAllocationCallbacks* allocator() const { return m_allocator; }
    uint32_t framesInFlight() const { return m_framesInFlight; }
    uint64_t validationMessages() const { return m_validationMessages; }  // warnings and errors so far

    // Starts frame n+1: destroys what was released framesInFlight frames ago. The caller has waited for that frame.
    void nextFrame();
    uint64_t frame() const { return m_frame; }
    void waitIdle();  // and destroys everything released

    // Destroys the handle once the current frame has left the GPU. Null handles are ignored.
    void release(VkObjectType type, uint64_t handle);
    template <class Handle> void release(VkObjectType type, Handle handle) { release(type, (uint64_t)handle); }

    // Memory for an image or a buffer, mapped where `wanted` says host visible. The size counts towards memoryUse() until the
    // memory is really freed: framesInFlight frames after its release, or at waitIdle().
    Status allocate(
        const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted, VkMemoryPropertyFlags preferred, bool image, MemoryBlock& block);
    void releaseMemory(const MemoryBlock& block);
    uint64_t memoryUse() const { return m_memoryUse; }  // bytes of device memory allocated by us

    VkSampler sampler(Sampling sampling);                // cached, owned by the device
    VkSampler sampler(const VkSamplerCreateInfo& info);  // likewise
    // For captures; nothing without debug utils.
    void nameObject(VkObjectType type, uint64_t handle, const char* name) const;
    void beginLabel(VkCommandBuffer cmd, const char* name) const;
    void endLabel(VkCommandBuffer cmd) const;
    void log(Severity severity, const std::string& message) const;
    // The last failure, for callers that only see that something was not made.
    void noteFailure(Status status) const { m_failure = status; }
    Status failure() const { return m_failure; }
    bool formatSupports(VkFormat format, VkFormatFeatureFlags features) const;  // optimal tiling

    // Records and runs commands at once, waits for them. For loading and tests; refused without a queue.
    Status runNow(const std::function<void(VkCommandBuffer)>& record);

private:
    Device() = default;
    bool createInstance(const DeviceOptions& options, std::string& error);
    bool createDevice(const DeviceOptions& options, std::string& error);
    Status finish();
    void readPipelineCache(const VkPhysicalDeviceProperties& properties);
    void writePipelineCache() const;
    void destroy(VkObjectType type, uint64_t handle);
    void destroyReleased(uint64_t lastFrame);
    VkResult allocateBlock(const VkMemoryRequirements& needs, bool mapped, bool image, MemoryBlock& block);
    void freeBlock(const MemoryBlock& block);
    struct Released {
        uint64_t frame;
        VkObjectType type;
        uint64_t handle;
        MemoryBlock block;
    };

    Api m_vk;
    VkInstance m_instance = VK_NULL_HANDLE;
    VkPhysicalDevice m_physical = VK_NULL_HANDLE;
    VkDevice m_device = VK_NULL_HANDLE;
    VkQueue m_queue = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT m_messenger = VK_NULL_HANDLE;
    VkPipelineCache m_pipelineCache = VK_NULL_HANDLE, m_ownPipelineCache = VK_NULL_HANDLE;  // the host's or our own; our own or null
    VkCommandPool m_commandPool = VK_NULL_HANDLE;
    VkCommandBuffer m_commandBuffer = VK_NULL_HANDLE;  // of runNow
    const VkAllocationCallbacks* m_allocator = nullptr;
    MemorySource m_memorySource;
    uint32_t m_queueFamily = 0;
    uint32_t m_framesInFlight = 2;
    bool m_owned = false;
    Caps m_caps;
    VkPhysicalDeviceMemoryProperties m_memory{};
    Log m_log;
    std::string m_pipelineCacheFile;
    std::vector<uint8_t> m_pipelineCacheRead;  // as read from the file, to see whether the driver's has changed
    uint64_t m_frame = 0;
    uint64_t m_memoryUse = 0;
    uint64_t m_validationMessages = 0;
    std::vector<Released> m_released;  // with spare capacity: destructors add to it, which must not fail
    mutable Status m_failure = Status::ok;
    struct CachedSampler {
        std::array<uint32_t, 18> key;
        VkSampler sampler;
    };
    std::vector<CachedSampler> m_samplers;

    friend VkBool32 onValidation(
        VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT, const VkDebugUtilsMessengerCallbackDataEXT*, void*);
};

}  // namespace obscura::gpu
