// A small renderer in raw Vulkan: device, command buffers, an analytic depth buffer, read-back.
#include "renderer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

void must(VkResult result, const char* what) {
    if (result == VK_SUCCESS) return;
    std::fprintf(stderr, "renderer: %s failed with %d\n", what, int(result));
    std::exit(2);
}

VkBool32 VKAPI_CALL onMessage(
    VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT, const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    ++static_cast<Renderer*>(user)->validationMessages;
    return VK_FALSE;
}

// Along a ray from the eye with direction (x, y, -1): the nearest of a floor, a wall and a box, in metres along -z; 0 for the sky.
float scene(float x, float y) {
    float nearest = 1e9f;
    if (y < 0.0f) nearest = std::min(nearest, -1.5f / y);    // floor 1.5 m below the eye
    if (6.0f * y < 1.0f) nearest = std::min(nearest, 6.0f);  // wall 6 m away, up to 1 m above the eye
    const float front = 4.0f;                                // box, 1 m wide and high, on the floor
    if (std::fabs(front * x) < 0.5f && front * y > -1.5f && front * y < -0.5f) nearest = std::min(nearest, front);
    return nearest < 1e8f ? nearest : 0.0f;
}

void barrier(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 b{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    b.srcStageMask = b.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    b.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    b.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    b.oldLayout = from;
    b.newLayout = to;
    b.image = image;
    b.subresourceRange = {aspect, 0, 1, 0, 1};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &b;
    vkCmdPipelineBarrier2(cmd, &info);
}

}  // namespace

Renderer::Renderer() {
    createInstance();
    createDevice();
    VkCommandPoolCreateInfo pool{
        VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, queueFamily};
    must(vkCreateCommandPool(device, &pool, nullptr, &m_pool), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo commands{
        VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, m_pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, kFrames};
    must(vkAllocateCommandBuffers(device, &commands, m_commands), "vkAllocateCommandBuffers");
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
    for (VkFence& f : m_fences) must(vkCreateFence(device, &fence, nullptr, &f), "vkCreateFence");
}

Renderer::~Renderer() {
    vkDeviceWaitIdle(device);
    destroyDepth();
    for (VkFence f : m_fences) vkDestroyFence(device, f, nullptr);
    vkDestroyCommandPool(device, m_pool, nullptr);
    vkDestroyDevice(device, nullptr);
    const auto destroyMessenger = (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT");
    if (m_messenger) destroyMessenger(instance, m_messenger, nullptr);
    vkDestroyInstance(instance, nullptr);
}

void Renderer::createInstance() {
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    const char* validation = "VK_LAYER_KHRONOS_validation";
    const bool validated =
        std::any_of(layers.begin(), layers.end(), [&](const VkLayerProperties& l) { return !std::strcmp(l.layerName, validation); });
    std::printf("validation: %s\n", validated ? "on" : "not installed");

    const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = onMessage;
    messenger.pUserData = this;
    const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    const VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messenger, 1, &synchronization, 0, nullptr};
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    if (validated) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &validation;
        info.enabledExtensionCount = 2;
        info.ppEnabledExtensionNames = extensions;
    }
    must(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
    const auto createMessenger = (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT");
    if (validated) must(createMessenger(instance, &messenger, nullptr, &m_messenger), "vkCreateDebugUtilsMessengerEXT");
}

void Renderer::createDevice() {
    uint32_t count = 1;
    vkEnumeratePhysicalDevices(instance, &count, &physicalDevice);
    if (count == 0) {
        std::puts("no Vulkan device");
        std::exit(77);
    }
    uint32_t families = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice, &families, nullptr);
    std::vector<VkQueueFamilyProperties> properties(families);
    vkGetPhysicalDeviceQueueFamilyProperties(physicalDevice, &families, properties.data());
    while (queueFamily + 1 < families && !(properties[queueFamily].queueFlags & VK_QUEUE_COMPUTE_BIT)) ++queueFamily;

    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, queueFamily, 1, &priority};
    // Features that the library requires: README, "Into your renderer", step 2.
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    v13.synchronization2 = v13.maintenance4 = VK_TRUE;
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v13};
    features.features.shaderStorageImageExtendedFormats = VK_TRUE;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    must(vkCreateDevice(physicalDevice, &info, nullptr, &device), "vkCreateDevice");
    vkGetDeviceQueue(device, queueFamily, 0, &m_queue);
}

uint32_t Renderer::memoryType(uint32_t bits, VkMemoryPropertyFlags wanted) const {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physicalDevice, &memory);
    for (uint32_t type = 0; type < memory.memoryTypeCount; ++type)
        if ((bits >> type & 1) && (memory.memoryTypes[type].propertyFlags & wanted) == wanted) return type;
    must(VK_ERROR_OUT_OF_DEVICE_MEMORY, "finding a memory type");
    return 0;
}

Renderer::Buffer Renderer::createBuffer(VkDeviceSize bytes, VkBufferUsageFlags usage) const {
    Buffer made{};
    const VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, nullptr, 0, bytes, usage};
    must(vkCreateBuffer(device, &info, nullptr, &made.buffer), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, made.buffer, &needs);
    const VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
        memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT)};
    must(vkAllocateMemory(device, &memory, nullptr, &made.memory), "vkAllocateMemory");
    must(vkBindBufferMemory(device, made.buffer, made.memory, 0), "vkBindBufferMemory");
    must(vkMapMemory(device, made.memory, 0, VK_WHOLE_SIZE, 0, &made.mapped), "vkMapMemory");
    return made;
}

void Renderer::destroy(Buffer& buffer) const {
    vkDestroyBuffer(device, buffer.buffer, nullptr);
    vkFreeMemory(device, buffer.memory, nullptr);
    buffer = {};
}

void Renderer::destroyDepth() {
    vkDestroyImageView(device, depthView, nullptr);
    vkDestroyImage(device, depth, nullptr);
    vkFreeMemory(device, m_depthMemory, nullptr);
    destroy(m_upload);
    destroy(m_readback);
}

void Renderer::resize(uint32_t width, uint32_t height) {
    vkDeviceWaitIdle(device);
    destroyDepth();
    size = {width, height};
    const float focal = 1.2f, aspect = float(width) / float(height);  // 80 degrees high
    const float p[16] = {focal / aspect, 0, 0, 0, 0, -focal, 0, 0, 0, 0, 0, -1, 0, 0, camera.near, 0};
    std::copy(p, p + 16, camera.projection);

    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = VK_FORMAT_D32_SFLOAT;
    info.extent = {width, height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    must(vkCreateImage(device, &info, nullptr, &depth), "vkCreateImage");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, depth, &needs);
    const VkMemoryAllocateInfo memory{
        VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)};
    must(vkAllocateMemory(device, &memory, nullptr, &m_depthMemory), "vkAllocateMemory");
    must(vkBindImageMemory(device, depth, m_depthMemory, 0), "vkBindImageMemory");
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, nullptr, 0, depth, VK_IMAGE_VIEW_TYPE_2D, VK_FORMAT_D32_SFLOAT};
    view.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
    must(vkCreateImageView(device, &view, nullptr, &depthView), "vkCreateImageView");

    m_upload = createBuffer(VkDeviceSize(width) * height * 4, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    m_readback = createBuffer(VkDeviceSize(width) * height * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    m_scene.resize(size_t(width) * height);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const float ndcX = 2.0f * (float(x) + 0.5f) / float(width) - 1.0f, ndcY = 2.0f * (float(y) + 0.5f) / float(height) - 1.0f;
            const float metres = scene(ndcX * aspect / focal, -ndcY / focal);
            m_scene[size_t(y) * width + x] = metres;
            static_cast<float*>(m_upload.mapped)[size_t(y) * width + x] = metres > 0.0f ? camera.near / metres : 0.0f;
        }
    m_depthIsNew = true;
}

VkCommandBuffer Renderer::begin() {
    const uint32_t slot = uint32_t(frame % kFrames);
    must(vkWaitForFences(device, 1, &m_fences[slot], VK_TRUE, ~0ull), "vkWaitForFences");
    vkResetFences(device, 1, &m_fences[slot]);
    VkCommandBuffer cmd = m_commands[slot];
    const VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    must(vkBeginCommandBuffer(cmd, &info), "vkBeginCommandBuffer");
    if (m_depthIsNew) {
        barrier(cmd, depth, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1};
        region.imageExtent = {size.width, size.height, 1};
        vkCmdCopyBufferToImage(cmd, m_upload.buffer, depth, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        barrier(
            cmd, depth, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
        m_depthIsNew = false;
    }
    return cmd;
}

void Renderer::end(VkImage picture, VkImageLayout layout, uint32_t bytesPerPixel) {
    const uint32_t slot = uint32_t(frame % kFrames);
    VkCommandBuffer cmd = m_commands[slot];
    barrier(cmd, picture, VK_IMAGE_ASPECT_COLOR_BIT, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {size.width, size.height, 1};
    vkCmdCopyImageToBuffer(cmd, picture, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, m_readback.buffer, 1, &region);
    m_pictureBytes = size_t(size.width) * size.height * bytesPerPixel;
    must(vkEndCommandBuffer(cmd), "vkEndCommandBuffer");
    const VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, cmd, 0};
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    must(vkQueueSubmit2(m_queue, 1, &submit, m_fences[slot]), "vkQueueSubmit2");
    ++frame;
}

std::vector<uint8_t> Renderer::wait() {
    must(vkDeviceWaitIdle(device), "vkDeviceWaitIdle");
    const uint8_t* first = static_cast<const uint8_t*>(m_readback.mapped);
    return {first, first + m_pictureBytes};
}
