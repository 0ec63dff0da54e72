// The pipeline cache on disk. Drivers trust its contents, so the file has a header of our own with a checksum, the driver and the device:
// if any differs, the cache starts empty.
#include <array>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "gpu/result.h"

namespace obscura::gpu {

namespace {

struct Head {
    std::array<char, 8> magic{'o', 'b', 's', 'c', 'p', 'c', '0', '1'};
    uint64_t bytes = 0;
    uint64_t checksum = 0;
    uint32_t vendor = 0, device = 0, driver = 0, reserved = 0;
    std::array<uint8_t, VK_UUID_SIZE> uuid{};
    bool operator==(const Head&) const = default;
};
static_assert(sizeof(Head) == 56, "no padding: it is written as it lies");

uint64_t fnv1a(const std::vector<uint8_t>& bytes) {
    uint64_t hash = 0xcbf29ce484222325ull;
    for (uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3ull;
    return hash;
}

Head headOf(const VkPhysicalDeviceProperties& properties, const std::vector<uint8_t>& data) {
    Head head;
    head.bytes = data.size();
    head.checksum = fnv1a(data);
    head.vendor = properties.vendorID;
    head.device = properties.deviceID;
    head.driver = properties.driverVersion;
    std::memcpy(head.uuid.data(), properties.pipelineCacheUUID, VK_UUID_SIZE);
    return head;
}

// The driver's own header: it must be there and be this device's.
bool driverHeaderFits(const VkPhysicalDeviceProperties& properties, const std::vector<uint8_t>& data) {
    VkPipelineCacheHeaderVersionOne header;
    if (data.size() < sizeof(header)) return false;
    std::memcpy(&header, data.data(), sizeof(header));
    return header.headerSize >= sizeof(header) && header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorID == properties.vendorID && header.deviceID == properties.deviceID &&
           std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

}  // namespace

void Device::readPipelineCache(const VkPhysicalDeviceProperties& properties) {
    m_pipelineCacheRead.clear();
    if (m_pipelineCacheFile.empty()) return;
    constexpr uint64_t kMaxBytes = 256ull << 20;
    std::error_code ignored;
    const uint64_t size = std::filesystem::file_size(m_pipelineCacheFile, ignored);
    if (ignored) return;  // the first run
    std::ifstream file(m_pipelineCacheFile, std::ios::binary);
    Head head;
    std::vector<uint8_t> data;
    bool good = size > sizeof(head) && size <= kMaxBytes && file.read(reinterpret_cast<char*>(&head), sizeof(head));
    if (good) {
        data.resize(size - sizeof(head));
        good = file.read(reinterpret_cast<char*>(data.data()), std::streamsize(data.size())) && head == headOf(properties, data) &&
               driverHeaderFits(properties, data);
    }
    if (good) m_pipelineCacheRead = std::move(data);
    else
        log(Severity::warning,
            fmt::format("{}: not a pipeline cache of this device and driver; starting with an empty one", m_pipelineCacheFile));
}

void Device::writePipelineCache() const {
    if (m_pipelineCacheFile.empty()) return;
    size_t size = 0;
    if (m_vk.GetPipelineCacheData(m_device, m_pipelineCache, &size, nullptr) != VK_SUCCESS || size == 0) return;
    std::vector<uint8_t> data(size);
    if (m_vk.GetPipelineCacheData(m_device, m_pipelineCache, &size, data.data()) != VK_SUCCESS) return;
    data.resize(size);
    if (data == m_pipelineCacheRead) return;

    namespace fs = std::filesystem;
    const fs::path target = m_pipelineCacheFile;
    // A name of its own, so that two processes ending together do not write into one file; the rename is atomic.
    const auto ticks = std::chrono::steady_clock::now().time_since_epoch().count();
    const fs::path temporary =
        fmt::format("{}.{:x}.tmp", m_pipelineCacheFile, uint64_t(ticks) ^ uint64_t(reinterpret_cast<uintptr_t>(this)));
    std::error_code error;
    if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
    VkPhysicalDeviceProperties properties;
    m_vk.GetPhysicalDeviceProperties(m_physical, &properties);
    const Head head = headOf(properties, data);
    {
        std::ofstream file(temporary, std::ios::binary);
        file.write(reinterpret_cast<const char*>(&head), sizeof(head));
        file.write(reinterpret_cast<const char*>(data.data()), std::streamsize(data.size()));
        file.close();
        if (file) fs::rename(temporary, target, error);
        else error = std::make_error_code(std::errc::io_error);
    }
    if (error) {
        log(Severity::warning, fmt::format("{}: the pipeline cache could not be written ({})", m_pipelineCacheFile, error.message()));
        fs::remove(temporary, error);
    }
}

}  // namespace obscura::gpu
