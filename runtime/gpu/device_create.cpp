// Our own instance and device: validation, choice among devices, features.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <fmt/format.h>

#include "gpu/result.h"

namespace obscura::gpu {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

int rank(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return 0;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return 1;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return 2;
        case VK_PHYSICAL_DEVICE_TYPE_CPU: return 3;
        default: return 4;
    }
}

struct Candidate {
    VkPhysicalDevice handle;
    VkPhysicalDeviceProperties properties;
    std::string label() const { return fmt::format("{} ({})", properties.deviceName, typeName(properties.deviceType)); }
};

std::vector<Candidate> candidates(const Api& vk, VkInstance instance) {
    uint32_t count = 0;
    if (vk.EnumeratePhysicalDevices(instance, &count, nullptr) != VK_SUCCESS) return {};
    std::vector<VkPhysicalDevice> handles(count);
    if (vk.EnumeratePhysicalDevices(instance, &count, handles.data()) < VK_SUCCESS) return {};
    handles.resize(count);
    std::vector<Candidate> list;
    for (VkPhysicalDevice handle : handles) {
        list.push_back({handle, {}});
        vk.GetPhysicalDeviceProperties(handle, &list.back().properties);
    }
    std::stable_sort(list.begin(), list.end(),
        [](const Candidate& a, const Candidate& b) { return rank(a.properties.deviceType) < rank(b.properties.deviceType); });
    return list;
}

std::string labels(const std::vector<Candidate>& list) {
    std::string text;
    for (const Candidate& candidate : list) text += (text.empty() ? "" : ", ") + candidate.label();
    return text;
}

bool offers(const std::vector<VkExtensionProperties>& offered, const char* name) {
    return std::any_of(
        offered.begin(), offered.end(), [&](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

struct Global {  // functions that need no instance
    PFN_vkGetInstanceProcAddr load = systemLoader();
    PFN_vkCreateInstance createInstance = (PFN_vkCreateInstance)load(nullptr, "vkCreateInstance");
    PFN_vkEnumerateInstanceVersion version = (PFN_vkEnumerateInstanceVersion)load(nullptr, "vkEnumerateInstanceVersion");
    PFN_vkEnumerateInstanceExtensionProperties extensions =
        (PFN_vkEnumerateInstanceExtensionProperties)load(nullptr, "vkEnumerateInstanceExtensionProperties");

    // Empty too where the layer is not installed.
    std::vector<VkExtensionProperties> extensionsOf(const char* layer, bool* there = nullptr) const {
        uint32_t count = 0;
        const VkResult result = extensions(layer, &count, nullptr);
        if (there) *there = result == VK_SUCCESS;
        std::vector<VkExtensionProperties> list(result == VK_SUCCESS ? count : 0);
        if (count && !list.empty() && extensions(layer, &count, list.data()) < VK_SUCCESS) list.clear();
        return list;
    }
};

VkApplicationInfo applicationInfo() {
    return {VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "Obscura", 1, "Obscura", 1, VK_API_VERSION_1_3};
}

struct Features {
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
};

// Enables the features that we use. Returns the name of the first required one that is missing, or null. Terminate, demote and
// maintenance4 are what SPIR-V 1.6 compilers assume (discard, workgroup sizes); every Vulkan 1.3 device has them.
const char* chooseFeatures(const Features& has, Features& wants) {
    if (!has.v13.dynamicRendering) return "dynamicRendering";
    if (!has.v13.synchronization2) return "synchronization2";
    if (!has.core.features.shaderStorageImageExtendedFormats) return "shaderStorageImageExtendedFormats";
    wants.v13.dynamicRendering = wants.v13.synchronization2 = VK_TRUE;
    wants.v13.maintenance4 = has.v13.maintenance4;
    wants.v13.shaderTerminateInvocation = has.v13.shaderTerminateInvocation;
    wants.v13.shaderDemoteToHelperInvocation = has.v13.shaderDemoteToHelperInvocation;
    wants.core.features.shaderStorageImageExtendedFormats = VK_TRUE;
    wants.core.features.samplerAnisotropy = has.core.features.samplerAnisotropy;
    wants.core.features.shaderStorageImageWriteWithoutFormat = has.core.features.shaderStorageImageWriteWithoutFormat;
    wants.core.features.independentBlend = has.core.features.independentBlend;
    wants.core.features.fragmentStoresAndAtomics = has.core.features.fragmentStoresAndAtomics;
    return nullptr;
}

int workFamily(const Api& vk, VkPhysicalDevice physical) {
    uint32_t count = 0;
    vk.GetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vk.GetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    constexpr VkQueueFlags kNeeds = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & kNeeds) == kNeeds) return int(i);
    return -1;
}

// Why a device will not do; empty if it will.
std::string unfit(const Api& vk, const Candidate& candidate) {
    const uint32_t version = candidate.properties.apiVersion;
    if (version < VK_API_VERSION_1_3)
        return fmt::format("Vulkan {}.{} only, 1.3 is needed", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version));
    if (workFamily(vk, candidate.handle) < 0) return "no queue for graphics and compute";
    Features has, wants;
    has.core.pNext = &has.v13;
    vk.GetPhysicalDeviceFeatures2(candidate.handle, &has.core);
    if (const char* missing = chooseFeatures(has, wants)) return fmt::format("feature {} is missing", missing);
    return {};
}

DeviceOptions withEnvironment(DeviceOptions options) {
    const char* device = std::getenv("OBSCURA_DEVICE");
    if (device && options.name.empty()) options.name = device;
    const std::string_view validation = std::getenv("OBSCURA_VALIDATION") ? std::getenv("OBSCURA_VALIDATION") : "";
    if (validation == "sync") options.synchronization = true;
    if (validation == "1" || options.synchronization) options.validation = true;
    return options;
}

}  // namespace

VkBool32 onValidation(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
    const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    // Advice on performance and the loader's chatter are no findings.
    if (!(types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT)) return VK_FALSE;
    Device& device = *static_cast<Device*>(user);
    std::atomic_ref<uint64_t>(device.m_validationMessages).fetch_add(1, std::memory_order_relaxed);
    device.log(severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT ? Severity::error : Severity::warning,
        fmt::format("validation: {}", data && data->pMessage ? data->pMessage : "(no text)"));
    return VK_FALSE;
}

std::vector<std::string> Device::list() {
    const Global global;
    const VkApplicationInfo application = applicationInfo();
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    VkInstance instance = VK_NULL_HANDLE;
    if (!global.createInstance || global.createInstance(&info, nullptr, &instance) != VK_SUCCESS) return {};
    Api vk;
    std::vector<std::string> names;
    if (!vk.loadInstance(global.load, instance))
        for (const Candidate& candidate : candidates(vk, instance)) names.push_back(candidate.label());
    if (vk.DestroyInstance) vk.DestroyInstance(instance, nullptr);
    return names;
}

std::unique_ptr<Device> Device::create(const DeviceOptions& given, std::string& error) {
    const DeviceOptions options = withEnvironment(given);
    std::unique_ptr<Device> device(new Device);
    device->m_owned = true;
    device->m_log = options.log;
    device->m_framesInFlight = std::max(1u, options.framesInFlight);
    device->m_pipelineCacheFile = options.pipelineCacheFile;
    device->m_caps.compilerOnly = options.compilerOnly;
    if (!device->createInstance(options, error) || !device->createDevice(options, error)) return nullptr;
    if (Status status = device->finish(); status != Status::ok) {
        error = fmt::format("Vulkan device '{}': {}", device->m_caps.deviceName, gpu::name(status));
        return nullptr;
    }
    return device;
}

bool Device::createInstance(const DeviceOptions& options, std::string& error) {
    const Global global;
    uint32_t version = VK_API_VERSION_1_0;
    if (global.version) global.version(&version);
    if (!global.createInstance || version < VK_API_VERSION_1_3) {
        error = fmt::format(
            "the Vulkan loader knows Vulkan {}.{} only; 1.3 is needed", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version));
        return false;
    }

    std::vector<const char*> extensions = options.instanceExtensions;
    const std::vector<VkExtensionProperties> offered = global.extensionsOf(nullptr);
    for (const char* extension : extensions) {
        if (offers(offered, extension)) continue;
        error = fmt::format("the Vulkan loader does not offer the instance extension {}", extension);
        return false;
    }
    const bool debugUtils = offers(offered, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (debugUtils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    if (options.validation) {
        bool there = false;
        const std::vector<VkExtensionProperties> ofLayer = global.extensionsOf(kValidationLayer, &there);
        m_caps.validation = there && debugUtils;
        if (!m_caps.validation)
            log(Severity::warning, fmt::format("validation was asked for, but {} is not installed; going on without", kValidationLayer));
        else if (options.synchronization && offers(ofLayer, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME))
            extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    }

    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = &onValidation;
    messenger.pUserData = this;
    const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messenger, 1, &synchronization, 0, nullptr};

    const VkApplicationInfo application = applicationInfo();
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    if (m_caps.validation) {
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
        info.pNext = options.synchronization ? static_cast<const void*>(&features) : &messenger;
    }
    if (VkResult result = global.createInstance(&info, nullptr, &m_instance)) {
        m_instance = VK_NULL_HANDLE;
        error = fmt::format("no Vulkan instance: {}{}", resultName(result),
            result == VK_ERROR_INCOMPATIBLE_DRIVER ? "; no Vulkan driver is installed" : "");
        return false;
    }
    if (const char* missing = m_vk.loadInstance(global.load, m_instance)) {
        error = fmt::format("the Vulkan instance lacks {}", missing);
        return false;
    }
    if (m_caps.validation) m_vk.CreateDebugUtilsMessengerEXT(m_instance, &messenger, nullptr, &m_messenger);
    return true;
}

bool Device::createDevice(const DeviceOptions& options, std::string& error) {
    const std::vector<Candidate> all = candidates(m_vk, m_instance);
    if (all.empty()) {
        error = "there is no Vulkan device; is a driver installed? (mesa's lavapipe serves where there is no GPU)";
        return false;
    }
    const Candidate* chosen = nullptr;
    bool matched = false;
    std::string reasons;
    for (const Candidate& candidate : all) {
        if (lowerCase(candidate.properties.deviceName).find(lowerCase(options.name)) == std::string::npos) continue;
        matched = true;
        const std::string reason = unfit(m_vk, candidate);
        if (reason.empty()) {
            chosen = &candidate;
            break;
        }
        reasons += fmt::format("{}{}: {}", reasons.empty() ? "" : "; ", candidate.label(), reason);
    }
    if (!chosen) {
        error = matched ? fmt::format("no Vulkan device will do: {}", reasons)
                        : fmt::format("no Vulkan device has '{}' in its name; there are: {}", options.name, labels(all));
        return false;
    }

    m_physical = chosen->handle;
    m_caps.deviceName = chosen->properties.deviceName;
    m_queueFamily = uint32_t(workFamily(m_vk, m_physical));
    Features has, wants;
    has.core.pNext = &has.v13;
    m_vk.GetPhysicalDeviceFeatures2(m_physical, &has.core);
    chooseFeatures(has, wants);
    wants.core.pNext = &wants.v13;

    uint32_t count = 0;
    m_vk.EnumerateDeviceExtensionProperties(m_physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> offered(count);
    m_vk.EnumerateDeviceExtensionProperties(m_physical, nullptr, &count, offered.data());
    std::vector<const char*> extensions;
    m_caps.presentation = options.presentation && offers(offered, VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    if (m_caps.presentation) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    m_caps.statistics = options.statistics && offers(offered, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR, nullptr, VK_TRUE};
    if (m_caps.statistics) {
        extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
        wants.v13.pNext = &statistics;
    }

    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = m_queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = &wants.core;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VkDevice made = VK_NULL_HANDLE;
    if (VkResult result = m_vk.CreateDevice(m_physical, &info, nullptr, &made)) {
        error = fmt::format("Vulkan device '{}': {}", chosen->properties.deviceName, resultName(result));
        return false;
    }
    if (const char* missing = m_vk.loadDevice(made)) {
        error = fmt::format("Vulkan device '{}' lacks {}", chosen->properties.deviceName, missing);
        if (m_vk.DestroyDevice) m_vk.DestroyDevice(made, nullptr);
        return false;
    }
    m_device = made;
    m_vk.GetDeviceQueue(m_device, m_queueFamily, 0, &m_queue);
    m_caps.fragmentWrites = wants.core.features.fragmentStoresAndAtomics;
    if (wants.core.features.samplerAnisotropy) m_caps.maxAnisotropy = chosen->properties.limits.maxSamplerAnisotropy;
    return true;
}

}  // namespace obscura::gpu
