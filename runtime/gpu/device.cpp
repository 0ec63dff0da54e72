// A device, created or adopted: adoption, deferred release, samplers, immediate commands.
// Creation is in device_create.cpp, memory in memory.cpp.
#include "gpu/device.h"

#include <algorithm>
#include <bit>
#include <cstdio>

#include <fmt/format.h>

#include "gpu/result.h"

namespace obscura::gpu {

namespace {

constexpr size_t kSpareReleases = 2048;  // objects: more than a frame, or a context's end, releases

// Why the device cannot be used; empty if it can. Vulkan tells which features a device has, not which ones the host enabled.
std::string unfit(const Api& vk, VkPhysicalDevice physical, uint32_t family) {
    uint32_t count = 0;
    vk.GetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vk.GetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    if (family >= count) return fmt::format("queueFamily {} does not exist: the device has {}", family, count);
    if (!(families[family].queueFlags & VK_QUEUE_COMPUTE_BIT)) return fmt::format("queueFamily {} does not support compute", family);
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v13};
    vk.GetPhysicalDeviceFeatures2(physical, &features);
    if (!v13.synchronization2) return "feature synchronization2 is missing";
    if (!features.features.shaderStorageImageExtendedFormats) return "feature shaderStorageImageExtendedFormats is missing";
    return {};
}

}  // namespace

std::unique_ptr<Device> Device::adopt(const AdoptedDevice& host, std::string& error, Status* why) {
    if (why) *why = Status::unsupported;
    const char* missing = !host.instance              ? "instance"
                          : !host.physicalDevice      ? "physicalDevice"
                          : !host.device              ? "device"
                          : !host.getInstanceProcAddr ? "getInstanceProcAddr"
                                                      : nullptr;
    if (missing) {
        error = fmt::format("adopting a Vulkan device: {} is null", missing);
        return nullptr;
    }
    std::unique_ptr<Device> device(new Device);
    device->m_log = host.log;
    device->m_allocator = host.allocator;
    device->m_memorySource = host.memory;
    device->m_instance = host.instance;
    device->m_physical = host.physicalDevice;
    device->m_queue = host.queue;
    device->m_queueFamily = host.queueFamily;
    device->m_framesInFlight = std::max(1u, host.framesInFlight);
    device->m_pipelineCache = host.pipelineCache;
    missing = device->m_vk.loadInstance(host.getInstanceProcAddr, host.instance);
    if (!missing) missing = device->m_vk.loadDevice(host.device);
    if (missing) {
        error = fmt::format("adopting a Vulkan device: {} is missing; instance and device must be of Vulkan 1.3", missing);
        return nullptr;
    }
    VkPhysicalDeviceProperties properties;
    device->m_vk.GetPhysicalDeviceProperties(host.physicalDevice, &properties);
    const std::string reason = properties.apiVersion < VK_API_VERSION_1_3
                                   ? fmt::format("it supports Vulkan {}.{}; 1.3 is needed", VK_API_VERSION_MAJOR(properties.apiVersion),
                                         VK_API_VERSION_MINOR(properties.apiVersion))
                                   : unfit(device->m_vk, host.physicalDevice, host.queueFamily);
    if (!reason.empty()) {
        error = fmt::format("adopting the Vulkan device '{}': {}", properties.deviceName, reason);
        return nullptr;
    }
    device->m_device = host.device;
    if (Status status = device->finish(); status != Status::ok) {
        error = fmt::format("adopting the Vulkan device '{}': {}", device->m_caps.deviceName, name(status));
        if (why) *why = status;
        return nullptr;
    }
    return device;
}

Status Device::finish() {
    m_released.reserve(kSpareReleases);
    VkPhysicalDeviceProperties properties;
    m_vk.GetPhysicalDeviceProperties(m_physical, &properties);
    m_caps.deviceName = properties.deviceName;
    m_caps.type = properties.deviceType;
    m_caps.software = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    m_caps.maxImageSize = properties.limits.maxImageDimension2D;
    m_caps.maxStorageRange = properties.limits.maxStorageBufferRange;
    m_caps.timestampPeriod = properties.limits.timestampPeriod;
    m_caps.debugUtils = m_vk.SetDebugUtilsObjectNameEXT && m_vk.CmdBeginDebugUtilsLabelEXT && m_vk.CmdEndDebugUtilsLabelEXT;
    if (properties.apiVersion < VK_API_VERSION_1_3) return Status::unsupported;

    uint32_t familyCount = 0;
    m_vk.GetPhysicalDeviceQueueFamilyProperties(m_physical, &familyCount, nullptr);
    std::vector<VkQueueFamilyProperties> families(familyCount);
    m_vk.GetPhysicalDeviceQueueFamilyProperties(m_physical, &familyCount, families.data());
    if (m_queueFamily >= familyCount) return Status::invalid;
    const uint32_t bits = families[m_queueFamily].timestampValidBits;
    m_caps.timestamps = bits > 0 && m_caps.timestampPeriod > 0.0;
    m_caps.timestampMask = bits >= 64 ? ~0ull : (1ull << bits) - 1;
    m_vk.GetPhysicalDeviceMemoryProperties(m_physical, &m_memory);

    if (m_queue) {
        const VkCommandPoolCreateInfo pool{
            VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, VK_COMMAND_POOL_CREATE_TRANSIENT_BIT, m_queueFamily};
        if (VkResult result = m_vk.CreateCommandPool(m_device, &pool, m_allocator, &m_commandPool)) return fromVulkan(result);
        const VkCommandBufferAllocateInfo buffer{
            VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, m_commandPool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
        if (VkResult result = m_vk.AllocateCommandBuffers(m_device, &buffer, &m_commandBuffer)) return fromVulkan(result);
    }

    if (m_pipelineCache) return Status::ok;
    readPipelineCache(properties);
    VkPipelineCacheCreateInfo cache{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    cache.initialDataSize = m_pipelineCacheRead.size();
    cache.pInitialData = m_pipelineCacheRead.data();
    VkPipelineCache made = VK_NULL_HANDLE;
    const VkResult result = m_vk.CreatePipelineCache(m_device, &cache, m_allocator, &made);
    if (result == VK_SUCCESS) m_pipelineCache = m_ownPipelineCache = made;
    return fromVulkan(result);
}

Device::~Device() {
    if (m_device) {
        // An adopting host has waited already, and may be using its queues on other threads at this moment.
        if (m_owned && !m_caps.compilerOnly) m_vk.DeviceWaitIdle(m_device);
        destroyReleased(~0ull);
        for (const CachedSampler& cached : m_samplers) m_vk.DestroySampler(m_device, cached.sampler, m_allocator);
        if (m_ownPipelineCache) writePipelineCache();
        m_vk.DestroyPipelineCache(m_device, m_ownPipelineCache, m_allocator);
        m_vk.DestroyCommandPool(m_device, m_commandPool, m_allocator);
        if (m_owned) m_vk.DestroyDevice(m_device, m_allocator);
    }
    if (m_owned && m_messenger) m_vk.DestroyDebugUtilsMessengerEXT(m_instance, m_messenger, m_allocator);
    if (m_owned && m_instance && m_vk.DestroyInstance) m_vk.DestroyInstance(m_instance, m_allocator);
}

void Device::nextFrame() {
    m_released.reserve(m_released.size() + kSpareReleases);
    ++m_frame;
    if (m_frame >= m_framesInFlight) destroyReleased(m_frame - m_framesInFlight);
}

void Device::waitIdle() {
    const VkResult result = m_owned || !m_queue ? m_vk.DeviceWaitIdle(m_device) : m_vk.QueueWaitIdle(m_queue);
    if (result != VK_SUCCESS) log(Severity::error, fmt::format("waiting for the device: {}", resultName(result)));
    destroyReleased(~0ull);
}

void Device::release(VkObjectType type, uint64_t handle) {
    if (handle) m_released.push_back({m_frame, type, handle, {}});
}

void Device::destroyReleased(uint64_t lastFrame) {
    // Entries are in frame order, and an object's memory stands behind the object.
    size_t count = 0;
    for (; count < m_released.size() && m_released[count].frame <= lastFrame; ++count) {
        if (m_released[count].block.memory) freeBlock(m_released[count].block);
        else destroy(m_released[count].type, m_released[count].handle);
    }
    m_released.erase(m_released.begin(), m_released.begin() + std::ptrdiff_t(count));
}

void Device::destroy(VkObjectType type, uint64_t handle) {
    switch (type) {
#define OBSCURA_DESTROY(TYPE, Handle, call) \
    case VK_OBJECT_TYPE_##TYPE: return m_vk.call(m_device, (Handle)handle, m_allocator);
        OBSCURA_DESTROY(IMAGE, VkImage, DestroyImage)
        OBSCURA_DESTROY(IMAGE_VIEW, VkImageView, DestroyImageView)
        OBSCURA_DESTROY(BUFFER, VkBuffer, DestroyBuffer)
        OBSCURA_DESTROY(SAMPLER, VkSampler, DestroySampler)
        OBSCURA_DESTROY(SHADER_MODULE, VkShaderModule, DestroyShaderModule)
        OBSCURA_DESTROY(PIPELINE, VkPipeline, DestroyPipeline)
        OBSCURA_DESTROY(PIPELINE_LAYOUT, VkPipelineLayout, DestroyPipelineLayout)
        OBSCURA_DESTROY(DESCRIPTOR_SET_LAYOUT, VkDescriptorSetLayout, DestroyDescriptorSetLayout)
        OBSCURA_DESTROY(DESCRIPTOR_POOL, VkDescriptorPool, DestroyDescriptorPool)
        OBSCURA_DESTROY(COMMAND_POOL, VkCommandPool, DestroyCommandPool)
        OBSCURA_DESTROY(QUERY_POOL, VkQueryPool, DestroyQueryPool)
        OBSCURA_DESTROY(EVENT, VkEvent, DestroyEvent)
        OBSCURA_DESTROY(FENCE, VkFence, DestroyFence)
        OBSCURA_DESTROY(SEMAPHORE, VkSemaphore, DestroySemaphore)
        OBSCURA_DESTROY(SWAPCHAIN_KHR, VkSwapchainKHR, DestroySwapchainKHR)
#undef OBSCURA_DESTROY
        default: log(Severity::error, fmt::format("release of an object of type {}: not a type that can be released", int(type)));
    }
}

VkSampler Device::sampler(Sampling sampling) {
    const bool nearest = sampling == Sampling::nearest || sampling == Sampling::nearestRepeat;
    const bool repeat = sampling == Sampling::nearestRepeat || sampling == Sampling::linearRepeat;
    const bool shadow = sampling == Sampling::shadow;
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    info.mipmapMode = nearest || shadow ? VK_SAMPLER_MIPMAP_MODE_NEAREST : VK_SAMPLER_MIPMAP_MODE_LINEAR;
    info.addressModeU = info.addressModeV = info.addressModeW = repeat   ? VK_SAMPLER_ADDRESS_MODE_REPEAT
                                                                : shadow ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER
                                                                         : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.borderColor = VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;
    info.compareEnable = shadow;
    info.compareOp = shadow ? VK_COMPARE_OP_GREATER_OR_EQUAL : VK_COMPARE_OP_NEVER;
    info.maxLod = VK_LOD_CLAMP_NONE;
    return sampler(info);
}

VkSampler Device::sampler(const VkSamplerCreateInfo& info) {
    if (info.pNext) {
        log(Severity::error, "sampler: structures behind VkSamplerCreateInfo are not supported");
        return VK_NULL_HANDLE;
    }
    const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
    const std::array<uint32_t, 18> key{info.flags, info.magFilter, info.minFilter, info.mipmapMode, info.addressModeU, info.addressModeV,
        info.addressModeW, bits(info.mipLodBias), info.anisotropyEnable, bits(info.maxAnisotropy), info.compareEnable, info.compareOp,
        bits(info.minLod), bits(info.maxLod), info.borderColor, info.unnormalizedCoordinates};
    for (const CachedSampler& cached : m_samplers)
        if (cached.key == key) return cached.sampler;
    m_samplers.reserve(m_samplers.size() + 1);  // so that no sampler is lost for want of memory
    VkSampler made = VK_NULL_HANDLE;
    if (VkResult result = m_vk.CreateSampler(m_device, &info, m_allocator, &made)) {
        log(Severity::error, fmt::format("sampler: {}", resultName(result)));
        return VK_NULL_HANDLE;
    }
    m_samplers.push_back({key, made});
    return made;
}

void Device::nameObject(VkObjectType type, uint64_t handle, const char* name) const {
    if (!m_caps.debugUtils || !handle || !name) return;
    const VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, type, handle, name};
    m_vk.SetDebugUtilsObjectNameEXT(m_device, &info);
}

void Device::beginLabel(VkCommandBuffer cmd, const char* name) const {
    const VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, name, {}};
    if (m_caps.debugUtils) m_vk.CmdBeginDebugUtilsLabelEXT(cmd, &label);
}

void Device::endLabel(VkCommandBuffer cmd) const {
    if (m_caps.debugUtils) m_vk.CmdEndDebugUtilsLabelEXT(cmd);
}

void Device::log(Severity severity, const std::string& message) const {
    if (m_log) m_log(severity, message.c_str());
    else if (severity != Severity::info) std::fprintf(stderr, "obscura: %s\n", message.c_str());
}

bool Device::formatSupports(VkFormat format, VkFormatFeatureFlags features) const {
    VkFormatProperties properties;
    m_vk.GetPhysicalDeviceFormatProperties(m_physical, format, &properties);
    return (properties.optimalTilingFeatures & features) == features;
}

Status Device::runNow(const std::function<void(VkCommandBuffer)>& record) {
    if (!m_queue) return fail(*this, Status::unsupported, "immediate commands need a queue, and this device was adopted without one");
    VkResult result = m_vk.ResetCommandPool(m_device, m_commandPool, 0);
    const VkCommandBufferBeginInfo begin{
        VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
    if (result == VK_SUCCESS) result = m_vk.BeginCommandBuffer(m_commandBuffer, &begin);
    if (result == VK_SUCCESS) {
        record(m_commandBuffer);
        result = m_vk.EndCommandBuffer(m_commandBuffer);
    }
    VkFence fence = VK_NULL_HANDLE;
    const VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    if (result == VK_SUCCESS) result = m_vk.CreateFence(m_device, &fenceInfo, m_allocator, &fence);
    if (result == VK_SUCCESS) {
        const VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, m_commandBuffer, 0};
        VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
        submit.commandBufferInfoCount = 1;
        submit.pCommandBufferInfos = &buffer;
        result = m_vk.QueueSubmit2(m_queue, 1, &submit, fence);
    }
    if (result == VK_SUCCESS) result = m_vk.WaitForFences(m_device, 1, &fence, VK_TRUE, ~0ull);
    m_vk.DestroyFence(m_device, fence, m_allocator);
    if (result != VK_SUCCESS) return fail(*this, fromVulkan(result), fmt::format("immediate commands: {}", resultName(result)));
    return Status::ok;
}

}  // namespace obscura::gpu
