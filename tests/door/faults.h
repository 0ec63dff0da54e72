// A Vulkan that fails when told to: stands between the library and the loader, and lets the n-th call that can fail do so. What such a call
// would have given is filled with rubbish, as drivers may.
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
    static inline long countdown = -1;       // calls until one fails; below 0: none does
    static inline std::string only;          // this function alone; empty: all that can fail
    static inline std::string failed;        // the function that did; empty: none yet
    static inline std::string missing;       // what there is no pointer to
    static inline int inside = 0;            // calls of Vulkan under way
    static inline void (*doctor)(const char* name, void* answer) = nullptr;  // changes what the device says of itself

    static void fail(long n, VkResult with, std::string function = {}) {
        countdown = n;
        result = with;
        only = std::move(function);
        failed.clear();
    }
    static void stop() { countdown = -1; }
    // Queries of what is done already, resets and names: they cannot fail, or it does not matter.
    static bool due(const char* name) {
        if (countdown < 0) return false;
        static constexpr const char* kHarmless[] = {"GetQueryPoolResults", "GetEventStatus", "ResetEvent", "ResetDescriptorPool", "SetDebugUtilsObjectNameEXT"};
        const bool harmless = std::any_of(std::begin(kHarmless), std::end(kHarmless), [&](const char* one) { return !std::strcmp(name, one); });
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
// Pipelines and sets come as null when they cannot be made; all else may come as anything.
inline bool comesAsNull(const char* name) { return std::strstr(name, "Pipelines") || !std::strncmp(name, "Allocate", 8) ? std::strcmp(name, "AllocateMemory") != 0 : false; }

template <class Name, class F> struct Wrapped;
template <class Name, class R, class... A> struct Wrapped<Name, R(VKAPI_PTR*)(A...)> {
    static inline R(VKAPI_PTR* real)(A...) = nullptr;
    static VKAPI_ATTR R VKAPI_CALL call(A... a) {
        struct Inside { Inside() { ++Faults::inside; } ~Inside() { --Faults::inside; } } inside;
        if constexpr (std::is_same_v<R, VkResult>) {
            if (Faults::due(Name::text)) {
                if (!comesAsNull(Name::text)) (spoil(a), ...);
                return Faults::result;
            }
        }
        if constexpr (std::is_void_v<R>) {
            real(a...);
            if (Faults::doctor) {
                const void* last = nullptr;
                ((last = [&] { if constexpr (std::is_pointer_v<A>) return (const void*)a; else return last; }()), ...);
                Faults::doctor(Name::text, const_cast<void*>(last));
            }
        } else {
            return real(a...);
        }
    }
};

#define OBSCURA_WRAP(name)                                                                 \
    struct Name##name { static constexpr const char* text = #name; };                      \
    inline PFN_vkVoidFunction wrap##name(PFN_vkVoidFunction real) {                        \
        using W = Wrapped<Name##name, PFN_vk##name>;                                       \
        W::real = (PFN_vk##name)real;                                                      \
        return (PFN_vkVoidFunction)&W::call;                                               \
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
#define OBSCURA_FIND(function) if (!std::strcmp(name, "vk" #function)) return wrap##function(found);
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
