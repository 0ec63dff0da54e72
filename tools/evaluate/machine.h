// Device, renderer, library and graph of a measurement; renders frames, reads images back and collects pass times.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ao/library.h"
#include "app/frames.h"
#include "render/renderer.h"
#include "truth/screen_reference.h"

namespace obscura::evaluate {

class Machine {
public:
    struct Choice {
        std::string device, validation = "off";
        bool verbose = false;
    };
    explicit Machine(const Choice& choice);  // throws app::Complaint
    ~Machine();

    gpu::Device& device() { return *m_device; }
    const std::string& deviceName() const { return m_device->caps().deviceName; }
    // A new renderer for a scene, so that no state of an earlier scene affects it. Destroys the last one.
    render::Renderer& newRenderer();
    // A renderer owned by the caller; it must be destroyed before the machine.
    std::unique_ptr<render::Renderer> makeRenderer();
    render::Renderer& renderer() { return *m_renderer; }
    // Created on first use; throw app::Complaint.
    ao::Library& library();  // for captured frames
    truth::ScreenReference& screen();
    // Makes the method's pipelines in `library`; throws app::Complaint.
    void expectMethod(ao::Library& library, const ao::MethodInfo& info);

    // Renders frames that `declare` fills; `declare` returns the images to read back after the last one. Throws app::Complaint.
    using Declare = std::function<std::vector<graph::ImageId>(graph::Graph&, uint32_t frame)>;
    struct Ran {
        std::vector<std::vector<std::byte>> images;  // tightly packed rows
        std::vector<graph::PassTime> passes;         // medians over the timed frames, in execution order
        std::vector<graph::Timings> frames;          // every timed frame
        uint64_t bytes = 0;                          // Executor::frameBytes() of the last one
    };
    Ran run(uint32_t warmUp, uint32_t timed, const Declare& declare);

private:
    void expect(gpu::Status status, const char* doing) const;
    std::vector<std::string> m_messages;  // warnings and errors so far
    std::unique_ptr<gpu::Device> m_device;
    gpu::ShaderLibrary m_shaders;
    std::unique_ptr<graph::Graph> m_graph;
    std::unique_ptr<app::Frames> m_frames;
    std::unique_ptr<render::Renderer> m_renderer;
    std::unique_ptr<ao::Library> m_library;
    std::unique_ptr<truth::ScreenReference> m_screen;
};

}  // namespace obscura::evaluate
