// Failing Vulkan calls, allocations and invalid input: each gives a Status and a log line, leaks nothing, and the next attempt succeeds.
// Validation checks objects, layouts and hazards throughout, and reports leaked objects when the device is destroyed.
#include <cstdio>
#include <cstdlib>
#include <new>

#include "api/faults.h"
#include "api/host.h"
#include "api/kept_pipelines.h"

namespace {

thread_local long newsUntilFailure = -1;  // calls of the library's operator new until one throws; below 0: none does. Not on driver threads

}  // namespace

[[gnu::noinline]] void* operator new(size_t bytes) {
    if (newsUntilFailure >= 0 && obscura::test::Faults::inside == 0 && newsUntilFailure-- == 0) throw std::bad_alloc();
    if (void* memory = std::malloc(bytes ? bytes : 1)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(size_t bytes, const std::nothrow_t&) noexcept { return std::malloc(bytes ? bytes : 1); }
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace obscura::ao {
namespace {

using test::Faults;

// VkAllocationCallbacks whose n-th allocation fails.
struct HostMemory {
    static inline long until = -1;
    static void* VKAPI_CALL allocate(void*, size_t bytes, size_t alignment, VkSystemAllocationScope) {
        if (until >= 0 && until-- == 0) return nullptr;
        return std::aligned_alloc(std::max<size_t>(alignment, 16),
            (bytes + std::max<size_t>(alignment, 16) - 1) / std::max<size_t>(alignment, 16) * std::max<size_t>(alignment, 16));
    }
    static void* VKAPI_CALL reallocate(void*, void* old, size_t bytes, size_t, VkSystemAllocationScope) {
        if (until >= 0 && until-- == 0) return nullptr;
        return std::realloc(old, bytes);
    }
    static void VKAPI_CALL free(void*, void* memory) { std::free(memory); }
};

class Faulty : public test::GpuTest {
protected:
    gpu::Device& m_device = test::device();
    test::Host m_host{m_device};
    DeviceDesc m_desc = m_host.desc();
    Frame m_small, m_large;
    std::vector<float> m_expected;  // of m_large
    VkExtent2D m_size{};

    void SetUp() override {
        GpuTest::SetUp();
        test::KeptPipelines::attach(m_device);
        useOwnPipelines(false);
        m_host.ownCalls = &Faults::inside;
        m_desc.getInstanceProcAddr = &Faults::instanceProc;
        m_desc.log = [](void* host, Severity, const char* line) {
            ++Faults::inside;  // allocations of the host's log callback do not count
            static_cast<test::Host*>(host)->lines.emplace_back(line);
            --Faults::inside;
        };
    }
    void TearDown() override {
        Faults::stop();
        Faults::missing.clear();
        Faults::edit = nullptr;
        m_host.clear();
        EXPECT_EQ(test::KeptPipelines::owned(), 0) << "pipelines leaked by contexts";
        GpuTest::TearDown();
    }
    // Makes two frames of different sizes with every optional input, and the expected visibility of the larger.
    void prepare(const char* method) {
        m_host.submits = true;
        for (const bool large : {false, true}) {
            test::Geometry g;
            g.visible = large ? VkExtent2D{40, 24} : VkExtent2D{24, 16};
            g.guard = {4, 4};
            const test::Picture picture = test::trace(g);
            Frame& f = large ? m_large : m_small;
            // The host caches images by name, so each frame uses its own names.
            f = m_host.frame({g}, picture, large ? " of the large" : " of the small");
            f.motion = m_host.floats(large ? "motion of the large" : "motion of the small", VK_FORMAT_R32G32_SFLOAT, f.size,
                std::vector<float>(picture.depth.size() * 2, 0.0f));
            if (large) m_size = g.visible;
        }
        ASSERT_EQ(create(m_desc, &m_host.context), Status::ok) << m_host.allSaid();
        ASSERT_EQ(choose(method), Status::ok) << m_host.allSaid();
        const Output output = m_host.record(m_large);
        ASSERT_EQ(output.status, Status::ok) << m_host.allSaid();
        m_expected = m_host.pixels(output, m_size);
        done();
    }
    Status choose(const char* method) {
        static const Setting both[] = {
            {"temporal", 0.9f}, {"offscreen", 2.0f}};  // of the methods with the off-screen pass only hbao turns it on
        MethodSettings settings;
        if (findMethod(method)->needs) settings.settings = {both, std::string(method) == "hbao" && !m_desc.allocator ? 2u : 1u};
        return setMethod(m_host.context, method, settings);
    }
    void done() {
        destroy(m_host.context);
        m_host.context = nullptr;
    }
    // Creates a context and records three frames; returns the first Status that is not ok.
    Status recordFrames(const char* method) {
        Status status = m_host.context ? Status::ok : create(m_desc, &m_host.context);
        EXPECT_EQ(status == Status::ok, m_host.context != nullptr);
        if (status == Status::ok) status = choose(method);
        for (const Frame* frame : {&m_small, &m_large, &m_large}) {
            if (status != Status::ok) return status;
            const Output output = m_host.record(*frame);
            status = output.status;
            EXPECT_EQ(status == Status::ok, output.image != VK_NULL_HANDLE);
        }
        return status;
    }
    // After a failure the same context, or a new one if none was created, works again.
    void recover(const char* method, const std::string& after) {
        m_host.lines.clear();
        ASSERT_EQ(recordFrames(method), Status::ok) << after << "\n" << m_host.allSaid();
        Frame f = m_large;
        f.cut = true;
        const Output output = m_host.record(f);
        ASSERT_EQ(output.status, Status::ok) << after;
        if (m_host.submits) {
            ASSERT_EQ(m_host.pixels(output, m_size), m_expected) << after;
        }
        done();
    }
    // On a software device creating pipelines takes longest, then running them. So one case in six submits what it records, and one in 24
    // creates its own pipelines; with OBSCURA_SOAK one in six does both.
    void runSome() {
        m_host.submits = m_cases % 6 == 0;
        useOwnPipelines(m_cases % (std::getenv("OBSCURA_SOAK") ? 6 : 24) == 0);
        ++m_cases;
    }
    void useOwnPipelines(bool own) {
        if (m_desc.allocator) own = true;  // pipelines from a host's own memory cannot be shared
        Faults::real = own ? m_device.vk().GetInstanceProcAddr : &test::KeptPipelines::instanceProc;
    }
    static inline uint32_t m_cases = 0;  // counted over all tests of this process
    void expectStatusAndLine(Status found, Status expected, const std::string& what) {
        ASSERT_EQ(found, expected) << what << "\n" << m_host.allSaid();
        ASSERT_FALSE(m_host.lines.empty()) << what;
        ASSERT_LE(m_host.lines.size(), 2u) << what << "\n" << m_host.allSaid();
        m_host.lines.clear();
    }
};

class FaultyMethod : public Faulty, public testing::WithParamInterface<const char*> {};

TEST_P(FaultyMethod, everyFailingCallIsReportedAndRecovered) {
    prepare(GetParam());
    // Every n-th call, more of them for one method; a soak tests all.
    const long stride = std::getenv("OBSCURA_SOAK") ? 1 : std::string(GetParam()) == "hbao" ? 5 : 29;
    long calls = 0;
    for (const VkResult result : {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY})
        // The second round tests only a few calls: only the error code differs.
        for (long n = result == VK_ERROR_OUT_OF_HOST_MEMORY ? 3 : 0;; n += result == VK_ERROR_OUT_OF_HOST_MEMORY ? 31 : stride) {
            runSome();
            Faults::fail(n, result);
            const Status status = recordFrames(GetParam());
            Faults::stop();
            if (Faults::failed.empty()) {
                done();
                break;
            }
            ++calls;
            // A failed descriptor set allocation counts as an exhausted pool; the next pool is used.
            if (status != Status::ok || Faults::failed != "AllocateDescriptorSets")
                expectStatusAndLine(status, Status::outOfMemory, "call " + std::to_string(n) + ", " + Faults::failed);
            recover(GetParam(), "after call " + std::to_string(n) + ", " + Faults::failed);
            if (HasFatalFailure()) return;
        }
    std::printf("  %-20s %ld calls made to fail in turn\n", GetParam(), calls);
}

// vkCreateComputePipelines fails with VK_ERROR_UNKNOWN.
TEST_P(FaultyMethod, everyFailingPipelineIsNamedAndRecovered) {
    prepare(GetParam());
    for (long n = 0;; n += std::getenv("OBSCURA_SOAK") ? 1 : 9) {
        runSome();
        Faults::fail(n, VK_ERROR_UNKNOWN, "CreateComputePipelines");
        const Status status = recordFrames(GetParam());
        Faults::stop();
        if (Faults::failed.empty()) break;
        ASSERT_TRUE(m_host.said(".comp")) << m_host.allSaid();
        expectStatusAndLine(status, Status::shaderError, "pipeline " + std::to_string(n));
        recover(GetParam(), "after pipeline " + std::to_string(n));
        if (HasFatalFailure()) return;
    }
}

INSTANTIATE_TEST_SUITE_P(all, FaultyMethod, testing::ValuesIn(test::methodIds()), [](const auto& info) { return std::string(info.param); });

TEST_F(Faulty, failingHostAllocationsAreRecovered) {
    const VkAllocationCallbacks callbacks{nullptr, &HostMemory::allocate, &HostMemory::reallocate, &HostMemory::free, nullptr, nullptr};
    m_desc.allocator = &callbacks;
    useOwnPipelines(true);
    prepare("hbao");
    long n = 0, refused = 0;
    for (;; n += std::getenv("OBSCURA_SOAK") ? 1 : 9) {
        runSome();
        HostMemory::until = n;
        const Status status = recordFrames("hbao");
        const bool fired = HostMemory::until < 0;
        HostMemory::until = -1;
        if (!fired) break;
        refused += status != Status::ok;
        if (status != Status::ok) expectStatusAndLine(status, Status::outOfMemory, "allocation " + std::to_string(n));
        recover("hbao", "after allocation " + std::to_string(n));
        if (HasFatalFailure()) return;
    }
    std::printf("  %ld host allocations made to fail in turn; %ld gave an error\n", n, refused);
    EXPECT_GT(refused, 5);
}

TEST_F(Faulty, failingOperatorNewIsRecovered) {
    for (const char* method : {"hbao", "multi_resolution"}) {
        prepare(method);
        long n = 0;
        for (;; n += std::getenv("OBSCURA_SOAK") ? 7 : 997) {
            runSome();
            newsUntilFailure = n;
            const Status status = recordFrames(method);
            const bool fired = newsUntilFailure < 0;
            newsUntilFailure = -1;
            if (!fired) break;
            expectStatusAndLine(status, Status::outOfMemory, "new " + std::to_string(n));
            recover(method, "after new " + std::to_string(n));
            if (HasFatalFailure()) return;
        }
        done();
        std::printf("  %-20s failures among the first %ld calls of operator new\n", method, n);
        EXPECT_GT(n, 200);
    }
}

TEST_F(Faulty, lostDeviceIsReported) {
    prepare("hbao");
    ASSERT_EQ(recordFrames("hbao"), Status::ok);
    Faults::fail(0, VK_ERROR_DEVICE_LOST, "GetQueryPoolResults");
    Status status = Status::ok;
    for (int i = 0; i < 3 && status == Status::ok; ++i) status = m_host.record(m_large).status;
    expectStatusAndLine(status, Status::deviceLost, "queries");
    EXPECT_EQ(m_host.record(m_large).status, Status::deviceLost);  // a lost device stays lost
    Faults::stop();
    done();
    for (const char* call : {"AllocateMemory", "CreateComputePipelines", "CreateImage"}) {
        m_host.lines.clear();
        Faults::fail(0, VK_ERROR_DEVICE_LOST, call);
        expectStatusAndLine(recordFrames("hbao"), Status::deviceLost, call);
        Faults::stop();
        recover("hbao", call);
    }
}

TEST_F(Faulty, missingDeviceSupportIsNamed) {
    prepare("hbao");
    const auto refused = [&](const std::string& word) {
        m_host.lines.clear();
        const Status status = recordFrames("hbao");
        EXPECT_TRUE(m_host.said(word)) << word << "\n" << m_host.allSaid();
        expectStatusAndLine(status, Status::unsupported, word);
        done();
    };
    Faults::edit = [](const char* name, void* answer) {
        if (!std::strcmp(name, "GetPhysicalDeviceProperties"))
            static_cast<VkPhysicalDeviceProperties*>(answer)->apiVersion = VK_API_VERSION_1_2;
    };
    refused("1.3");
    Faults::edit = [](const char* name, void* answer) {
        if (!std::strcmp(name, "GetPhysicalDeviceFeatures2"))
            static_cast<VkPhysicalDeviceVulkan13Features*>(static_cast<VkPhysicalDeviceFeatures2*>(answer)->pNext)->synchronization2 =
                VK_FALSE;
    };
    refused("synchronization2");
    Faults::edit = [](const char* name, void* answer) {
        if (!std::strcmp(name, "GetPhysicalDeviceFeatures2"))
            static_cast<VkPhysicalDeviceFeatures2*>(answer)->features.shaderStorageImageExtendedFormats = VK_FALSE;
    };
    refused("shaderStorageImageExtendedFormats");
    Faults::edit = [](const char* name, void* answer) {
        if (!std::strcmp(name, "GetPhysicalDeviceFormatProperties"))
            static_cast<VkFormatProperties*>(answer)->optimalTilingFeatures &= ~VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
    };
    refused("storage image");
    Faults::edit = [](const char* name, void* answer) {
        if (!std::strcmp(name, "GetPhysicalDeviceFormatProperties"))
            static_cast<VkFormatProperties*>(answer)->optimalTilingFeatures &= ~VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
    };
    refused("Frame::depth");
    Faults::edit = [](const char* name, void* answer) {
        if (!std::strcmp(name, "GetPhysicalDeviceProperties"))
            static_cast<VkPhysicalDeviceProperties*>(answer)->limits.maxImageDimension2D = 16;
    };
    refused("Frame::size");
    Faults::edit = nullptr;
    m_desc.queueFamily = 99;
    refused("queueFamily");
    m_desc.queueFamily = m_device.queueFamily();
#define OBSCURA_MISS(name)        \
    Faults::missing = "vk" #name; \
    refused("vk" #name);
    OBSCURA_VK_INSTANCE(OBSCURA_MISS)
    OBSCURA_VK_DEVICE(OBSCURA_MISS)
#undef OBSCURA_MISS
    Faults::missing.clear();
    recover("hbao", "all of it");
}

// checkDevice() names each feature that a host forgot, before its device is made.
TEST_F(Faulty, checkNamesWhatADeviceLacks) {
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, m_device.queueFamily(), 1, &priority};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceFeatures features{};
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &v13};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.pEnabledFeatures = &features;
    m_desc.device = VK_NULL_HANDLE;
    const auto said = [&](Status expected, std::vector<std::string> words) {
        m_host.lines.clear();
        EXPECT_EQ(checkDevice(m_desc, info), expected) << m_host.allSaid();
        EXPECT_EQ(m_host.lines.size(), words.size()) << m_host.allSaid();
        for (const std::string& word : words) EXPECT_TRUE(m_host.said(word)) << word << "\n" << m_host.allSaid();
    };
    said(Status::invalid,
        {"synchronization2 is not enabled", "maintenance4 is not enabled", "shaderStorageImageExtendedFormats is not enabled"});
    v13.synchronization2 = features.shaderStorageImageExtendedFormats = VK_TRUE;
    said(Status::invalid, {"maintenance4 is not enabled"});
    v13.maintenance4 = VK_TRUE;
    said(Status::ok, {});
    // The same features in structures of their own.
    VkPhysicalDeviceMaintenance4Features four{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES, nullptr, VK_TRUE};
    VkPhysicalDeviceSynchronization2Features two{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, &four, VK_TRUE};
    VkPhysicalDeviceFeatures2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &two, features};
    info.pNext = &all;
    info.pEnabledFeatures = nullptr;
    said(Status::ok, {});
    m_desc.queueFamily = 99;
    said(Status::invalid, {"DeviceDesc::queueFamily is 99"});
    m_desc.queueFamily = m_device.queueFamily();
    info.queueCreateInfoCount = 0;
    said(Status::invalid, {"makes no queue"});
    info.queueCreateInfoCount = 1;
    Faults::edit = [](const char* name, void* answer) {
        if (!std::strcmp(name, "GetPhysicalDeviceFeatures2"))
            static_cast<VkPhysicalDeviceVulkan13Features*>(static_cast<VkPhysicalDeviceFeatures2*>(answer)->pNext)->synchronization2 =
                VK_FALSE;
    };
    said(Status::unsupported, {"lacks the feature VkPhysicalDeviceVulkan13Features::synchronization2"});
}

// Null handles, images of a wrong format or too small, numbers that are not finite.
TEST_F(Faulty, invalidInputNamesItsField) {
    prepare("hbao");
    const auto named = [&](const std::string& word, Status status) {
        EXPECT_TRUE(m_host.said(word)) << word << "\n" << m_host.allSaid();
        expectStatusAndLine(status, Status::invalid, word);
    };
    const auto desc = [&](const std::string& word, auto change) {
        DeviceDesc d = m_desc;
        change(d);
        Context* none = reinterpret_cast<Context*>(1);
        named("DeviceDesc::" + word, create(d, &none));
        EXPECT_EQ(none, nullptr);
    };
    desc("instance", [](DeviceDesc& d) { d.instance = VK_NULL_HANDLE; });
    desc("physicalDevice", [](DeviceDesc& d) { d.physicalDevice = VK_NULL_HANDLE; });
    desc("device", [](DeviceDesc& d) { d.device = VK_NULL_HANDLE; });
    desc("framesInFlight", [](DeviceDesc& d) { d.framesInFlight = 0; });
    desc("getInstanceProcAddr", [](DeviceDesc& d) { d.getInstanceProcAddr = nullptr; });
    EXPECT_EQ(create(m_desc, nullptr), Status::invalid);
    EXPECT_EQ(record(nullptr, VK_NULL_HANDLE, m_large).status, Status::invalid);
    EXPECT_EQ(setMethod(nullptr, "hbao", {}), Status::invalid);
    m_host.lines.clear();

    ASSERT_EQ(recordFrames("hbao"), Status::ok);
    named("there is no method '(null)'", setMethod(m_host.context, nullptr, {}));
    named("command buffer", record(m_host.context, VK_NULL_HANDLE, m_large).status);
    MethodSettings settings;
    settings.settings.count = 1;
    named("MethodSettings::settings", setMethod(m_host.context, "hbao", settings));
    settings = {};
    settings.falloff.kind = FalloffKind(17);
    named("MethodSettings::falloff.kind is 17; there are exponential, linear", setMethod(m_host.context, "hbao", settings));
    settings = {};
    settings.preset = nullptr;
    named("preset", setMethod(m_host.context, "hbao", settings));
    for (const float length : {0.0f, -1.0f, std::nanf(""), INFINITY}) {
        settings = {};
        settings.falloff.length = length;
        named("MethodSettings::falloff", setMethod(m_host.context, "hbao", settings));
    }
    size_t cases = 0;
    const auto frame = [&](const std::string& word, auto change) {
        Frame f = m_large;
        change(f);
        named("Frame::" + word, m_host.record(f).status);
        ++cases;
    };
    const struct {
        const char* name;
        ImageView* (*of)(Frame&);
        std::vector<VkFormat> wrong;
    } images[] = {
        {"depth", [](Frame& f) { return &f.depth; }, {VK_FORMAT_R8_UNORM, VK_FORMAT_R32_UINT, VK_FORMAT_D16_UNORM, VK_FORMAT_S8_UINT}},
        {"normals", [](Frame& f) { return &f.normals; },
            {VK_FORMAT_R32_UINT, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32_SFLOAT, VK_FORMAT_R8G8B8A8_SRGB}},
        {"motion", [](Frame& f) { return &f.motion; }, {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_UINT, VK_FORMAT_R8G8_UNORM}},
        {"layers.thickness", [](Frame& f) { return &f.layers.thickness; }, {VK_FORMAT_R32_UINT, VK_FORMAT_D32_SFLOAT}},
        {"layers.second", [](Frame& f) { return &f.layers.second; }, {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_UINT}}};
    for (const auto& image : images) {
        frame(image.name, [&](Frame& f) { image.of(f)->image = VK_NULL_HANDLE; });
        frame(image.name, [&](Frame& f) { image.of(f)->view = VK_NULL_HANDLE; });
        frame(image.name, [&](Frame& f) { image.of(f)->layout = VK_IMAGE_LAYOUT_UNDEFINED; });
        frame(image.name, [&](Frame& f) { image.of(f)->format = VK_FORMAT_UNDEFINED; });
        for (const VkFormat format : image.wrong) frame(image.name, [&](Frame& f) { image.of(f)->format = format; });
        frame(image.name, [&](Frame& f) { *image.of(f) = *image.of(m_small); });  // the image of the size before a resize
    }
    frame("normals", [&](Frame& f) { f.normalEncoding = NormalEncoding::octahedral32; });
    frame("size", [&](Frame& f) { f.size = {0, 8}; });
    frame("guard", [&](Frame& f) { f.guard = {24, 0}; });
    frame("guard", [&](Frame& f) { f.guard = {~0u, ~0u}; });
    frame("guard", [&](Frame& f) { f.guard = {1u << 31, 0}; });
    frame("layers.second", [&](Frame& f) { f.layers.thickness = {}; });
    frame("layers.secondSize", [&](Frame& f) { f.layers.secondSize = {3, 3}; });
    for (int i = 0; i < 16; ++i) frame("projection", [&](Frame& f) { f.projection[i] = std::nanf(""); });
    frame("projection", [&](Frame& f) { std::fill(std::begin(f.projection), std::end(f.projection), 0.0f); });
    frame("projection", [&](Frame& f) { f.projection[11] = 1.0f; });
    const auto transpose = [](float* m) {
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < a; ++b) std::swap(m[4 * a + b], m[4 * b + a]);
    };
    frame("projection is stored by rows", [&](Frame& f) {  // from 0.1 m to 100 m
        const float rows[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.001001f, -0.1001001f, 0, 0, -1, 0};
        std::copy(std::begin(rows), std::end(rows), f.projection);
    });
    frame("projection is stored by rows", [&](Frame& f) {  // infinite, reversed
        const float rows[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0.1f, 0, 0, -1, 0};
        std::copy(std::begin(rows), std::end(rows), f.projection);
    });
    frame("projection is stored by rows", [&](Frame& f) {  // orthographic, from 0.1 m to 100 m
        const float rows[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -0.01f, -0.001f, 0, 0, 0, 1};
        std::copy(std::begin(rows), std::end(rows), f.projection);
    });
    frame("eyeFromWorld scales", [&](Frame& f) {
        for (int i = 0; i < 12; ++i) f.eyeFromWorld[i] *= 1.01f;
    });
    frame("eyeFromWorld shears", [&](Frame& f) {
        const float sheared[] = {1, 0, 0, 0, 0.1f, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        std::copy(std::begin(sheared), std::end(sheared), f.eyeFromWorld);
    });
    frame("eyeFromWorld does not end in the row 0 0 0 1", [&](Frame& f) {
        f.eyeFromWorld[12] = 3.0f;
        transpose(f.eyeFromWorld);
    });
    frame("motionScale is (0, 1)", [&](Frame& f) { f.motionScale[0] = 0.0f; });
    for (int i = 0; i < 16; ++i) frame("eyeFromWorld", [&](Frame& f) { f.eyeFromWorld[i] = INFINITY; });
    for (int i = 0; i < 2; ++i) frame("motionScale", [&](Frame& f) { f.motionScale[i] = std::nanf(""); });
    frame("skyDepth", [&](Frame& f) { f.skyDepth = std::nanf(""); });
    frame("volume.cells", [&](Frame& f) { f.volume.cells = 100; });
    for (int i = 0; i < 16; ++i) frame("volume.cellFromEye", [&](Frame& f) { f.volume.cellFromEye[i] = std::nanf(""); });
    std::printf("  %zu invalid inputs in a frame\n", cases);
    recover("hbao", "all of it");
}

}  // namespace
}  // namespace obscura::ao
