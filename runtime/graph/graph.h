// The render graph: passes are declared each frame, in execution order, and run by one function that places barriers,
// labels, timestamps and descriptors.
//
//     graph.begin();
//     ImageId depth = graph.image("depth", {VK_FORMAT_R32_SFLOAT, w, h});
//     graph.pass("linearize", m_linearize).read(device).write(depth).constants(c).dispatch(w, h);
//     graph.execute(cmd);
//
// The order of reads and writes is the binding order in set 0 of the shader. Attachments are not bindings.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/program.h"
#include "gpu/resources.h"
#include "graph/plan.h"

namespace obscura::graph {

struct ImageId { uint32_t index = ~0u; explicit operator bool() const { return index != ~0u; } bool operator==(const ImageId&) const = default; };
struct BufferId { uint32_t index = ~0u; explicit operator bool() const { return index != ~0u; } };

enum class Sampling : uint8_t { nearest, linear, nearestRepeat, linearRepeat, shadow };  // clamp to edge unless said; shadow: compare >=, border 0 (far)

// An image that outlives a frame: two copies, last frame's to read and this frame's to write. Owned by whoever needs the
// history; `invalidate` after a camera cut or a method switch, a change of description does so by itself.
class History {
public:
    void invalidate() { m_valid = false; }
    bool valid() const { return m_valid; }

private:
    friend class Graph;
    gpu::Image m_images[2];
    std::vector<State> m_states[2];
    uint32_t m_current = 0;
    bool m_valid = false;
};

// An image from outside. The views must stay alive until the frame has left the GPU.
struct External {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    gpu::ImageDesc desc;               // one mip
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;       // on entry; UNDEFINED: contents do not matter
    VkImageLayout layoutAfter = VK_IMAGE_LAYOUT_UNDEFINED;  // UNDEFINED: as the last pass leaves it
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;  // last used by; also waits on the acquire semaphore here
};

// Part of a buffer from outside, written before and kept until the frame has left the GPU.
struct ExternalBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    uint64_t offset = 0, bytes = 0;
};

struct PassTime {
    std::string name;
    double milliseconds = 0.0;
};

struct Timings {
    uint64_t frame = 0;                // the device's frame number these belong to
    std::vector<PassTime> passes;      // in execution order
    double milliseconds = 0.0;         // first to last timestamp
};

class Graph;

// What a recording callback gets: inside rendering when the pass has attachments, program and set 0 bound when it has one.
struct PassContext {
    VkCommandBuffer cmd;
    const gpu::Device& device;
    const gpu::Program* program;
    const Graph& graph;
    VkExtent2D extent;                 // of the attachments
    void push(const void* data, uint32_t bytes, uint32_t offset = 0) const;
    VkImageView view(ImageId id, uint32_t mip = ~0u) const;
    VkImage image(ImageId id) const;
    ExternalBuffer buffer(BufferId id) const;
};
using Record = std::function<void(const PassContext&)>;

class Pass {
public:
    Pass& read(ImageId image, Sampling sampling = Sampling::nearest);
    Pass& readMip(ImageId image, uint32_t mip, Sampling sampling = Sampling::nearest);
    Pass& read(BufferId buffer);
    Pass& write(ImageId image);
    Pass& writeMip(ImageId image, uint32_t mip);
    Pass& write(BufferId buffer);
    Pass& color(ImageId image, std::optional<VkClearColorValue> clear = std::nullopt);
    Pass& depth(ImageId image, std::optional<float> clear = std::nullopt);
    Pass& depthTest(ImageId image);
    // A use that is no shader binding: transfers, vertex and index buffers, attachments of a foreign render pass.
    Pass& use(ImageId image, Access access, bool discard = false);
    Pass& use(BufferId buffer, Access access);
    Pass& keep();                                      // never culled
    template <class T> Pass& constants(const T& value) { return constants(&value, sizeof(T)); }
    Pass& constants(const void* data, uint32_t bytes); // at most 128 bytes, copied
    void dispatch(uint32_t x, uint32_t y = 1, uint32_t z = 1);  // invocations, rounded up to whole workgroups
    void draw(uint32_t vertices, uint32_t instances = 1);
    void record(Record record);

private:
    friend class Graph;
    struct Bound { bool isBuffer; uint32_t resource; uint32_t mip; Sampling sampling; bool writes; };
    struct Attachment { uint32_t resource; bool clear; VkClearValue value; };
    enum class Work : uint8_t { none, dispatch, draw, record };
    Graph* m_graph = nullptr;
    gpu::Program* m_program = nullptr;
    uint32_t m_index = 0;
    std::vector<Bound> m_bound;
    std::vector<Attachment> m_colors;
    std::optional<Attachment> m_depth;
    std::vector<std::byte> m_constants;
    VkDescriptorSet m_set = VK_NULL_HANDLE;
    Work m_work = Work::none;
    uint32_t m_size[3] = {1, 1, 1};
    Record m_record;
};

class Graph {
public:
    // `rehearsal`: to be declared like any other and never executed; makes nothing on the GPU. rehearsedBytes() is what it is for.
    explicit Graph(gpu::Device& device, bool rehearsal = false);
    ~Graph();
    Graph(const Graph&) = delete;

    // Forgets last frame's passes. The device's nextFrame() has been called for this frame.
    void begin();

    ImageId image(std::string name, gpu::ImageDesc desc);  // transient; usage is worked out
    ImageId import(std::string name, const External& image);
    enum class Shared : uint8_t { constant, written };     // constant: the GPU never writes it; written: it may have
    BufferId import(std::string name, const gpu::Buffer& buffer, Shared shared);
    BufferId import(std::string name, const ExternalBuffer& buffer);
    // Host data for this frame, copied now. Bound as uniform or storage buffer.
    BufferId upload(std::string name, const void* data, size_t bytes);
    template <class T> BufferId upload(std::string name, const T& value) { return upload(std::move(name), &value, sizeof(T)); }
    // A transient buffer in device memory, from a pool of its own.
    BufferId buffer(std::string name, uint64_t bytes);
    struct HistoryPair { ImageId previous, current; bool valid; };  // previous may be read even when not valid: it is cleared to 0
    HistoryPair history(std::string name, gpu::ImageDesc desc, History& history);

    Pass& pass(std::string name, gpu::Program& program);
    Pass& pass(std::string name);
    // Names of passes declared from here on begin with this, until the next begin(): two runs of a method in one frame stay apart.
    void prefix(std::string text) { m_prefix = std::move(text); }
    void output(ImageId image);                            // keep what writes it

    // Records everything, or nothing: Status::invalid (with a log line) when the recording contradicts itself or the shaders, or what the
    // device lacked. A frame that failed may be begun again.
    gpu::Status execute(VkCommandBuffer cmd);

    void setTiming(bool on) { m_timing = on; }
    const Timings& timings() const { return m_timings; }   // of the newest frame whose timestamps have arrived
    const gpu::ImageDesc& desc(ImageId id) const;
    const std::string& name(ImageId id) const;
    bool isTransient(ImageId id) const { return m_recording.resources[id.index].kind == Kind::transient; }
    // What each pass of this frame's recording writes, for "view any pass": valid between begin and execute.
    struct Written { std::string pass; ImageId image; };
    std::vector<Written> written() const;
    std::string planText() const;                          // of the last executed frame
    std::string planDot() const;
    uint64_t poolBytes() const;
    // Device memory that this frame's passes have in use: pooled images and buffers, histories, buffers from outside. After execute().
    uint64_t frameBytes() const;
    // Device memory that graphs declared like this one come to hold: pool, histories, uploads of all frames in flight. 0, logged, when
    // the recording contradicts itself. Of a rehearsal, once.
    uint64_t rehearsedBytes();
    bool rehearsal() const { return m_rehearsal; }
    gpu::Device& device() const { return m_device; }

private:
    friend class Pass;
    friend struct PassContext;
    struct Frame;                                          // descriptor pools, queries, upload memory of one frame in flight
    struct Physical;                                       // what a resource is on the GPU this frame
    struct PoolImage;
    struct PoolBuffer;
    bool bindings();
    gpu::Status realize();
    gpu::Status prepare();
    gpu::Status fillSet(Pass& pass);
    void bind(VkCommandBuffer cmd, const Pass& pass);
    void barriers(VkCommandBuffer cmd, const std::vector<Barrier>& list);
    void run(VkCommandBuffer cmd, Pass& pass);
    void timestamp(VkCommandBuffer cmd);
    void collectTimings(Frame& frame);
    bool check(const Pass& pass);
    uint32_t add(Resource resource);

    gpu::Device& m_device;
    const bool m_rehearsal;
    uint64_t m_rehearsed = 0;                              // bytes of histories and buffers
    Recording m_recording;
    Plan m_plan;
    std::vector<Slot> m_slotsBefore;                       // the pool's images as the last executed frame left them
    bool m_lost = false;                                   // the device, says a query
    std::deque<Pass> m_passes;
    std::string m_prefix;                                  // of pass names
    std::vector<Physical> m_physical;
    std::vector<PoolImage> m_pool;
    std::vector<PoolBuffer> m_buffers;
    std::vector<std::unique_ptr<Frame>> m_frames;
    Frame* m_frame = nullptr;
    struct PendingHistory { History* history; uint32_t previous, current; };
    std::vector<PendingHistory> m_histories;
    bool m_timing = true;
    Timings m_timings;
};

}  // namespace obscura::graph
