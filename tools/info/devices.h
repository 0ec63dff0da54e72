// The Vulkan devices of a machine, held against what obscura/ao.h asks of a host's device.
#pragma once

#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

struct DeviceReport {
    std::string name;                  // as the driver says it
    std::string type;                  // "discrete GPU", "software", ...
    std::string driver;                // name and version
    uint32_t vulkan = 0;               // VkPhysicalDeviceProperties::apiVersion
    std::vector<std::string> missing;  // one text a requirement; empty: the device can run the library
};

// Every physical device, in the loader's order. For a device that has what is required, the proof: a VkDevice with those features,
// a context of the library on it, every method's pipelines; what fails there is in `missing` too. On failure of the instance the
// list is empty and `error` says why.
std::vector<DeviceReport> reportDevices(PFN_vkGetInstanceProcAddr load, std::string& error);
