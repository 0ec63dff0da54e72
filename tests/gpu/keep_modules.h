// Keeps Vulkan layers and drivers loaded for the leak checker. Unloaded with their instance, memory held by their globals would be
// reported as leaked, without symbols that a suppression could name. The validation layer itself leaks a little with every instance.
// (It reports leaked Vulkan objects when the device is destroyed.)
#pragma once

#if defined(__SANITIZE_ADDRESS__)
#define OBSCURA_KEEP_MODULES
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define OBSCURA_KEEP_MODULES
#endif
#endif

#ifdef OBSCURA_KEEP_MODULES
#include <string>
#include <vector>

#include <dlfcn.h>
#include <link.h>

extern "C" __attribute__((used)) inline const char* __lsan_default_suppressions() {
    return "leak:libVkLayer_khronos_validation\nleak:libvulkan_lvp\n";
}
#endif

namespace obscura::test {

inline void keepModules() {
#ifdef OBSCURA_KEEP_MODULES
    std::vector<std::string> names;
    dl_iterate_phdr(
        [](dl_phdr_info* info, size_t, void* list) {
            static_cast<std::vector<std::string>*>(list)->emplace_back(info->dlpi_name);
            return 0;
        },
        &names);
    for (const std::string& name : names)
        if (name.starts_with('/')) {
            if (void* module = dlopen(name.c_str(), RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE)) dlclose(module);
        }
#endif
}

}  // namespace obscura::test
