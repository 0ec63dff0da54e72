// A pass: the resources it reads and writes, its constants and its work.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gpu/program.h"
#include "gpu/resources.h"
#include "graph/access.h"

namespace obscura::graph {

struct ImageId {
    uint32_t index = ~0u;
    explicit operator bool() const { return index != ~0u; }
    bool operator==(const ImageId&) const = default;
};
struct BufferId {
    uint32_t index = ~0u;
    explicit operator bool() const { return index != ~0u; }
};

using gpu::Sampling;

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
    uint64_t frame = 0;            // the device's frame number these belong to
    std::vector<PassTime> passes;  // in execution order
    double milliseconds = 0.0;     // first to last timestamp
};

class Executor;
class Graph;

// What a recording callback gets: inside rendering when the pass has attachments, program and set 0 bound when it has one.
struct PassContext {
    VkCommandBuffer cmd;
    const gpu::Device& device;
    const gpu::Program* program;
    const Executor& executor;
    VkExtent2D extent;  // of the attachments
    void push(const void* data, uint32_t bytes, uint32_t offset = 0) const;
    VkImageView view(ImageId id, uint32_t mip = ~0u) const;  // all mips, or one
    VkImage image(ImageId id) const;
    ExternalBuffer buffer(BufferId id) const;
};

// Called once, during Executor::execute(), after all declarations: capture by value.
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
    Pass& keep();  // never culled
    template <class T> Pass& constants(const T& value) { return constants(&value, sizeof(T)); }
    Pass& constants(const void* data, uint32_t bytes);          // at most 128 bytes, copied
    void dispatch(uint32_t x, uint32_t y = 1, uint32_t z = 1);  // invocations, rounded up to whole workgroups
    void draw(uint32_t vertices, uint32_t instances = 1);
    void record(Record record);

private:
    friend class Graph;
    friend class Executor;
    struct Bound {
        bool isBuffer;
        uint32_t resource;
        uint32_t mip;
        Sampling sampling;
        bool writes;
    };
    struct Attachment {
        uint32_t resource;
        bool clear;
        VkClearValue value;
    };
    enum class Work : uint8_t { none, dispatch, draw, record };
    Graph* m_graph = nullptr;
    gpu::Program* m_program = nullptr;
    uint32_t m_index = 0;
    size_t m_declaredUses = 0;  // of the recording's, those that use() added; resolve() adds the shader's behind them
    std::vector<Bound> m_bound;
    std::vector<Attachment> m_colors;
    std::optional<Attachment> m_depth;
    std::vector<std::byte> m_constants;
    Work m_work = Work::none;
    uint32_t m_size[3] = {1, 1, 1};
    Record m_record;
};

}  // namespace obscura::graph
