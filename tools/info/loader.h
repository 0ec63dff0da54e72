// The machine's Vulkan loader, opened while the program runs, so that a machine without one gets a sentence, not a missing DLL.
#pragma once

#include <vulkan/vulkan_core.h>

// vkGetInstanceProcAddr of vulkan-1.dll, libvulkan.so.1 or libvulkan.1.dylib; null where there is none. Stays loaded.
PFN_vkGetInstanceProcAddr openLoader();
const char* loaderName();
