#include "gpu/api.h"

namespace obscura::gpu {

const char* Api::loadInstance(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance) {
    GetInstanceProcAddr = getInstanceProcAddr;
#define OBSCURA_VK_LOAD(name) name = (PFN_vk##name)getInstanceProcAddr(instance, "vk" #name);
#define OBSCURA_VK_REQUIRE(name) OBSCURA_VK_LOAD(name) if (!name) return "vk" #name;
    OBSCURA_VK_INSTANCE(OBSCURA_VK_REQUIRE)
    OBSCURA_VK_INSTANCE_OPTIONAL(OBSCURA_VK_LOAD)
#undef OBSCURA_VK_REQUIRE
#undef OBSCURA_VK_LOAD
    return nullptr;
}

const char* Api::loadDevice(VkDevice device) {
#define OBSCURA_VK_LOAD(name) name = (PFN_vk##name)GetDeviceProcAddr(device, "vk" #name);
#define OBSCURA_VK_REQUIRE(name) OBSCURA_VK_LOAD(name) if (!name) return "vk" #name;
    OBSCURA_VK_DEVICE(OBSCURA_VK_REQUIRE)
    OBSCURA_VK_DEVICE_OPTIONAL(OBSCURA_VK_LOAD)
#undef OBSCURA_VK_REQUIRE
#undef OBSCURA_VK_LOAD
    return nullptr;
}

}  // namespace obscura::gpu
