// Fault injection between the library and the Vulkan loader: makes the n-th call that can fail return an error. The outputs of the failed
// call are filled with garbage, as the specification allows.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <type_traits>

#include "gpu/api.h"

namespace obscura::test {

struct Faults {
    static inline PFN_vkGetInstanceProcAddr real = nullptr;
    static inline PFN_vkGetDeviceProcAddr realDevice = nullptr;
    static inline VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    static inline long countdown = -1;                                     // calls until one fails; below 0: none fails
    static inline std::string only;                                        // the only function that may fail; empty: all that can
    static inline std::string failed;                                      // the function that failed; empty: none yet
    static inline std::string missing;                                     // function for which getInstanceProcAddr returns null
    static inline int inside = 0;                                          // depth of nested Vulkan calls
    static inline void (*edit)(const char* name, void* answer) = nullptr;  // edits results of device queries

    static void fail(long n, VkResult with, std::string function = {}) {
        countdown = n;
        result = with;
        only = std::move(function);
        failed.clear();
    }
    static void stop() { countdown = -1; }
    // Queries, resets and debug names: they cannot fail, or the failure has no effect.
    static bool due(const char* name) {
        if (countdown < 0) return false;
        static constexpr const char* kHarmless[] = {
            "GetQueryPoolResults", "GetEventStatus", "ResetEvent", "ResetDescriptorPool", "SetDebugUtilsObjectNameEXT"};
        const bool harmless =
            std::any_of(std::begin(kHarmless), std::end(kHarmless), [&](const char* one) { return !std::strcmp(name, one); });
        if (only.empty() ? harmless : only != name) return false;
        if (countdown-- > 0) return false;
        failed = name;
        return true;
    }
    static PFN_vkVoidFunction VKAPI_CALL instanceProc(VkInstance instance, const char* name);
    static PFN_vkVoidFunction VKAPI_CALL deviceProc(VkDevice device, const char* name);
};

template <class T> void spoil(T) {}
template <class T> void spoil(T** handle) {
    if constexpr (!std::is_void_v<T> && !std::is_const_v<T>) *handle = reinterpret_cast<T*>(uintptr_t(0xbad));
}
// Failed pipelines are null by specification, sets as well; other outputs are undefined.
inline bool comesAsNull(const char* name) {
    return std::strstr(name, "Pipelines") || !std::strncmp(name, "Allocate", 8) ? std::strcmp(name, "AllocateMemory") != 0 : false;
}

template <class Name, class F> struct Wrapped;
template <class Name, class R, class... A> struct Wrapped<Name, R(VKAPI_PTR*)(A...)> {
    static inline R(VKAPI_PTR* real)(A...) = nullptr;
    static VKAPI_ATTR R VKAPI_CALL call(A... a) {
        struct Inside {
            Inside() { ++Faults::inside; }
            ~Inside() { --Faults::inside; }
        } inside;
        if constexpr (std::is_same_v<R, VkResult>) {
            if (Faults::due(Name::text)) {
                if (!comesAsNull(Name::text)) (spoil(a), ...);
                return Faults::result;
            }
        }
        if constexpr (std::is_void_v<R>) {
            real(a...);
            if (Faults::edit) {
                const void* last = nullptr;
                ((last =
                         [&] {
                             if constexpr (std::is_pointer_v<A>) return (const void*)a;
                             else return last;
                         }()),
                    ...);
                Faults::edit(Name::text, const_cast<void*>(last));
            }
        } else {
            return real(a...);
        }
    }
};

#define OBSCURA_WRAP(name)                                          \
    struct Name##name {                                             \
        static constexpr const char* text = #name;                  \
    };                                                              \
    inline PFN_vkVoidFunction wrap##name(PFN_vkVoidFunction real) { \
        using W = Wrapped<Name##name, PFN_vk##name>;                \
        W::real = (PFN_vk##name)real;                               \
        return (PFN_vkVoidFunction) & W::call;                      \
    }
OBSCURA_VK_DEVICE(OBSCURA_WRAP)
OBSCURA_VK_DEVICE_OPTIONAL(OBSCURA_WRAP)
OBSCURA_WRAP(GetPhysicalDeviceProperties)
OBSCURA_WRAP(GetPhysicalDeviceFeatures2)
OBSCURA_WRAP(GetPhysicalDeviceMemoryProperties)
OBSCURA_WRAP(GetPhysicalDeviceQueueFamilyProperties)
OBSCURA_WRAP(GetPhysicalDeviceFormatProperties)
#undef OBSCURA_WRAP

inline PFN_vkVoidFunction VKAPI_CALL Faults::deviceProc(VkDevice device, const char* name) {
    const PFN_vkVoidFunction found = missing == name ? nullptr : realDevice(device, name);
    if (!found) return nullptr;
#define OBSCURA_FIND(function) \
    if (!std::strcmp(name, "vk" #function)) return wrap##function(found);
    OBSCURA_VK_DEVICE(OBSCURA_FIND)
    OBSCURA_VK_DEVICE_OPTIONAL(OBSCURA_FIND)
    return found;
}

inline PFN_vkVoidFunction VKAPI_CALL Faults::instanceProc(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction found = missing == name ? nullptr : real(instance, name);
    if (!found) return nullptr;
    if (!std::strcmp(name, "vkGetDeviceProcAddr")) {
        realDevice = (PFN_vkGetDeviceProcAddr)found;
        return (PFN_vkVoidFunction)&deviceProc;
    }
    OBSCURA_FIND(GetPhysicalDeviceProperties)
    OBSCURA_FIND(GetPhysicalDeviceFeatures2)
    OBSCURA_FIND(GetPhysicalDeviceMemoryProperties)
    OBSCURA_FIND(GetPhysicalDeviceQueueFamilyProperties)
    OBSCURA_FIND(GetPhysicalDeviceFormatProperties)
#undef OBSCURA_FIND
    return found;
}

}  // namespace obscura::test
