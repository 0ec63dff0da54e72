// Frames in flight: command pools, fences and the order of the steps, the same with and without a window.
//
//     frames.begin(graph);                     // waits for the oldest frame, opens the next
//     ... declare passes ...
//     frames.end(graph, acquired, rendered);   // records, submits
#pragma once

#include <vector>

#include "graph/graph.h"

namespace obscura::app {

class Frames {
public:
    explicit Frames(gpu::Device& device);  // check good() afterwards
    ~Frames();                             // waits
    Frames(const Frames&) = delete;

    bool good() const { return m_good; }
    gpu::Status begin(graph::Graph& graph);
    // Null semaphores are left out. On failure nothing was submitted.
    gpu::Status end(graph::Graph& graph, VkSemaphore wait = VK_NULL_HANDLE, VkSemaphore signal = VK_NULL_HANDLE);
    gpu::Status wait();  // until every submitted frame has left the GPU
    uint32_t slot() const { return m_slot; }                // 0 .. framesInFlight - 1
    double recordMilliseconds() const { return m_record; }  // last frame, after the wait, until submitted
    // Where the wait on the acquire semaphore stands, and so what an imported swapchain image must name.
    static constexpr VkPipelineStageFlags2 kAcquireStages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;

private:
    struct Slot {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE;
        bool submitted = false;
    };
    gpu::Status wait(Slot& slot);
    gpu::Device& m_device;
    std::vector<Slot> m_slots;
    uint32_t m_slot = 0;
    bool m_good = true;
    double m_record = 0.0, m_begun = 0.0;
};

double now();  // milliseconds on a steady clock

}  // namespace obscura::app
