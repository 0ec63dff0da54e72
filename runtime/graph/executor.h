// Runs recorded frames: owns what is real (pooled images and buffers, upload memory, descriptor sets, timestamps), makes what a frame's
// plan needs, records its commands. Nothing moves on (states of images, histories, what Graph::onRecorded was given) unless all of that
// succeeded: a frame that failed leaves everything as it was, and may be declared again.
#pragma once

#include <array>
#include <deque>
#include <optional>

#include "gpu/descriptor_pool.h"
#include "graph/graph.h"

namespace obscura::graph {

class Executor {
public:
    explicit Executor(gpu::Device& device);
    Executor(const Executor&) = delete;

    // Records everything, or nothing: Status::invalid (with a log line) when the recording contradicts itself or the shaders, or what the
    // device lacked. Once in each of the device's frames: nextFrame() has been called since the last one that succeeded.
    gpu::Status execute(Graph& graph, VkCommandBuffer cmd);

    void trim();  // gives back pooled images and buffers that the last recorded frame did not use
    void setTiming(bool on) { m_timing = on; }
    // Of the newest frame whose timestamps have arrived. Before execute(), reads those of the frame whose slot this frame reuses.
    const Timings& timings();
    std::optional<uint64_t> lastFrame() const { return m_lastFrame; }  // device frame number of the last one recorded
    const Plan& plan() const { return m_plan; }                        // of the last one recorded

    // Bytes of device memory: of the pools; used by the last frame (pools, histories, uploads, imported buffers, each once).
    uint64_t poolBytes() const;
    uint64_t frameBytes() const { return m_frameBytes; }
    // Device memory that an executor comes to hold for frames declared like this one: pools, histories, uploads of all frames in flight.
    // Makes nothing. 0, logged, when the recording contradicts itself.
    uint64_t bytes(Graph& graph) const;

private:
    struct Pooled {
        Slot slot;
        gpu::Image image;       // this
        gpu::Buffer buffer;     // or this
        std::string name;       // debug name
        uint64_t lastUsed = 0;  // device frame
        uint64_t bytes() const { return image.bytes() + buffer.bytes(); }
    };
    // What one frame in flight holds until its turn comes again.
    struct Frame {
        explicit Frame(gpu::Device& device) : sets(device), timestamps(device) {}
        std::vector<gpu::Buffer> uploads;
        gpu::DescriptorPool sets;
        gpu::Timestamps timestamps;
        uint64_t number = 0;
    };
    // Each history's images that were made anew, until the frame is recorded. Empty ones: the history's own serve.
    using Pending = std::vector<std::array<gpu::Image, 2>>;

    Frame& frame() { return m_frames[m_device.frame() % m_frames.size()]; }
    bool timed() const { return m_timing && m_device.caps().timestamps; }
    gpu::Status prepare(Graph& graph, Plan& plan, Pending& histories);
    gpu::Status makePool(const Recording& recording, const Plan& plan);
    gpu::Status makeUploads(const Graph& graph, const Plan& plan);
    gpu::Status makeHistories(const Graph& graph, Pending& histories);
    gpu::Status makeSets(const Graph& graph, const Plan& plan);
    void record(const Graph& graph, const Plan& plan, VkCommandBuffer cmd);
    void commit(Graph& graph, Plan& plan, Pending& histories) noexcept;
    void barriers(const Recording& recording, VkCommandBuffer cmd, const std::vector<Barrier>& list);
    void run(const Recording& recording, VkCommandBuffer cmd, const Pass& pass, VkDescriptorSet set);

    gpu::Device& m_device;
    bool m_timing = true, m_deviceLost = false;
    Timings m_timings;
    std::optional<uint64_t> m_lastFrame;
    Plan m_plan;
    uint64_t m_frameBytes = 0;
    std::vector<Pooled> m_pool;
    std::vector<Physical> m_physical;     // by resource, of the frame being recorded
    std::vector<VkDescriptorSet> m_sets;  // by pass
    std::deque<Frame> m_frames;
};

}  // namespace obscura::graph
