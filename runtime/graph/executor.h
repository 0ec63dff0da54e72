// Runs recorded frames: owns what is real (pooled images and buffers, upload memory, descriptor sets, timestamps), makes what a frame's
// plan needs, records its commands. Nothing moves on (states of images, histories, what Graph::onRecorded was given) unless all of that
// succeeded: a frame that failed leaves everything as it was, and may be declared again.
#pragma once

#include <memory>
#include <optional>

#include "graph/graph.h"

namespace obscura::graph {

class Executor {
public:
    explicit Executor(gpu::Device& device);
    ~Executor();
    Executor(const Executor&) = delete;

    // Records everything, or nothing: Status::invalid (with a log line) when the recording contradicts itself or the shaders, or what the
    // device lacked. Once in each of the device's frames: nextFrame() has been called since the last one that succeeded.
    gpu::Status execute(Graph& graph, VkCommandBuffer cmd);

    void setTiming(bool on) { m_timing = on; }
    // Of the newest frame whose timestamps have arrived. Before execute(), reads those of the frame whose slot this frame reuses.
    const Timings& timings();
    std::optional<uint64_t> lastFrame() const { return m_lastFrame; }  // device frame number of the last one recorded
    const Plan& plan() const { return m_plan; }                        // of the last one recorded

    // Bytes of device memory: of the pools; used by the last frame (pools, histories, uploads, imported buffers, each once).
    uint64_t poolBytes() const;
    uint64_t frameBytes() const;
    // Device memory that an executor comes to hold for frames declared like this one: pools, histories, uploads of all frames in flight.
    // Makes nothing. 0, logged, when the recording contradicts itself.
    uint64_t bytes(Graph& graph) const;

private:
    friend struct PassContext;
    struct Frame;     // descriptor pools, queries, upload memory of one frame in flight
    struct Physical;  // what a resource is on the GPU this frame
    struct Pooled;    // an image or a buffer, and its slot in the plan
    struct Pending;   // a history's images until the frame is recorded
    Frame& frame() const;
    gpu::Status prepare(Graph& graph, Plan& plan, std::vector<Pending>& histories);
    gpu::Status makePool(const Plan& plan);
    gpu::Status makeUploads(const Graph& graph, const Plan& plan);
    gpu::Status makeHistories(const Graph& graph, std::vector<Pending>& histories);
    void bindPhysical(const Graph& graph, const Plan& plan, const std::vector<Pending>& histories);
    void namePool(const Graph& graph, const Plan& plan);
    gpu::Status makeSets(const Graph& graph, const Plan& plan);
    gpu::Status makeSet(const Pass& pass, VkDescriptorSet& set);
    void record(const Graph& graph, const Plan& plan, VkCommandBuffer cmd);
    void commit(Graph& graph, Plan& plan, std::vector<Pending>& histories) noexcept;
    void barriers(const Recording& recording, VkCommandBuffer cmd, const std::vector<Barrier>& list);
    void bind(VkCommandBuffer cmd, const Pass& pass);
    void run(const Recording& recording, VkCommandBuffer cmd, const Pass& pass);
    void collectTimings(Frame& frame);

    gpu::Device& m_device;
    bool m_timing = true, m_deviceLost = false;
    Timings m_timings;
    std::optional<uint64_t> m_lastFrame;
    Plan m_plan;
    uint64_t m_frameBytes = 0;
    std::vector<Pooled> m_pool;
    std::vector<Physical> m_physical;     // by resource, of the frame being recorded
    std::vector<VkDescriptorSet> m_sets;  // by pass
    std::vector<std::unique_ptr<Frame>> m_frames;
};

}  // namespace obscura::graph
