// Device, shaders, renderer and graph, started together and ended in the right order.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/capture.h"
#include "app/frames.h"
#include "app/window.h"
#include "options.h"
#include "render/renderer.h"
#include "stage.h"

namespace obscura::game {

class Engine {
public:
    // `window` may be null. Throws app::Complaint.
    Engine(const Options& options, app::Window* window);
    ~Engine();

    // Uploads the scene, makes the pipelines of one method (or of all) and runs each once at a tiny size: some drivers
    // compile at the first dispatch, and nobody should see that happen.
    void prepare(const Options& options, Stage& stage, bool allMethods);

    gpu::Device& device() { return *m_device; }
    render::Renderer& renderer() { return *m_renderer; }
    graph::Graph& graph() { return *m_graph; }
    app::Frames& frames() { return *m_frames; }
    app::Capture& capture() { return *m_capture; }
    gpu::ShaderLibrary& shaders() { return m_shaders; }
    bool reloads() const { return m_reloads; }  // edited shaders are watched

    // Throws app::Complaint for anything but ok, with the last thing the log said.
    void expect(gpu::Status status, const char* doing) const;
    const std::vector<std::string>& messages() const { return m_messages; }  // warnings and errors so far
    // Seconds that starting took, in parts.
    struct Started {
        double device = 0.0, scene = 0.0, pipelines = 0.0, warmUp = 0.0;
        bool cacheFound = false;  // a pipeline cache was on disk
        double total() const { return device + scene + pipelines + warmUp; }
    };
    Started started;

private:
    void frameOnce(const Options& options, Stage& stage, const ao::Values& values, const ao::Values* compare, render::View view);
    bool m_verbose;
    bool m_reloads = false;
    std::vector<std::string> m_messages;
    std::unique_ptr<gpu::Device> m_device;
    gpu::ShaderLibrary m_shaders;
    std::unique_ptr<render::Renderer> m_renderer;
    std::unique_ptr<graph::Graph> m_graph;
    std::unique_ptr<app::Frames> m_frames;
    std::unique_ptr<app::Capture> m_capture;
};

}  // namespace obscura::game
