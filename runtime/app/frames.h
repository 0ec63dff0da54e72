// Frames in flight: command pools, command buffers and fences, with and without a window.
//
//     frames.begin(graph);                     // waits for the oldest frame, begins the next
//     ... declare passes ...
//     frames.end(graph, acquired, rendered);   // records, submits
#pragma once

#include <vector>

#include "graph/executor.h"

namespace obscura::app {

class Frames {
public:
    explicit Frames(gpu::Device& device);  // valid() is false if a Vulkan object could not be created
    ~Frames();                             // waits for the GPU
    Frames(const Frames&) = delete;

    bool valid() const { return m_valid; }
    gpu::Status begin(graph::Graph& graph);
    // Null semaphores are ignored. On failure nothing was submitted.
    gpu::Status end(graph::Graph& graph, VkSemaphore wait = VK_NULL_HANDLE, VkSemaphore signal = VK_NULL_HANDLE);
    gpu::Status wait();  // until the GPU has finished every submitted frame
    graph::Executor& executor() { return m_executor; }
    uint32_t slot() const { return m_slot; }                // 0 .. framesInFlight - 1
    double recordMilliseconds() const { return m_record; }  // of the last frame: CPU time from the end of the wait to the submission
    // Stages that wait for the acquire semaphore; External::stages of an imported swapchain image.
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
    graph::Executor m_executor;
    std::vector<Slot> m_slots;
    uint32_t m_slot = 0;
    bool m_valid = true;
    double m_record = 0.0, m_begun = 0.0;
};

double now();  // milliseconds on a steady clock

}  // namespace obscura::app
