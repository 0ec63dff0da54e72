// Asynchronous readback of images: requested while a frame is declared, delivered once the GPU has finished that frame.
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
    static constexpr const char* kPass = "capture";  // name of its passes
    using Done = std::function<void(Picture&&)>;
    explicit Capture(gpu::Device& device) : m_device(device) {}

    // R8G8B8A8_UNORM unchanged, or R16_SFLOAT in [0, 1] as grey without sRGB encoding.
    gpu::Status add(graph::Graph& graph, graph::ImageId image, Done done);
    // Any format, unconverted, rows tightly packed. The bytes are valid during the callback only.
    using Raw = std::function<void(std::span<const std::byte>)>;
    gpu::Status addRaw(graph::Graph& graph, graph::ImageId image, Raw done);
    // Runs the callbacks of finished frames: call it after Frames::begin(), or with `all` after Frames::wait().
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
