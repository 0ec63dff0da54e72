// What the game draws with: device, shaders, graph and frames in flight (app::Graphics), renderer and capture; start-up and its times.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/capture.h"
#include "app/graphics.h"
#include "app/window.h"
#include "options.h"
#include "stage.h"

namespace obscura::game {

class Engine : public app::Graphics {
public:
    // `window` may be null. Throws app::Complaint.
    Engine(const Options& options, const app::Window* window);
    ~Engine();

    // Uploads the scene, makes the pipelines of one method (or of all) and runs each once at a small size: some drivers
    // compile at the first dispatch, which would be a hitch in the game.
    void prepare(const Options& options, Stage& stage, bool allMethods);

    render::Renderer& renderer() { return *m_renderer; }
    app::Capture& capture() { return *m_capture; }
    bool reloads() const { return m_reloads; }  // edited shaders are reloaded

    // Start-up times, seconds.
    struct Started {
        double device = 0.0, scene = 0.0, pipelines = 0.0, warmUp = 0.0;
        bool cacheFound = false;  // a pipeline cache was on disk
        double total() const { return device + scene + pipelines + warmUp; }
    };
    Started started;

private:
    Engine(const Options& options, const app::Window* window, double begun);
    void frameOnce(const Options& options, Stage& stage, const ao::Values& values, const ao::Values* compare, render::View view);
    bool m_reloads = false;
    std::unique_ptr<render::Renderer> m_renderer;
    std::unique_ptr<app::Capture> m_capture;
};

}  // namespace obscura::game
