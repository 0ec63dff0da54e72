// What the game draws with: device, shaders, graph and frames in flight (app::Graphics), renderer and capture; start-up and its times.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/capture.h"
#include "app/graphics.h"
#include "app/statistics.h"
#include "app/window.h"
#include "options.h"
#include "stage.h"

namespace obscura::game {

// Sum of the medians of obscurance passes, ms: the methods', those of depth layers and voxels; of one side, "A." or "B.", or of all.
double obscuranceCost(const app::Statistics& statistics, std::string_view side = {});

class Engine : public app::Graphics {
public:
    // `window` may be null. Throws app::Complaint.
    Engine(const Options& options, const app::Window* window);
    ~Engine();

    // Uploads the scene, makes the pipelines of these methods and runs each once at a small size: some drivers compile at the first
    // dispatch, which would be a hitch in the game. The chosen method must succeed; others that the device cannot run are skipped.
    void prepare(const Options& options, Stage& stage, std::span<const ao::MethodInfo* const> methods);
    // The same of one more method, between frames. Discards histories.
    void warmUp(const Options& options, Stage& stage, const ao::MethodInfo& info);

    // Median GPU time, ms, of each setting's obscurance in a frame of the window's size seen from the start camera, in order; stops after
    // the first that takes more than `enough`, or when `seconds` have passed. Software devices render a quarter of the pixels, and the
    // result is scaled. Empty if the device has no timestamps.
    std::vector<double> costs(const Options& options, Stage& stage, std::span<const ao::Values> settings, double enough, double seconds);

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
