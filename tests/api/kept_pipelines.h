// Compute pipelines shared by all contexts on one device. The software driver translates a shader at every vkCreateComputePipelines (half a
// second for NanoVDB), and the fault tests create hundreds of contexts. Intercepts calls between a context and the loader: each SPIR-V with
// its specialization constants gets one pipeline, which lives as long as the device. Pipeline layouts follow from the shader, so the key
// omits them. This hides pipelines that are destroyed while in flight, and leaked pipelines: the latter are counted here.
#pragma once

#include <cstring>
#include <map>
#include <string>

#include "gpu/test_device.h"

namespace obscura::test {

class KeptPipelines {
public:
    // Call once for each device. Contexts that load their entry points through instanceProc() then share pipelines.
    static void attach(gpu::Device& device) {
        if (s_device == device.handle()) return;
        auto& vk = const_cast<gpu::Api&>(device.vk());  // every Device object is non-const
        s_device = device.handle();
        s_real = vk;
        vk.DestroyDevice = &destroyDevice;
    }
    static PFN_vkVoidFunction VKAPI_CALL instanceProc(VkInstance instance, const char* name) {
        if (!std::strcmp(name, "vkGetDeviceProcAddr")) return reinterpret_cast<PFN_vkVoidFunction>(&deviceProc);
        return s_real.GetInstanceProcAddr(instance, name);
    }
    // Number of pipelines that contexts have created and not destroyed.
    static long owned() {
        long sum = 0;
        for (const auto& [key, kept] : s_kept) sum += kept.owners;
        return sum;
    }

private:
    struct Kept {
        VkPipeline pipeline = VK_NULL_HANDLE;
        long owners = 0;
    };
    static inline VkDevice s_device = VK_NULL_HANDLE;
    static inline gpu::Api s_real;
    static inline std::map<VkShaderModule, std::string> s_code;  // SPIR-V
    static inline std::map<std::string, Kept> s_kept;            // by SPIR-V and constants
    static inline std::map<VkPipeline, Kept*> s_handedOut;

    static PFN_vkVoidFunction VKAPI_CALL deviceProc(VkDevice device, const char* name) {
        if (!std::strcmp(name, "vkCreateShaderModule")) return reinterpret_cast<PFN_vkVoidFunction>(&createShaderModule);
        if (!std::strcmp(name, "vkCreateComputePipelines")) return reinterpret_cast<PFN_vkVoidFunction>(&createComputePipelines);
        if (!std::strcmp(name, "vkDestroyPipeline")) return reinterpret_cast<PFN_vkVoidFunction>(&destroyPipeline);
        return s_real.GetDeviceProcAddr(device, name);
    }
    static VkResult VKAPI_CALL createShaderModule(
        VkDevice device, const VkShaderModuleCreateInfo* info, const VkAllocationCallbacks* host, VkShaderModule* made) {
        const VkResult result = s_real.CreateShaderModule(device, info, host, made);
        if (result == VK_SUCCESS) s_code[*made].assign(reinterpret_cast<const char*>(info->pCode), info->codeSize);
        return result;
    }
    static VkResult VKAPI_CALL createComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
        const VkComputePipelineCreateInfo* infos, const VkAllocationCallbacks* host, VkPipeline* made) {
        EXPECT_EQ(count, 1u);
        EXPECT_EQ(host, nullptr) << "a pipeline from a host's own memory cannot be shared";
        std::string key = s_code[infos->stage.module];
        if (const VkSpecializationInfo* constants = infos->stage.pSpecializationInfo) {
            key.append(reinterpret_cast<const char*>(constants->pMapEntries), constants->mapEntryCount * sizeof(VkSpecializationMapEntry));
            key.append(static_cast<const char*>(constants->pData), constants->dataSize);
        }
        Kept& kept = s_kept[key];
        if (!kept.pipeline) {
            const VkResult result = s_real.CreateComputePipelines(device, cache, 1, infos, nullptr, &kept.pipeline);
            if (result != VK_SUCCESS) return result;
            s_handedOut[kept.pipeline] = &kept;
        }
        ++kept.owners;
        *made = kept.pipeline;
        return VK_SUCCESS;
    }
    static void VKAPI_CALL destroyPipeline(VkDevice, VkPipeline pipeline, const VkAllocationCallbacks*) {
        if (!pipeline) return;
        const auto kept = s_handedOut.find(pipeline);
        if (kept == s_handedOut.end() || --kept->second->owners < 0) ADD_FAILURE() << "a pipeline was destroyed twice or is unknown";
    }
    static void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* host) {
        for (const auto& [key, kept] : s_kept) s_real.DestroyPipeline(device, kept.pipeline, nullptr);
        s_real.DestroyDevice(device, host);
    }
};

}  // namespace obscura::test
