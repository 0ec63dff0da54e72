#include "gpu/result.h"

// api.h turns the prototypes off; this is the only one the project links against.
extern "C" VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance, const char* name);

namespace obscura::gpu {

PFN_vkGetInstanceProcAddr systemLoader() { return &vkGetInstanceProcAddr; }

}  // namespace obscura::gpu
