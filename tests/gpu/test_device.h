// One device for all GPU tests of a program, under core and synchronization validation. Where there is no Vulkan device or
// no validation layer, `device()` skips the test with the reason. Tests that derive from GpuTest fail on any message.
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

// Ends the running test as skipped, from however deep: gtest takes this exception for one it has reported already.
[[noreturn]] inline void skip(const std::string& reason) {
    [&] { GTEST_SKIP() << reason; }();
    throw testing::AssertionException(testing::TestPartResult(testing::TestPartResult::kSkip, __FILE__, __LINE__, reason.c_str()));
}

// What all test devices have logged.
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

// A device of one's own, under validation.
inline std::unique_ptr<gpu::Device> makeDevice(gpu::DeviceOptions options = {}) {
    logged();  // built before any device, so gone after them
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

// Takes the device down at the end, when the layer names what nobody destroyed.
class DeviceEnvironment : public testing::Environment {
public:
    void TearDown() override {
        if (!sharedDevice()) return;
        logged().clear();
        sharedDevice().reset();
        EXPECT_TRUE(logged().empty()) << "left over at the device's end:\n" << allLogged();
    }
};
inline testing::Environment* const kDeviceEnvironment = testing::AddGlobalTestEnvironment(new DeviceEnvironment);

}  // namespace obscura::test
