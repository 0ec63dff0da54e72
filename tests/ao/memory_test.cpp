// Device memory through the API: allocation from host pools, memoryUse() before and after recording, 8-bit output.
#include <map>

#include "ao/host_context.h"
#include "gpu/record.h"

namespace obscura::ao {
namespace {

// A host allocator that suballocates from a few large allocations and counts them.
class Pools {
public:
    explicit Pools(gpu::Device& device) : m_device(device) { device.vk().GetPhysicalDeviceMemoryProperties(device.physical(), &m_types); }
    ~Pools() {
        for (const auto& [type, pool] : m_pools) m_device.vk().FreeMemory(m_device.handle(), pool.memory, nullptr);
    }
    MemoryCallbacks callbacks() { return {&Pools::allocate, &Pools::free, this}; }

    uint64_t allocatedBytes = 0, liveBlocks = 0, allocationCount = 0;  // now, now, in total
    uint64_t failAfter = ~0ull;
    bool misaligned = false, unmapped = false;

private:
    static constexpr uint64_t kPool = 64 << 20;
    struct Pool {
        VkDeviceMemory memory;
        std::byte* mapped;
        uint64_t used;
    };

    static VkResult allocate(void* user, const VkMemoryRequirements& needs, bool mapped, bool, MemoryBlock& block) {
        Pools& own = *static_cast<Pools*>(user);
        if (own.allocationCount >= own.failAfter) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        uint32_t type = 0;
        while (!(needs.memoryTypeBits >> type & 1)) ++type;
        if (!own.m_pools.count(type)) {
            const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, kPool, type};
            Pool pool{};
            EXPECT_EQ(own.m_device.vk().AllocateMemory(own.m_device.handle(), &info, nullptr, &pool.memory), VK_SUCCESS);
            void* address = nullptr;
            if (own.m_types.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
                EXPECT_EQ(own.m_device.vk().MapMemory(own.m_device.handle(), pool.memory, 0, VK_WHOLE_SIZE, 0, &address), VK_SUCCESS);
            }
            pool.mapped = static_cast<std::byte*>(address);
            own.m_pools[type] = pool;
        }
        Pool& pool = own.m_pools[type];
        // Images and buffers lie a page apart, which satisfies bufferImageGranularity of any device.
        const uint64_t alignment = std::max<uint64_t>(needs.alignment, 65536), offset = (pool.used + alignment - 1) / alignment * alignment;
        if (offset + needs.size > kPool) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        pool.used = offset + needs.size;
        EXPECT_TRUE(!mapped || pool.mapped);
        ++own.allocationCount, ++own.liveBlocks;
        own.allocatedBytes += needs.size;
        block = {pool.memory, offset + (own.misaligned ? 1 : 0), mapped && !own.unmapped ? pool.mapped + offset : nullptr,
            reinterpret_cast<void*>(needs.size)};
        return VK_SUCCESS;
    }
    static void free(void* user, const MemoryBlock& block) {
        Pools& own = *static_cast<Pools*>(user);
        --own.liveBlocks;
        own.allocatedBytes -= reinterpret_cast<uint64_t>(block.token);
    }

    gpu::Device& m_device;
    VkPhysicalDeviceMemoryProperties m_types{};
    std::map<uint32_t, Pool> m_pools;
};

class MemoryTest : public ApiTest {
protected:
    // Replaces the fixture's context.
    void again(const DeviceDesc& d) {
        m_device.waitIdle();
        destroy(m_context);
        m_context = nullptr;
        EXPECT_EQ(create(d, &m_context), Status::ok);
    }
    // Records without submitting: memory is allocated when a frame is recorded.
    Output recorded(const Frame& f) {
        Output output;
        test::recordAndDrop(m_device, [&](VkCommandBuffer cmd) { output = record(m_context, cmd, f); });
        return output;
    }
};

TEST_F(MemoryTest, comesFromHostPools) {
    const std::vector<float> own = pixels(once(frame()));
    Pools pools(m_device);
    DeviceDesc d = desc();
    d.memory = pools.callbacks();
    again(d);
    EXPECT_EQ(pixels(once(frame())), own);
    for (const MethodInfo* info : methods()) {
        ASSERT_EQ(setMethod(m_context, info->id, {}), Status::ok);
        ASSERT_EQ(once(frame()).status, Status::ok) << info->id;
        EXPECT_EQ(pools.allocatedBytes, memoryUse(m_context)) << info->id;
    }
    EXPECT_GT(pools.allocationCount, 10u);
    m_device.waitIdle();
    destroy(m_context);
    m_context = nullptr;
    EXPECT_EQ(pools.liveBlocks, 0u);
    EXPECT_EQ(pools.allocatedBytes, 0u);
}

TEST_F(MemoryTest, failedOrInvalidAllocationGivesStatusAndLogLine) {
    Pools pools(m_device);
    DeviceDesc d = desc();
    d.memory = pools.callbacks();
    d.memory.free = nullptr;
    Context* none = nullptr;
    EXPECT_EQ(create(d, &none), Status::invalid);
    EXPECT_TRUE(said("DeviceDesc::memory"));
    d.memory = pools.callbacks();
    again(d);
    pools.failAfter = pools.allocationCount + 1;
    EXPECT_EQ(once(frame()).status, Status::outOfMemory);
    pools.failAfter = ~0ull;
    pools.misaligned = true;
    EXPECT_EQ(once(frame()).status, Status::outOfMemory);
    EXPECT_TRUE(said("the host's memory callback gave offset"));
    pools.misaligned = false;
    EXPECT_EQ(once(frame()).status, Status::ok);
    m_device.waitIdle();
    destroy(m_context);
    m_context = nullptr;
    EXPECT_EQ(pools.liveBlocks, 0u);
    Pools blind(m_device);
    blind.unmapped = true;
    d.memory = blind.callbacks();
    again(d);
    EXPECT_EQ(once(frame()).status, Status::outOfMemory);
    EXPECT_TRUE(said("without its address"));
    m_device.waitIdle();
    destroy(m_context);
    m_context = nullptr;
    EXPECT_EQ(blind.liveBlocks, 0u);
}

// Every method, with history, and in its last preset without: the prediction is exact to the byte and allocates nothing.
TEST_F(MemoryTest, predictionIsExactToTheByte) {
    const Setting history{"temporal", 0.9f};
    size_t cases = 0;
    for (const MethodInfo* info : methods())
        for (const bool temporal : {false, true}) {
            if (temporal && !info->needs) continue;
            const Preset& preset = temporal ? *info->presets.begin() : *(info->presets.end() - 1);
            DeviceDesc d = desc();
            d.format = cases % 2 ? VisibilityFormat::r8 : VisibilityFormat::r16f;
            again(d);
            MethodSettings settings;
            settings.preset = preset.id;
            if (temporal) settings.settings = {&history, 1};
            settings.bentNormals = temporal && info->bentNormals;
            ASSERT_EQ(setMethod(m_context, info->id, settings), Status::ok);
            Frame f = frame();
            if (temporal) f.motion = f.normals;
            Frame plan = f;
            plan.depth.image = plan.normals.image = plan.motion.image = VK_NULL_HANDLE;
            plan.depth.view = plan.normals.view = plan.motion.view = VK_NULL_HANDLE;
            const uint64_t before = memoryUse(m_context), predicted = memoryUse(m_context, plan);
            EXPECT_EQ(memoryUse(m_context), before);
            for (int i = 0; i < 3; ++i, ++f.index) ASSERT_EQ(recorded(f).status, Status::ok) << info->id;
            EXPECT_EQ(predicted, memoryUse(m_context)) << info->id << ":" << preset.id << (temporal ? " with a history" : "");
            EXPECT_EQ(memoryUse(m_context, plan), predicted) << info->id;
            ++cases;
        }
    EXPECT_EQ(cases, 2 * methods().size() - 1);
    Frame f = frame();
    f.size = {};
    EXPECT_EQ(memoryUse(m_context, f), 0u);
    EXPECT_TRUE(said("Frame::size is zero"));
    EXPECT_EQ(memoryUse(nullptr, f), 0u);
}

// memoryUse(frame) between two frames does not change the second.
TEST_F(MemoryTest, predictionDoesNotChangeLaterFrames) {
    const Setting history{"temporal", 0.9f};
    MethodSettings settings;
    settings.settings = {&history, 1};
    const auto second = [&](const char* method, bool ask) {
        EXPECT_EQ(setMethod(m_context, method, settings), Status::ok);
        Frame f = frame();
        f.motion = f.normals;
        f.cut = true;
        EXPECT_TRUE(!ask || memoryUse(m_context, f) > 0);
        once(f);
        f.cut = false;
        Frame other = f;
        other.eyeFromWorld[12] = 3.0f;
        other.motion = {};
        EXPECT_TRUE(!ask || memoryUse(m_context, other) > 0);
        ++f.index;
        return pixels(once(f));
    };
    for (const char* method : {"hbao", "far_field"}) EXPECT_EQ(second(method, true), second(method, false)) << method;
}

TEST_F(MemoryTest, eightBitOutputIsTheRoundedHalfFloat) {
    for (const char* method : {"hbao", "far_field", "none"}) {
        again(desc());
        ASSERT_EQ(setMethod(m_context, method, {}), Status::ok);
        const std::vector<float> wide = pixels(once(frame()));
        DeviceDesc d = desc();
        d.format = VisibilityFormat::r8;
        again(d);
        ASSERT_EQ(setMethod(m_context, method, {}), Status::ok);
        const Output output = once(frame());
        ASSERT_EQ(output.status, Status::ok);
        std::vector<std::byte> bytes;
        ASSERT_EQ(gpu::download(
                      m_device, output.image, {VK_FORMAT_R8_UNORM, m_room.visibleWidth(), m_room.visibleHeight()}, output.layout, bytes),
            gpu::Status::ok);
        ASSERT_EQ(bytes.size(), wide.size());
        for (size_t i = 0; i < bytes.size(); ++i) ASSERT_NEAR(255.0f * wide[i], float(bytes[i]), 0.502f) << method << " pixel " << i;
    }
}

}  // namespace
}  // namespace obscura::ao
