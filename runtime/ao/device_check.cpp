// checkDevice(): whether a device that a host is about to make, or has made, is one that create() can adopt.
#include <string>

#include <fmt/format.h>

#include "ao/context.h"

namespace obscura::ao {
namespace {

struct Features {
    VkBool32 synchronization2 = VK_FALSE, maintenance4 = VK_FALSE, extendedFormats = VK_FALSE;
};

// Those that a pNext chain and pEnabledFeatures turn on.
Features enabled(const VkDeviceCreateInfo& info) {
    Features result;
    if (info.pEnabledFeatures) result.extendedFormats = info.pEnabledFeatures->shaderStorageImageExtendedFormats;
    for (auto* next = static_cast<const VkBaseInStructure*>(info.pNext); next; next = next->pNext) {
        const void* body = next;
        switch (next->sType) {
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2:
                result.extendedFormats |= static_cast<const VkPhysicalDeviceFeatures2*>(body)->features.shaderStorageImageExtendedFormats;
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES: {
                const auto& v13 = *static_cast<const VkPhysicalDeviceVulkan13Features*>(body);
                result.synchronization2 |= v13.synchronization2;
                result.maintenance4 |= v13.maintenance4;
                break;
            }
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES:
                result.synchronization2 |= static_cast<const VkPhysicalDeviceSynchronization2Features*>(body)->synchronization2;
                break;
            case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES:
                result.maintenance4 |= static_cast<const VkPhysicalDeviceMaintenance4Features*>(body)->maintenance4;
                break;
            default: break;
        }
    }
    return result;
}

Status findLacks(const DeviceDesc& desc, const VkDeviceCreateInfo& info, const HostLog& log) {
    Status worst = Status::ok;
    const auto say = [&](Status status, const std::string& line) {
        log(("obscura: checkDevice(): " + line).c_str());
        if (worst != Status::unsupported) worst = status;
    };
    if (!desc.instance || !desc.physicalDevice || !desc.getInstanceProcAddr)
        return say(Status::invalid, "DeviceDesc::instance, physicalDevice and getInstanceProcAddr must be set"), worst;
    gpu::Api vk;
    if (const char* missing = vk.loadInstance(desc.getInstanceProcAddr, desc.instance))
        return say(Status::unsupported, fmt::format("{} is missing; make the instance with VkApplicationInfo::apiVersion 1.3", missing)),
               worst;
    VkPhysicalDeviceProperties properties;
    vk.GetPhysicalDeviceProperties(desc.physicalDevice, &properties);
    if (properties.apiVersion < VK_API_VERSION_1_3)
        return say(Status::unsupported, fmt::format("{} supports Vulkan {}.{}; 1.3 is needed", properties.deviceName,
                                            VK_API_VERSION_MAJOR(properties.apiVersion), VK_API_VERSION_MINOR(properties.apiVersion))),
               worst;

    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v13};
    vk.GetPhysicalDeviceFeatures2(desc.physicalDevice, &features);
    const Features has{v13.synchronization2, v13.maintenance4, features.features.shaderStorageImageExtendedFormats}, on = enabled(info);
    const auto feature = [&](const char* name, VkBool32 supported, VkBool32 isOn) {
        if (!supported) say(Status::unsupported, fmt::format("{} lacks the feature {}", properties.deviceName, name));
        else if (!isOn) say(Status::invalid, fmt::format("the feature {} is not enabled; set it in VkDeviceCreateInfo", name));
    };
    feature("VkPhysicalDeviceVulkan13Features::synchronization2", has.synchronization2, on.synchronization2);
    feature("VkPhysicalDeviceVulkan13Features::maintenance4", has.maintenance4, on.maintenance4);
    feature("VkPhysicalDeviceFeatures::shaderStorageImageExtendedFormats", has.extendedFormats, on.extendedFormats);

    bool made = false;
    for (uint32_t i = 0; i < info.queueCreateInfoCount; ++i) made |= info.pQueueCreateInfos[i].queueFamilyIndex == desc.queueFamily;
    uint32_t count = 0;
    vk.GetPhysicalDeviceQueueFamilyProperties(desc.physicalDevice, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vk.GetPhysicalDeviceQueueFamilyProperties(desc.physicalDevice, &count, families.data());
    if (desc.queueFamily >= count)
        say(Status::invalid, fmt::format("DeviceDesc::queueFamily is {}; {} has {}", desc.queueFamily, properties.deviceName, count));
    else if (!(families[desc.queueFamily].queueFlags & VK_QUEUE_COMPUTE_BIT))
        say(Status::invalid, fmt::format("DeviceDesc::queueFamily {} does not support compute; choose one that does", desc.queueFamily));
    else if (!made)
        say(Status::invalid, fmt::format("DeviceDesc::queueFamily is {}, of which VkDeviceCreateInfo makes no queue", desc.queueFamily));
    return worst;
}

}  // namespace

Status checkDevice(const DeviceDesc& desc, const VkDeviceCreateInfo& info) noexcept {
    const HostLog log{desc.log, desc.logUser};
    return guarded(log, [&] { return findLacks(desc, info, log); });
}

}  // namespace obscura::ao
