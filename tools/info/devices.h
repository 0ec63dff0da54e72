// The Vulkan devices of a machine, checked against the requirements of obscura/ao.h.
#pragma once

#include <string>
#include <vector>

#include <obscura/ao.h>

struct DeviceReport {
    std::string name;                  // as reported by the driver
    std::string type;                  // "discrete GPU", "software", ...
    std::string driver;                // name and version
    uint32_t vulkan = 0;               // VkPhysicalDeviceProperties::apiVersion
    std::vector<std::string> missing;  // unmet requirements; empty: the device can run the library
};

// Every physical device, in the loader's order. On a device that meets the requirements, creates a VkDevice, a context of the library and
// every method's pipelines; failures are listed in `missing`. If no instance can be created, the list is empty and `error` says why.
std::vector<DeviceReport> reportDevices(PFN_vkGetInstanceProcAddr load, std::string& error);

// Device memory of a context with a method's presets, of frames of that size with depth, and depth layers where the method reads them.
struct MemoryReport {
    std::string device;  // the first that can run the library
    struct Preset {
        std::string id;
        uint64_t bytes;
    };
    std::vector<Preset> presets;  // empty: `error` says why
};
MemoryReport reportMemory(
    PFN_vkGetInstanceProcAddr load, const obscura::ao::MethodInfo& method, uint32_t width, uint32_t height, std::string& error);
