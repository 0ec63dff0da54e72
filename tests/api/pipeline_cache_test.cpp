// DeviceDesc::pipelineCache: the library's pipelines go into the host's cache, which stays the host's.
#include "api/host.h"

namespace obscura::ao {
namespace {

// The pipeline cache of the last pipeline that was made.
struct Seen {
    static inline PFN_vkGetInstanceProcAddr real = nullptr;
    static inline PFN_vkGetDeviceProcAddr realDevice = nullptr;
    static inline PFN_vkCreateComputePipelines create = nullptr;
    static inline VkPipelineCache cache = VK_NULL_HANDLE;
    static inline int caches = 0;  // pipeline caches that the library made
    static inline PFN_vkCreatePipelineCache createCache = nullptr;
    static VkResult VKAPI_CALL makeCache(
        VkDevice device, const VkPipelineCacheCreateInfo* info, const VkAllocationCallbacks* memory, VkPipelineCache* made) {
        ++caches;
        return createCache(device, info, memory, made);
    }
    static VkResult VKAPI_CALL make(VkDevice device, VkPipelineCache given, uint32_t count, const VkComputePipelineCreateInfo* infos,
        const VkAllocationCallbacks* memory, VkPipeline* made) {
        cache = given;
        return create(device, given, count, infos, memory, made);
    }
    static PFN_vkVoidFunction VKAPI_CALL device(VkDevice handle, const char* name) {
        const PFN_vkVoidFunction found = realDevice(handle, name);
        if (std::string(name) == "vkCreateComputePipelines") {
            create = reinterpret_cast<PFN_vkCreateComputePipelines>(found);
            return reinterpret_cast<PFN_vkVoidFunction>(&make);
        }
        if (std::string(name) == "vkCreatePipelineCache") {
            createCache = reinterpret_cast<PFN_vkCreatePipelineCache>(found);
            return reinterpret_cast<PFN_vkVoidFunction>(&makeCache);
        }
        return found;
    }
    static PFN_vkVoidFunction VKAPI_CALL instance(VkInstance handle, const char* name) {
        const PFN_vkVoidFunction found = real(handle, name);
        if (std::string(name) != "vkGetDeviceProcAddr") return found;
        realDevice = reinterpret_cast<PFN_vkGetDeviceProcAddr>(found);
        return reinterpret_cast<PFN_vkVoidFunction>(&device);
    }
};

class PipelineCache : public test::GpuTest {};

TEST_F(PipelineCache, ofTheHostIsUsedAndKept) {
    gpu::Device& device = test::device();
    const gpu::Api& vk = device.vk();
    test::Host host{device};
    const VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    VkPipelineCache cache = VK_NULL_HANDLE;
    ASSERT_EQ(vk.CreatePipelineCache(device.handle(), &info, nullptr, &cache), VK_SUCCESS);
    DeviceDesc desc = host.desc();
    Seen::real = desc.getInstanceProcAddr;
    desc.getInstanceProcAddr = &Seen::instance;
    desc.pipelineCache = cache;
    ASSERT_EQ(create(desc, &host.context), Status::ok) << host.allSaid();
    EXPECT_EQ(Seen::cache, cache);
    EXPECT_EQ(Seen::caches, 0);
    host.clear();
    size_t bytes = 0;
    EXPECT_EQ(vk.GetPipelineCacheData(device.handle(), cache, &bytes, nullptr), VK_SUCCESS);  // validation: it still exists
    vk.DestroyPipelineCache(device.handle(), cache, nullptr);
    desc.pipelineCache = VK_NULL_HANDLE;
    ASSERT_EQ(create(desc, &host.context), Status::ok) << host.allSaid();
    EXPECT_EQ(Seen::caches, 1);
    EXPECT_NE(Seen::cache, cache);
    host.clear();
}

}  // namespace
}  // namespace obscura::ao
