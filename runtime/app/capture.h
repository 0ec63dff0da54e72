// Pictures from the GPU to the host without stalling: asked for while a frame is declared, handed over once that frame
// has left the GPU.
#pragma once

#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "app/picture.h"
#include "graph/graph.h"

namespace obscura::app {

class Capture {
public:
    using Done = std::function<void(Picture&&)>;
    explicit Capture(gpu::Device& device) : m_device(device) {}

    // R8G8B8A8_UNORM as it is, or R16_SFLOAT in [0,1] as grey (linear values, not encoded: what a number view shows).
    gpu::Status add(graph::Graph& graph, graph::ImageId image, Done done);
    // Any format as it lies in memory, rows without gaps; the bytes are gone after the call.
    using Raw = std::function<void(std::span<const std::byte>)>;
    gpu::Status addRaw(graph::Graph& graph, graph::ImageId image, Raw done);
    // Hands over what has arrived: after Frames::begin, or everything after Frames::wait (`all`).
    void collect(bool all = false);

private:
    struct Pending {
        uint64_t frame;
        gpu::Buffer buffer;
        Raw done;
    };
    gpu::Device& m_device;
    std::deque<Pending> m_pending;
    std::vector<gpu::Buffer> m_free;
};

}  // namespace obscura::app
