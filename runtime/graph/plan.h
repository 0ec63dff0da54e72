// A frame's plan, worked out without a GPU: which passes run, which image or buffer of the pool each transient lives in, where uploads lie,
// which barriers stand before each pass. Pure: the same recording and states give the same plan, which tests compare as text.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gpu/resources.h"
#include "graph/access.h"

namespace obscura::graph {

// What is known of one mip (or one buffer) at a point in the command stream.
struct State {
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkPipelineStageFlags2 writeStages = 0;  // last write or layout change; 0: never written
    VkAccessFlags2 writeAccess = 0;
    VkPipelineStageFlags2 readStages = 0;  // reads since that write
    struct Visible {
        VkPipelineStageFlags2 stages;
        VkAccessFlags2 access;
    };
    std::vector<Visible> visible;  // to whom the write has been made visible
};

enum class Origin : uint8_t {
    transient,  // from the pool, contents undefined until written
    upload,     // a buffer in the frame's upload memory
    history,    // an image that outlives the frame, owned by a History
    imported,
};

struct Resource {
    std::string name;
    Origin origin = Origin::transient;
    bool isBuffer = false;
    gpu::ImageDesc desc;          // images; usage is added up by the plan. Buffers: one mip
    uint64_t bytes = 0;           // buffers
    std::vector<std::byte> data;  // uploads
    std::vector<State> initial;   // history, imported: one a mip (buffers: one); transients start from their slot's
    VkImageLayout finalLayout = VK_IMAGE_LAYOUT_UNDEFINED;  // imported images: in this layout after the last pass; UNDEFINED: as it comes
    bool output = false;                                    // what writes it is not culled
    // What is made for it, where that is larger: a description with a format, a count above 0. See Capacity in graph.h.
    gpu::ImageDesc largest;
    uint64_t largestBytes = 0;

    const gpu::ImageDesc& made() const { return largest.format == VK_FORMAT_UNDEFINED ? desc : largest; }
    uint64_t madeBytes() const { return largestBytes ? largestBytes : bytes; }
};

struct Use {
    uint32_t resource = 0, firstMip = 0, mips = 1;
    Access access = Access::none;
    VkPipelineStageFlags2 stages = 0;
    bool discard = false;  // a write that needs nothing of what was there (clear, full overwrite)
};

struct PassDesc {
    std::string name;
    std::vector<Use> uses;
    bool keep = false;  // has effects the graph cannot see
};

struct Recording {
    std::vector<Resource> resources;
    std::vector<PassDesc> passes;
};

struct Barrier {
    uint32_t resource = 0, firstMip = 0, mips = 1;
    VkPipelineStageFlags2 srcStages = 0, dstStages = 0;
    VkAccessFlags2 srcAccess = 0, dstAccess = 0;
    VkImageLayout from = VK_IMAGE_LAYOUT_UNDEFINED, to = VK_IMAGE_LAYOUT_UNDEFINED;  // buffers: UNDEFINED
    bool operator==(const Barrier&) const = default;
};

// A physical image or buffer of the pool.
struct Slot {
    gpu::ImageDesc desc;       // images
    uint64_t bytes = 0;        // buffers; 0: an image
    std::vector<State> state;  // one a mip: in, as the previous frame left it; out, as this frame does
};

// Where an upload lies in the upload memory of its frame.
struct Placement {
    uint32_t chunk = 0;
    uint64_t offset = 0;
};

struct Plan {
    struct Step {
        uint32_t pass = 0;
        std::vector<Barrier> barriers;
    };
    std::vector<Step> steps;       // in declaration order, culled passes left out
    std::vector<Barrier> closing;  // after the last pass: imported images into their final layout
    std::vector<int> slotOf;       // by resource; -1 for those that are not transient and those of culled passes
    std::vector<Slot> slots;
    std::vector<Placement> placements;            // by resource, of uploads
    std::vector<uint64_t> chunks;                 // bytes of each piece of upload memory
    std::vector<std::vector<State>> finalStates;  // by resource, of those that are not transient
    std::vector<std::string> problems;            // reads of what nobody wrote; each names the pass and the image

    std::string text(const Recording& recording) const;
    std::string dot(const Recording& recording) const;
    std::string names(const Recording& recording, size_t slot, const char* separator) const;  // of the transients that live in a slot
};

// What the frame finds: the pool, in the states in which the previous frame left it, and the sizes of its pieces of upload memory.
Plan plan(const Recording& recording, std::vector<Slot> slots = {}, std::vector<uint64_t> chunks = {});

constexpr VkBufferUsageFlags kUploadUsage =
    VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
constexpr VkBufferUsageFlags kPoolBufferUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

// Device memory of the pool, the histories, and the uploads of all frames in flight. The device tells what an image or a buffer takes.
struct MemoryOf {
    std::function<uint64_t(const gpu::ImageDesc&)> image;
    std::function<uint64_t(uint64_t bytes, VkBufferUsageFlags usage, gpu::Memory memory)> buffer;
};
uint64_t bytes(const Recording& recording, const Plan& plan, uint32_t framesInFlight, const MemoryOf& memory);

}  // namespace obscura::graph
