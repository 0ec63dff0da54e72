// What Vulkan answered, in words. Private to gpu.
#pragma once

#include <string>

#include "gpu/device.h"

namespace obscura::gpu {

const char* resultName(VkResult result);
const char* typeName(VkPhysicalDeviceType type);
std::string lowerCase(std::string text);

// Logs the line as an error and returns the status: `return fail(device, Status::invalid, "image 'x': ...")`.
inline Status fail(const Device& device, Status status, const std::string& line) {
    device.log(Severity::error, line);
    device.noteFailure(status);
    return status;
}

// The system's Vulkan loader. Its own file, so that a program that only adopts devices never pulls in libvulkan.
PFN_vkGetInstanceProcAddr systemLoader();

}  // namespace obscura::gpu
