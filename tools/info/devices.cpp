#include "devices.h"

#include <obscura/ao.h>

namespace ao = obscura::ao;

namespace {

struct Functions {
    PFN_vkGetInstanceProcAddr load = nullptr;
    VkInstance instance = VK_NULL_HANDLE;
    template <class Function> Function get(const char* name) const { return reinterpret_cast<Function>(load(instance, name)); }
};

const char* typeName(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete GPU";
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated GPU";
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual GPU";
        case VK_PHYSICAL_DEVICE_TYPE_CPU: return "software";
        default: return "other";
    }
}

int computeFamily(const Functions& vk, VkPhysicalDevice device) {
    const auto query = vk.get<PFN_vkGetPhysicalDeviceQueueFamilyProperties>("vkGetPhysicalDeviceQueueFamilyProperties");
    uint32_t count = 0;
    query(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    query(device, &count, families.data());
    for (uint32_t i = 0; i < count; ++i)
        if (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) return int(i);
    return -1;
}

void onLine(void* user, ao::Severity severity, const char* line) {
    if (severity == ao::Severity::error) static_cast<std::vector<std::string>*>(user)->push_back(line);
}

// Creates the device and a context and calls use(context); appends failures to `missing`.
template <class Use> void withContext(
    const Functions& vk, VkPhysicalDevice physical, uint32_t family, std::vector<std::string>& missing, Use use) {
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    v13.synchronization2 = v13.maintenance4 = VK_TRUE;
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v13, {}};
    features.features.shaderStorageImageExtendedFormats = VK_TRUE;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    VkDevice device = VK_NULL_HANDLE;
    if (const VkResult result = vk.get<PFN_vkCreateDevice>("vkCreateDevice")(physical, &info, nullptr, &device)) {
        missing.push_back("vkCreateDevice failed with VkResult " + std::to_string(result));
        return;
    }
    ao::DeviceDesc desc;
    desc.instance = vk.instance;
    desc.physicalDevice = physical;
    desc.device = device;
    desc.queueFamily = family;
    desc.getInstanceProcAddr = vk.load;
    desc.log = onLine;
    desc.logUser = &missing;
    ao::Context* context = nullptr;
    if (ao::create(desc, &context) == ao::Result::ok) use(context);
    else if (missing.empty()) missing.push_back("obscura::ao::create failed");
    ao::destroy(context);
    vk.get<PFN_vkDestroyDevice>("vkDestroyDevice")(device, nullptr);
}

// Makes every method's pipelines; appends failures to `missing`.
void prove(const Functions& vk, VkPhysicalDevice physical, uint32_t family, std::vector<std::string>& missing) {
    withContext(vk, physical, family, missing, [&](ao::Context* context) {
        for (const ao::MethodInfo* method : ao::methods())
            if (ao::setMethod(context, method->id, {}) != ao::Result::ok)
                missing.push_back(std::string("setMethod(") + method->id + ") failed");
    });
}

// What a device lacks to run the library; without making one.
std::vector<std::string> lacking(const Functions& vk, VkPhysicalDevice physical) {
    std::vector<std::string> missing;
    VkPhysicalDeviceProperties core{};
    vk.get<PFN_vkGetPhysicalDeviceProperties>("vkGetPhysicalDeviceProperties")(physical, &core);
    if (core.apiVersion < VK_API_VERSION_1_3) return {"Vulkan 1.3"};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v13, {}};
    vk.get<PFN_vkGetPhysicalDeviceFeatures2>("vkGetPhysicalDeviceFeatures2")(physical, &features);
    if (!v13.synchronization2) missing.push_back("feature synchronization2");
    if (!v13.maintenance4) missing.push_back("feature maintenance4");
    if (!features.features.shaderStorageImageExtendedFormats) missing.push_back("feature shaderStorageImageExtendedFormats");
    if (computeFamily(vk, physical) < 0) missing.push_back("a queue family that does compute");
    return missing;
}

DeviceReport report(const Functions& vk, VkPhysicalDevice physical) {
    DeviceReport result;
    VkPhysicalDeviceProperties core{};
    vk.get<PFN_vkGetPhysicalDeviceProperties>("vkGetPhysicalDeviceProperties")(physical, &core);
    result.name = core.deviceName;
    result.type = typeName(core.deviceType);
    result.vulkan = core.apiVersion;
    result.missing = lacking(vk, physical);
    if (core.apiVersion < VK_API_VERSION_1_3) return result;
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver, {}};
    vk.get<PFN_vkGetPhysicalDeviceProperties2>("vkGetPhysicalDeviceProperties2")(physical, &properties);
    result.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    if (result.missing.empty()) prove(vk, physical, uint32_t(computeFamily(vk, physical)), result.missing);
    return result;
}

// Makes an instance, calls use(functions, devices) and destroys it. False: there is none, and `error` says why.
template <class Use> bool withDevices(PFN_vkGetInstanceProcAddr load, std::string& error, Use use) {
    Functions vk{load, VK_NULL_HANDLE};
    const auto version = vk.get<PFN_vkEnumerateInstanceVersion>("vkEnumerateInstanceVersion");
    uint32_t offered = VK_API_VERSION_1_0;
    if (version) version(&offered);
    if (offered < VK_API_VERSION_1_3) {
        error = "the Vulkan loader is older than Vulkan 1.3";
        return false;
    }
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "obscura-info";
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    if (const VkResult result = vk.get<PFN_vkCreateInstance>("vkCreateInstance")(&info, nullptr, &vk.instance)) {
        error = result == VK_ERROR_INCOMPATIBLE_DRIVER ? "no Vulkan driver is installed"
                                                       : "vkCreateInstance failed with VkResult " + std::to_string(result);
        return false;
    }
    const auto enumerate = vk.get<PFN_vkEnumeratePhysicalDevices>("vkEnumeratePhysicalDevices");
    uint32_t count = 0;
    enumerate(vk.instance, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    enumerate(vk.instance, &count, devices.data());
    devices.resize(count);
    use(vk, devices);
    vk.get<PFN_vkDestroyInstance>("vkDestroyInstance")(vk.instance, nullptr);
    return true;
}

// A frame with every input that the method reads; formats alone, as memoryUse() asks.
ao::Frame frameFor(uint32_t needs, uint32_t width, uint32_t height) {
    ao::Frame frame;
    frame.size = {width, height};
    const float projection[16] = {1, 0, 0, 0, 0, float(width) / float(height), 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0};
    for (int i = 0; i < 16; ++i) frame.projection[i] = projection[i];
    frame.depth.format = VK_FORMAT_D32_SFLOAT;
    if (needs & ao::kLayers) frame.layers.thickness.format = VK_FORMAT_R16_SFLOAT;
    return frame;
}

}  // namespace

std::vector<DeviceReport> reportDevices(PFN_vkGetInstanceProcAddr load, std::string& error) {
    std::vector<DeviceReport> reports;
    withDevices(load, error, [&](const Functions& vk, const std::vector<VkPhysicalDevice>& devices) {
        reports.reserve(devices.size());
        for (VkPhysicalDevice device : devices) reports.push_back(report(vk, device));
    });
    return reports;
}

MemoryReport reportMemory(
    PFN_vkGetInstanceProcAddr load, const ao::MethodInfo& method, uint32_t width, uint32_t height, std::string& error) {
    MemoryReport result;
    withDevices(load, error, [&](const Functions& vk, const std::vector<VkPhysicalDevice>& devices) {
        for (VkPhysicalDevice device : devices) {
            if (!lacking(vk, device).empty()) continue;
            VkPhysicalDeviceProperties core{};
            vk.get<PFN_vkGetPhysicalDeviceProperties>("vkGetPhysicalDeviceProperties")(device, &core);
            result.device = core.deviceName;
            std::vector<std::string> failures;
            withContext(vk, device, uint32_t(computeFamily(vk, device)), failures, [&](ao::Context* context) {
                for (const ao::Preset& preset : method.presets) {
                    ao::MethodSettings settings;
                    settings.preset = preset.id;
                    if (ao::setMethod(context, method.id, settings) != ao::Result::ok) continue;
                    result.presets.push_back({preset.id, ao::memoryUse(context, frameFor(method.needs, width, height))});
                }
            });
            if (!failures.empty()) error = failures.front();
            return;
        }
        error = "no device can run the library; obscura-info --devices says why";
    });
    return result;
}
