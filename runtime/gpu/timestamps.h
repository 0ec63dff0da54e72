// Timestamps of one frame in flight: written while it is recorded, read before it is recorded again.
#pragma once

#include <string>
#include <vector>

#include "gpu/device.h"

namespace obscura::gpu {

struct PassTime {
    std::string name;
    double milliseconds = 0.0;
};

class Timestamps {
public:
    explicit Timestamps(Device& device) : m_device(device) {}
    ~Timestamps();
    Timestamps(const Timestamps&) = delete;

    // Makes what `count` timestamps need; begin() and write() do not fail then.
    Status reserve(uint32_t count);
    void begin(VkCommandBuffer cmd);                           // and writes the first one
    void write(VkCommandBuffer cmd, const std::string& pass);  // behind the commands of a pass
    void end(VkCommandBuffer cmd);
    // The time of each pass, from one timestamp to the next. Empty when the frame has not run, which a host may decide after recording it,
    // or when its times have been read already.
    Status read(std::vector<PassTime>& times);

private:
    void write(VkCommandBuffer cmd);
    Device& m_device;
    VkQueryPool m_queries = VK_NULL_HANDLE;
    VkEvent m_executed = VK_NULL_HANDLE;  // set by the frame itself: without it the queries were never reset, and reading them is an error
    std::vector<std::string> m_passes;    // one between each two timestamps
    uint32_t m_count = 0, m_capacity = 0;
};

}  // namespace obscura::gpu
