#include "gpu_cost/chip.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

namespace obscura::gpu_cost {
namespace {

namespace fs = std::filesystem;

// The manifest by which Vulkan's loader finds RADV; empty if it is not installed.
std::string manifest() {
    if (const char* given = std::getenv("OBSCURA_RADV"); given && *given) return given;
    for (const char* folder : {"/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/usr/share/vulkan/icd.d"}) {
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder, ignored))
            if (entry.path().filename().string().starts_with("radeon_icd")) return entry.path().string();
    }
    return {};
}

// Environment variables as they were, put back at the end of a scope.
class Environment {
public:
    void set(const char* name, const std::string& value) {
        const char* before = std::getenv(name);
        m_before.push_back({name, before ? std::optional<std::string>(before) : std::nullopt});
        setenv(name, value.c_str(), 1);
    }
    ~Environment() {
        for (const auto& [name, value] : m_before) value ? setenv(name, value->c_str(), 1) : unsetenv(name);
    }

private:
    std::vector<std::pair<const char*, std::optional<std::string>>> m_before;
};

}  // namespace

const std::vector<Chip>& chips() {
    // By AMD's data sheets of the products; SIMDs are compute units times SIMDs of each.
    static const std::vector<Chip> kChips{{"navi21", "Radeon RX 6900 XT", 80 * 2, 2.25, 512},
        {"vega10", "Radeon RX Vega 64", 64 * 4, 1.546, 484}, {"navi10", "Radeon RX 5700 XT", 40 * 2, 1.905, 448},
        {"polaris10", "Radeon RX 480", 36 * 4, 1.266, 256}};
    return kChips;
}

const Chip* findChip(const std::string& id) {
    const auto found = std::find_if(chips().begin(), chips().end(), [&](const Chip& chip) { return id == chip.id; });
    return found == chips().end() ? nullptr : &*found;
}

std::string driverOf(const gpu::Device& device) {
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
    device.vk().GetPhysicalDeviceProperties2(device.physical(), &properties);
    const std::string text = driver.driverInfo;  // "Mesa 22.3.6 (LLVM 15.0.6)" in some builds
    return text.substr(0, text.find(" ("));
}

std::unique_ptr<gpu::Device> compilerOf(const Chip& chip, std::string& error) {
    const std::string driver = manifest();
    if (driver.empty()) {
        error = "Mesa's RADV is not installed; on Debian: apt-get install mesa-vulkan-drivers";
        return nullptr;
    }
    Environment environment;
    environment.set("RADV_FORCE_FAMILY", chip.id);
    environment.set("VK_DRIVER_FILES", driver);
    environment.set("VK_ICD_FILENAMES", driver);
    environment.set("MESA_SHADER_CACHE_DISABLE", "true");
    environment.set("OBSCURA_VALIDATION", "");
    environment.set("OBSCURA_DEVICE", "");
    gpu::DeviceOptions options;
    options.statistics = options.compilerOnly = true;
    std::unique_ptr<gpu::Device> device = gpu::Device::create(options, error);
    if (!device) error = fmt::format("RADV ({}) makes no device for {}: {}", driver, chip.id, error);
    else if (!device->caps().statistics)
        error = fmt::format("RADV ({}) has no VK_KHR_pipeline_executable_properties", driver), device.reset();
    return device;
}

}  // namespace obscura::gpu_cost
