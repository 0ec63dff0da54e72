// Owns device, shaders, renderer, graph, frames in flight and capture; destroys them in the right order.
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

    // Uploads the scene, makes the pipelines of one method (or of all) and runs each once at a small size: some drivers
    // compile at the first dispatch, which would be a hitch in the game.
    void prepare(const Options& options, Stage& stage, bool allMethods);

    gpu::Device& device() { return *m_device; }
    render::Renderer& renderer() { return *m_renderer; }
    graph::Graph& graph() { return *m_graph; }
    app::Frames& frames() { return *m_frames; }
    app::Capture& capture() { return *m_capture; }
    gpu::ShaderLibrary& shaders() { return m_shaders; }
    bool reloads() const { return m_reloads; }  // edited shaders are reloaded

    // Throws app::Complaint for anything but ok, with the last log message.
    void expect(gpu::Status status, const char* doing) const;
    const std::vector<std::string>& messages() const { return m_messages; }  // warnings and errors so far
    // Start-up times, seconds.
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
