// A pass: the resources it reads and writes, its constants and its work.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/program.h"
#include "gpu/resources.h"
#include "gpu/timestamps.h"
#include "graph/plan.h"

namespace obscura::graph {

// Names a resource of one frame's recording.
struct ResourceId {
    uint32_t index = ~0u;
    explicit operator bool() const { return index != ~0u; }
    bool operator==(const ResourceId&) const = default;
};
struct ImageId : ResourceId {};
struct BufferId : ResourceId {};

using gpu::Sampling;

// Part of a buffer from outside, written before and kept until the frame has left the GPU.
struct ExternalBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    uint64_t offset = 0, bytes = 0;
    bool operator==(const ExternalBuffer&) const = default;
};

// What stands behind an id this frame: an image or a buffer.
struct Physical {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;  // all mips
    const gpu::Image* owned = nullptr;  // for views of single mips; null for imported images
    ExternalBuffer buffer;
    uint32_t firstMip = 0, layer = 0;  // of an imported image
    VkImageView mip(uint32_t level) const { return owned ? owned->mipView(level) : view; }
};

struct Timings {
    uint64_t frame = 0;                 // the device's frame number these belong to
    std::vector<gpu::PassTime> passes;  // in execution order
    double milliseconds = 0.0;          // first to last timestamp
};

// What a recording callback gets: inside rendering when the pass has attachments, program and set 0 bound when it has one.
struct PassContext {
    VkCommandBuffer cmd;
    const gpu::Device& device;
    const gpu::Program* program;
    const std::vector<Physical>& resources;  // by index of their ids
    VkExtent2D extent;                       // of the attachments
    void push(const void* data, uint32_t bytes, uint32_t offset = 0) const { program->push(cmd, data, bytes, offset); }
    VkImageView view(ImageId id) const { return resources[id.index].view; }  // all mips
    VkImage image(ImageId id) const { return resources[id.index].image; }
    ExternalBuffer buffer(BufferId id) const { return resources[id.index].buffer; }
};

// Called once, during Executor::execute(), after all declarations: capture by value.
using Record = std::function<void(const PassContext&)>;

class Pass {
public:
    Pass& read(ResourceId id, Sampling sampling = Sampling::nearest) {
        return bind({id.index, 0, VK_REMAINING_MIP_LEVELS, false, sampling});
    }
    Pass& readMip(ImageId id, uint32_t mip, Sampling sampling = Sampling::nearest) { return bind({id.index, mip, 1, false, sampling}); }
    Pass& write(ResourceId id) { return bind({id.index, 0, 1, true}); }  // of an image: mip 0
    Pass& writeMip(ImageId image, uint32_t mip) { return bind({image.index, mip, 1, true}); }
    Pass& color(ImageId image, std::optional<VkClearColorValue> clear = std::nullopt);
    Pass& depth(ImageId image, std::optional<float> clear = std::nullopt);
    Pass& depthTest(ImageId image) { return attach(image, Access::depthTest, std::nullopt); }
    // A use that is no shader binding: transfers, vertex and index buffers, attachments of a foreign render pass.
    Pass& use(ResourceId id, Access access, bool discard = false);
    Pass& keep();                                         // never culled
    template <class T> Pass& constants(const T& value) {  // copied
        static_assert(sizeof(T) <= 128);
        const auto bytes = std::as_bytes(std::span(&value, 1));
        m_constants.assign(bytes.begin(), bytes.end());
        return *this;
    }
    void dispatch(uint32_t x, uint32_t y = 1, uint32_t z = 1);  // invocations, rounded up to whole workgroups
    void record(Record record);

    const gpu::Program* program() const { return m_program; }  // null: work without shaders of its own
    std::span<const std::byte> constants() const { return m_constants; }
    const std::array<uint32_t, 3>& invocations() const { return m_invocations; }  // of dispatch()

private:
    friend class Graph;
    friend class Executor;
    struct Bound {  // to the next binding of set 0
        uint32_t resource, firstMip, mips;
        bool writes;
        Sampling sampling = Sampling::nearest;
    };
    struct Attachment {
        uint32_t resource;
        Access access;  // color, depth or depthTest
        std::optional<VkClearValue> clear;
    };
    Pass& bind(const Bound& bound);
    Pass& attach(ImageId image, Access access, std::optional<VkClearValue> clear);
    gpu::Program* m_program = nullptr;
    PassDesc m_desc;  // without the uses of the bindings, which Graph::resolve() adds
    std::vector<Bound> m_bound;
    std::vector<Attachment> m_attachments;
    std::vector<std::byte> m_constants;
    std::array<uint32_t, 3> m_invocations{};
    Record m_work;
    bool m_recorded = false;  // the work is a callback of record(), which may push constants of its own
};

}  // namespace obscura::graph
