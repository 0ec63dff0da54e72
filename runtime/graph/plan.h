// What a frame's passes need of each other, worked out without a GPU: which passes run, which physical image a transient
// lives in, which barriers stand before each pass. Pure: the same recording and states give the same plan, which tests
// compare as text.
#pragma once

#include <map>
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
    VkPipelineStageFlags2 readStages = 0;   // reads since that write
    struct Visible { VkPipelineStageFlags2 stages; VkAccessFlags2 access; };
    std::vector<Visible> visible;           // to whom the write has been made visible
};

enum class Kind : uint8_t { transient, imported, buffer };

struct Resource {
    std::string name;
    Kind kind = Kind::transient;
    gpu::ImageDesc desc;             // images; usage is added up by the plan
    std::vector<State> initial;      // imported: one a mip (buffers: one); transients start from their slot's
    Access finalAccess = Access::none;  // imported images: left like this after the last pass
    VkImageLayout finalLayout = VK_IMAGE_LAYOUT_UNDEFINED;  // or in this layout, for hosts; overrides finalAccess
    bool output = false;             // whoever writes it is not culled
};

struct Use {
    uint32_t resource = 0;
    uint32_t firstMip = 0, mips = 1;
    Access access = Access::none;
    VkPipelineStageFlags2 stages = 0;
    bool discard = false;            // a write that needs nothing of what was there (clear, full overwrite)
};

struct PassDesc {
    std::string name;
    std::vector<Use> uses;
    bool keep = false;               // has effects the graph cannot see
};

struct Recording {
    std::vector<Resource> resources;
    std::vector<PassDesc> passes;
};

struct Barrier {
    uint32_t resource = 0;
    uint32_t firstMip = 0, mips = 1;
    VkPipelineStageFlags2 srcStages = 0, dstStages = 0;
    VkAccessFlags2 srcAccess = 0, dstAccess = 0;
    VkImageLayout from = VK_IMAGE_LAYOUT_UNDEFINED, to = VK_IMAGE_LAYOUT_UNDEFINED;
};

// A physical image of the pool: the n-th one of its description.
struct Slot {
    gpu::ImageDesc desc;
    uint32_t ordinal = 0;
    std::vector<State> state;  // one a mip: in, as the previous frame left it; out, as this frame does
};

struct Plan {
    struct Step {
        uint32_t pass = 0;
        std::vector<Barrier> barriers;
    };
    std::vector<Step> steps;            // in declaration order, culled passes left out
    std::vector<Barrier> closing;       // after the last pass: imported images into their final layout
    std::vector<int> slotOf;            // per resource; -1 for imported ones and those of culled passes
    std::vector<Slot> slots;
    std::vector<std::vector<State>> finalStates;  // per resource, of imported ones
    std::vector<std::string> problems;  // reads of what nobody wrote; each names the pass and the image

    std::string text(const Recording& recording) const;
    std::string dot(const Recording& recording) const;
};

// `slots` are the pool's images with the states in which the previous frame left them.
Plan plan(const Recording& recording, const std::vector<Slot>& slots = {});

}  // namespace obscura::graph
