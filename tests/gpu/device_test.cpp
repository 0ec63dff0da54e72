// gpu::Device: creation, adoption of host handles, deferred destruction, validation, pipeline cache.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "gpu/resources.h"
#include "gpu/test_device.h"
#include "gpu/test_shaders.h"

using namespace obscura;
using namespace obscura::gpu;

namespace {

class DeviceTest : public test::GpuTest {};

TEST_F(DeviceTest, IsCreatedWithRequiredFeatures) {
    Device& device = test::device();
    EXPECT_NE(device.instance(), VK_NULL_HANDLE);
    EXPECT_NE(device.handle(), VK_NULL_HANDLE);
    EXPECT_NE(device.queue(), VK_NULL_HANDLE);
    EXPECT_NE(device.pipelineCache(), VK_NULL_HANDLE);
    EXPECT_FALSE(device.caps().deviceName.empty());
    EXPECT_GE(device.caps().maxImageSize, 4096u);
    EXPECT_TRUE(device.caps().debugUtils);
    EXPECT_EQ(device.caps().software, device.caps().type == VK_PHYSICAL_DEVICE_TYPE_CPU);
    EXPECT_EQ(device.memoryUse(), 0u);
}

TEST_F(DeviceTest, ListNamesTheDeviceInUse) {
    const std::vector<std::string> names = Device::list();
    ASSERT_FALSE(names.empty());
    bool found = false;
    for (const std::string& name : names) found |= name.starts_with(test::device().caps().deviceName + " (");
    EXPECT_TRUE(found) << names.front();
}

TEST_F(DeviceTest, NameIsCaseInsensitive) {
    DeviceOptions options;
    options.name = test::device().caps().deviceName.substr(1, 5);
    for (char& c : options.name) c = char(std::toupper(c));
    const auto chosen = test::makeDevice(options);
    EXPECT_EQ(chosen->validationMessages(), 0u) << test::allLogged();
}

TEST_F(DeviceTest, UnknownNameIsAnErrorThatListsTheDevices) {
    DeviceOptions options;
    options.name = "no such card";
    std::string error;
    EXPECT_EQ(Device::create(options, error), nullptr);
    EXPECT_NE(error.find("'no such card'"), std::string::npos) << error;
    EXPECT_NE(error.find(test::device().caps().deviceName), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
}

TEST_F(DeviceTest, UnknownInstanceExtensionIsAnError) {
    DeviceOptions options;
    options.instanceExtensions = {"VK_EXT_no_such_thing"};
    std::string error;
    EXPECT_EQ(Device::create(options, error), nullptr);
    EXPECT_NE(error.find("VK_EXT_no_such_thing"), std::string::npos) << error;
}

TEST_F(DeviceTest, EnvironmentGivesTheDefaultName) {
    setenv("OBSCURA_DEVICE", "no such card", 1);
    std::string error;
    EXPECT_EQ(Device::create({}, error), nullptr);
    DeviceOptions named;
    named.name = test::device().caps().deviceName;
    EXPECT_NE(Device::create(named, error), nullptr) << "the name in DeviceDesc has priority over the environment";
    unsetenv("OBSCURA_DEVICE");
    EXPECT_NE(error.find("no such card"), std::string::npos);
}

AdoptedDevice handlesOf(const Device& device) {
    AdoptedDevice host;
    host.instance = device.instance();
    host.physicalDevice = device.physical();
    host.device = device.handle();
    host.queue = device.queue();
    host.queueFamily = device.queueFamily();
    host.getInstanceProcAddr = device.vk().GetInstanceProcAddr;
    host.log = test::logger();
    return host;
}

TEST_F(DeviceTest, AdoptsHandlesWithoutDestroyingThem) {
    Device& host = test::device();
    std::string error;
    for (int round = 0; round < 2; ++round) {
        const auto guest = Device::adopt(handlesOf(host), error);
        ASSERT_NE(guest, nullptr) << error;
        EXPECT_EQ(guest->caps().deviceName, host.caps().deviceName);
        EXPECT_NE(guest->sampler(Sampling::linear), VK_NULL_HANDLE);
        Buffer buffer;
        ASSERT_EQ(Buffer::create(*guest, 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device, "guest", buffer), Status::ok);
        const std::vector<std::byte> bytes(64, std::byte{7});
        EXPECT_EQ(upload(*guest, buffer, bytes), Status::ok);
    }
    EXPECT_EQ(host.runNow([](VkCommandBuffer) {}), Status::ok);
}

TEST_F(DeviceTest, AdoptionWithoutAQueueRefusesUploads) {
    AdoptedDevice host = handlesOf(test::device());
    host.queue = VK_NULL_HANDLE;
    std::string error;
    const auto guest = Device::adopt(host, error);
    ASSERT_NE(guest, nullptr) << error;
    EXPECT_EQ(guest->runNow([](VkCommandBuffer) {}), Status::unsupported);
    EXPECT_TRUE(test::loggedContains("queue"));
}

TEST_F(DeviceTest, AdoptionNamesMissingHandlesAndFunctions) {
    std::string error;
    AdoptedDevice host = handlesOf(test::device());
    host.device = VK_NULL_HANDLE;
    EXPECT_EQ(Device::adopt(host, error), nullptr);
    EXPECT_NE(error.find("device is null"), std::string::npos) << error;
    host = handlesOf(test::device());
    host.getInstanceProcAddr = [](VkInstance, const char*) -> PFN_vkVoidFunction { return nullptr; };
    EXPECT_EQ(Device::adopt(host, error), nullptr);
    EXPECT_NE(error.find("vkDestroyInstance"), std::string::npos) << error;
    host = handlesOf(test::device());
    host.queueFamily = 77;
    EXPECT_EQ(Device::adopt(host, error), nullptr);
}

TEST_F(DeviceTest, SamplersAreCached) {
    Device& device = test::device();
    const VkSampler a = device.sampler(Sampling::linearRepeat);
    EXPECT_EQ(a, device.sampler(Sampling::linearRepeat));
    EXPECT_NE(a, device.sampler(Sampling::nearestRepeat));
    EXPECT_NE(a, device.sampler(Sampling::linear));
}

TEST_F(DeviceTest, MemoryIsFreedAfterTheFramesInFlight) {
    Device& device = test::device();
    const uint64_t before = device.memoryUse();
    {
        Buffer buffer;
        ASSERT_EQ(Buffer::create(device, 1 << 20, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device, "short-lived", buffer), Status::ok);
        EXPECT_GE(device.memoryUse(), before + (1 << 20));
    }
    EXPECT_GT(device.memoryUse(), before) << "the frame that released it may still be running";
    for (uint32_t i = 0; i + 1 < device.framesInFlight(); ++i) device.nextFrame();
    EXPECT_GT(device.memoryUse(), before);
    device.nextFrame();
    EXPECT_EQ(device.memoryUse(), before);
}

TEST_F(DeviceTest, ValidationMessagesAreCounted) {
    const auto own = test::makeDevice();
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};  // no size, no usage
    VkBuffer buffer = VK_NULL_HANDLE;
    own->vk().CreateBuffer(own->handle(), &info, nullptr, &buffer);
    own->vk().DestroyBuffer(own->handle(), buffer, nullptr);
    EXPECT_GT(own->validationMessages(), 0u);
    EXPECT_TRUE(test::loggedContains("validation: "));
}

TEST_F(DeviceTest, SynchronizationHazardsAreReported) {
    const auto own = test::makeDevice();
    Buffer buffer;
    ASSERT_EQ(Buffer::create(*own, 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device, "raced", buffer), Status::ok);
    own->runNow([&](VkCommandBuffer cmd) {
        own->vk().CmdFillBuffer(cmd, buffer.handle(), 0, VK_WHOLE_SIZE, 1);
        own->vk().CmdFillBuffer(cmd, buffer.handle(), 0, VK_WHOLE_SIZE, 2);
    });
    EXPECT_GT(own->validationMessages(), 0u);
    EXPECT_TRUE(test::loggedContains("WRITE_AFTER_WRITE")) << test::allLogged();
}

TEST_F(DeviceTest, PipelineCacheFileIsWrittenAndReadAgain) {
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "deeper" / "pipelines.cache";
    DeviceOptions options;
    options.pipelineCacheFile = file.string();
    test::makeDevice(options).reset();
    ASSERT_TRUE(std::filesystem::exists(file)) << test::allLogged();
    const auto written = std::filesystem::last_write_time(file);
    const auto bytes = [&] {
        std::ifstream in(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    const std::string before = bytes();
    test::logged().clear();
    test::makeDevice(options).reset();
    EXPECT_TRUE(test::logged().empty()) << test::allLogged();
    // SwiftShader's data differ from one reading to the next.
    EXPECT_EQ(std::filesystem::last_write_time(file) == written, bytes() == before) << "an unchanged cache must not be written";
    size_t entries = 0;
    for (const auto& entry : std::filesystem::directory_iterator(file.parent_path())) entries += entry.exists();
    EXPECT_EQ(entries, 1u) << "a temporary file was left";
}

TEST_F(DeviceTest, DamagedPipelineCacheFileIsRejectedAndReplaced) {
    const test::TemporaryFolder folder;
    const std::string file = (folder.path() / "pipelines.cache").string();
    DeviceOptions options;
    options.pipelineCacheFile = file;
    test::makeDevice(options).reset();
    const auto size = std::filesystem::file_size(file);
    const auto damage = [&](const std::string& what) {
        test::logged().clear();
        const auto device = test::makeDevice(options);
        EXPECT_TRUE(test::loggedContains("not a pipeline cache")) << what;
        EXPECT_EQ(device->validationMessages(), 0u) << test::allLogged();
    };
    {
        std::fstream flip(file, std::ios::in | std::ios::out | std::ios::binary);
        flip.seekp(std::streamoff(size) - 1);
        flip.put('\x5a');
    }
    damage("last byte");
    EXPECT_EQ(std::filesystem::file_size(file), size) << "a valid file replaces the damaged one";
    std::filesystem::resize_file(file, size - 3);
    damage("cut short");
    std::filesystem::resize_file(file, 3);
    damage("shorter than its head");
    std::ofstream(file, std::ios::binary) << std::string(4096, 'x');
    damage("something else");
}

}  // namespace
