// The recording of one frame: descriptions of images, buffers and passes, in execution order. Declaring changes nothing outside the graph,
// so a frame may be declared to ask a question (how much memory?) and thrown away. executor.h runs it:
//     graph.begin();
//     ImageId depth = graph.image("depth", {VK_FORMAT_R32_SFLOAT, w, h});
//     graph.pass("linearize", m_linearize).read(device).write(depth).constants(c).dispatch(w, h);
//     executor.execute(graph, cmd);
//
// The order of reads and writes is the binding order in set 0 of the shader. Attachments are not bindings.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "graph/pass.h"
#include "graph/plan.h"

namespace obscura::graph {

// An image that outlives a frame: two copies, last frame's to read and this frame's to write. Owned by its user. A change of description
// invalidates it; else only the executor changes it, when a frame has been recorded.
class History {
public:
    void invalidate() { m_valid = false; }
    bool valid() const { return m_valid; }

private:
    friend class Graph;
    friend class Executor;
    struct Copy {
        gpu::Image image;
        std::vector<State> states;  // one a mip
    };
    Copy m_copies[2];
    uint32_t m_current = 0;  // which of the two the next frame writes
    bool m_valid = false;
};

// An image from outside. The views must stay alive until the frame has left the GPU.
struct External {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    gpu::ImageDesc desc;                                                  // one mip
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;                     // on entry; UNDEFINED: contents do not matter
    VkImageLayout layoutAfter = VK_IMAGE_LAYOUT_UNDEFINED;                // UNDEFINED: as the last pass leaves it
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;  // last used by; also waits on the acquire semaphore here
    uint32_t mip = 0, layer = 0;                                          // that `view` shows
};

class Graph;

// What the resources of a frame take at their largest, by name and, of those of one name, by their order. Frames that are declared with it
// live in the same images, buffers and pieces of memory, whatever their sizes.
class Capacity {
public:
    void grow(const Graph& graph);  // so that all that is declared there fits
    void clear() { *this = {}; }

private:
    friend class Graph;
    struct Slot {
        gpu::ImageDesc desc;
        uint64_t bytes = 0;
        bool holds(const Resource& resource) const;
    };
    std::map<std::string, std::vector<Slot>> m_slots;
    uint32_t m_passCount = 0;
};

class Graph {
public:
    explicit Graph(gpu::Device& device) : m_device(device) {}
    Graph(const Graph&) = delete;

    // Forgets the last frame's declarations. `timings`: of an earlier frame, for declarations that depend on cost; kept by reference.
    // `capacity`: what to make for those that are declared now; likewise.
    void begin(const Timings* timings = nullptr, const Capacity* capacity = nullptr);
    bool fits() const { return m_fits; }  // all that was declared since then, in the capacity that was given

    ImageId image(std::string name, gpu::ImageDesc desc);  // transient; usage is worked out
    ImageId import(std::string name, const External& image);
    enum class Shared : uint8_t { constant, written };  // constant: the GPU never writes it; written: it may have
    BufferId import(std::string name, const gpu::Buffer& buffer, Shared shared);
    BufferId import(std::string name, const ExternalBuffer& buffer);
    BufferId buffer(std::string name, uint64_t bytes);  // transient, device memory
    // Host data for this frame, copied now. Bound as uniform or storage buffer.
    BufferId upload(std::string name, const void* data, size_t bytes);
    template <class T> BufferId upload(std::string name, const T& value) { return upload(std::move(name), &value, sizeof(T)); }
    struct HistoryPair {
        ImageId previous, current;
        bool valid;
    };
    // `previous` may be read even when not valid: it is cleared to 0. `discard`: not valid this frame, whatever is there (camera cut).
    HistoryPair history(std::string name, gpu::ImageDesc desc, History& history, bool discard = false);

    Pass& pass(std::string name, gpu::Program& program) { return add(std::move(name), &program); }
    Pass& pass(std::string name) { return add(std::move(name), nullptr); }
    void prefix(std::string text) { m_prefix = std::move(text); }                     // of the names of passes declared from here on
    void output(ImageId image) { m_recording.resources[image.index].output = true; }  // keep what writes it
    // Runs when the frame has been recorded, not when that failed: the place to remember what the frame leaves behind. Must not throw.
    void onRecorded(std::function<void()> then) { m_onRecorded.push_back(std::move(then)); }

    gpu::Device& device() const { return m_device; }       // for its limits and its log
    const Timings& timings() const { return *m_timings; }  // those given to begin(); without passes if none were
    const gpu::ImageDesc& desc(ResourceId id) const { return m_recording.resources[id.index].desc; }
    const gpu::ImageDesc& made(ResourceId id) const { return m_recording.resources[id.index].made(); }                // the image behind it
    size_t passCount() const { return std::max(m_passes.size(), m_capacity ? size_t(m_capacity->m_passCount) : 0); }  // most to come
    const std::string& name(ResourceId id) const { return m_recording.resources[id.index].name; }
    // What each pass declared so far writes, for "view any pass".
    struct Written {
        std::string pass;
        ImageId image;
    };
    std::vector<Written> written() const;
    // The uses that the shaders of its passes imply, added to those declared. False, logged, when a pass contradicts its shaders.
    bool resolve();
    const Recording& recording() const { return m_recording; }
    const Pass& declared(uint32_t pass) const { return m_passes[pass]; }  // by its index in the recording, after resolve()

private:
    friend class Capacity;
    friend class Executor;
    struct HistoryUse {
        History* history;
        uint32_t resources[2];  // of its copies
    };
    Pass& add(std::string name, gpu::Program* program);
    uint32_t add(Resource resource, const Physical& physical = {});
    std::string resolve(const Pass& pass, std::vector<Use>& uses) const;

    gpu::Device& m_device;
    static inline const Timings kNoTimings;
    const Timings* m_timings = &kNoTimings;
    Recording m_recording;
    std::deque<Pass> m_passes;         // a reference to one is handed out: they do not move
    std::vector<Physical> m_physical;  // by resource; of imported ones
    std::vector<HistoryUse> m_histories;
    std::vector<std::function<void()>> m_onRecorded;
    std::string m_prefix;
    const Capacity* m_capacity = nullptr;
    std::map<std::string, size_t> m_declared;  // how many of each name, with a capacity
    bool m_fits = true;
};

}  // namespace obscura::graph
