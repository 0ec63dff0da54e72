#include "gpu/result.h"

#include <algorithm>

namespace obscura::gpu {

const char* name(Status status) {
    switch (status) {
        case Status::ok: return "ok";
        case Status::invalid: return "invalid";
        case Status::unsupported: return "unsupported";
        case Status::outOfMemory: return "out of memory";
        case Status::deviceLost: return "device lost";
        case Status::shaderError: return "shader error";
        case Status::outOfDate: return "out of date";
    }
    return "unknown";
}

Status fromVulkan(VkResult result) {
    switch (result) {
        case VK_SUCCESS:
        case VK_SUBOPTIMAL_KHR: return Status::ok;
        case VK_ERROR_OUT_OF_HOST_MEMORY:
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        case VK_ERROR_MEMORY_MAP_FAILED:
        case VK_ERROR_OUT_OF_POOL_MEMORY:
        case VK_ERROR_FRAGMENTED_POOL:
        case VK_ERROR_FRAGMENTATION:
        case VK_ERROR_TOO_MANY_OBJECTS: return Status::outOfMemory;
        case VK_ERROR_DEVICE_LOST: return Status::deviceLost;
        case VK_ERROR_OUT_OF_DATE_KHR:
        case VK_ERROR_SURFACE_LOST_KHR: return Status::outOfDate;
        case VK_ERROR_INVALID_SHADER_NV: return Status::shaderError;
        case VK_ERROR_FEATURE_NOT_PRESENT:
        case VK_ERROR_EXTENSION_NOT_PRESENT:
        case VK_ERROR_LAYER_NOT_PRESENT:
        case VK_ERROR_FORMAT_NOT_SUPPORTED:
        case VK_ERROR_INCOMPATIBLE_DRIVER: return Status::unsupported;
        default: return Status::invalid;
    }
}

// clang-format off
const char* resultName(VkResult result) {
    switch (result) {
#define OBSCURA_CASE(value) case value: return #value;
        OBSCURA_CASE(VK_SUCCESS) OBSCURA_CASE(VK_NOT_READY) OBSCURA_CASE(VK_TIMEOUT) OBSCURA_CASE(VK_INCOMPLETE)
        OBSCURA_CASE(VK_ERROR_OUT_OF_HOST_MEMORY) OBSCURA_CASE(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        OBSCURA_CASE(VK_ERROR_INITIALIZATION_FAILED) OBSCURA_CASE(VK_ERROR_DEVICE_LOST)
        OBSCURA_CASE(VK_ERROR_MEMORY_MAP_FAILED) OBSCURA_CASE(VK_ERROR_LAYER_NOT_PRESENT)
        OBSCURA_CASE(VK_ERROR_EXTENSION_NOT_PRESENT) OBSCURA_CASE(VK_ERROR_FEATURE_NOT_PRESENT)
        OBSCURA_CASE(VK_ERROR_INCOMPATIBLE_DRIVER) OBSCURA_CASE(VK_ERROR_TOO_MANY_OBJECTS)
        OBSCURA_CASE(VK_ERROR_FORMAT_NOT_SUPPORTED) OBSCURA_CASE(VK_ERROR_FRAGMENTED_POOL)
        OBSCURA_CASE(VK_ERROR_OUT_OF_POOL_MEMORY) OBSCURA_CASE(VK_ERROR_FRAGMENTATION)
        OBSCURA_CASE(VK_ERROR_SURFACE_LOST_KHR) OBSCURA_CASE(VK_ERROR_OUT_OF_DATE_KHR) OBSCURA_CASE(VK_SUBOPTIMAL_KHR)
        OBSCURA_CASE(VK_ERROR_INVALID_SHADER_NV) OBSCURA_CASE(VK_ERROR_UNKNOWN)
#undef OBSCURA_CASE
        default: return "an unnamed VkResult";
    }
}
// clang-format on

const char* typeName(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete";
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated";
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual";
        case VK_PHYSICAL_DEVICE_TYPE_CPU: return "cpu";
        default: return "other";
    }
}

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : char(c); });
    return text;
}

}  // namespace obscura::gpu
