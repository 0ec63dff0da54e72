// Fixture: one device for all GPU tests of a program, under core and synchronization validation. Without a Vulkan device or
// validation layer, `device()` skips the test with the reason. Tests that derive from GpuTest fail on any validation message.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu/device.h"
#include "gpu/keep_modules.h"

namespace obscura::gpu {
inline void PrintTo(Status status, std::ostream* out) { *out << name(status); }
}  // namespace obscura::gpu

namespace obscura::test {

// Skips the running test from any call depth: gtest treats this exception as already reported.
[[noreturn]] inline void skip(const std::string& reason) {
    [&] { GTEST_SKIP() << reason; }();
    throw testing::AssertionException(testing::TestPartResult(testing::TestPartResult::kSkip, __FILE__, __LINE__, reason.c_str()));
}

// Lines logged by all test devices.
inline std::vector<std::string>& logged() {
    static std::vector<std::string> lines;
    return lines;
}

inline bool loggedContains(const std::string& part) {
    for (const std::string& line : logged())
        if (line.find(part) != std::string::npos) return true;
    return false;
}

inline gpu::Log logger() {
    return [](gpu::Severity, const char* message) { logged().emplace_back(message); };
}

// Creates another device, under validation.
inline std::unique_ptr<gpu::Device> makeDevice(gpu::DeviceOptions options = {}) {
    logged();  // constructed before any device, so destroyed after them
    options.validation = options.synchronization = true;
    options.log = logger();
    std::string error;
    std::unique_ptr<gpu::Device> device = gpu::Device::create(options, error);
    if (!device) skip(error);
    keepModules();
    if (!device->caps().validation) skip("the Vulkan validation layer is not installed");
    return device;
}

inline std::unique_ptr<gpu::Device>& sharedDevice() {
    static std::unique_ptr<gpu::Device> device;
    return device;
}

inline gpu::Device& device() {
    if (!sharedDevice()) sharedDevice() = makeDevice();
    return *sharedDevice();
}

inline std::string allLogged() {
    std::string all;
    for (const std::string& line : logged()) all += line + "\n";
    return all;
}

class GpuTest : public testing::Test {
protected:
    void SetUp() override {
        logged().clear();
        m_before = device().validationMessages();
    }
    void TearDown() override {
        if (!sharedDevice()) return;
        device().waitIdle();
        EXPECT_EQ(device().validationMessages(), m_before) << allLogged();
    }

private:
    uint64_t m_before = 0;
};

// Destroys the device at the end, when the validation layer reports leaked objects.
class DeviceEnvironment : public testing::Environment {
public:
    void TearDown() override {
        if (!sharedDevice()) return;
        logged().clear();
        sharedDevice().reset();
        EXPECT_TRUE(logged().empty()) << "objects leaked at device destruction:\n" << allLogged();
    }
};
inline testing::Environment* const kDeviceEnvironment = testing::AddGlobalTestEnvironment(new DeviceEnvironment);

}  // namespace obscura::test
