// Opens the Vulkan loader at run time, so that obscura-info can report a missing one.
#pragma once

#include <vulkan/vulkan_core.h>

// vkGetInstanceProcAddr of vulkan-1.dll, libvulkan.so.1 or libvulkan.1.dylib; null if there is none. Stays loaded.
PFN_vkGetInstanceProcAddr openLoader();
const char* loaderName();
