#include "engine.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "app/progress.h"
#include "gpu/compiler/compile.h"

namespace obscura::game {

namespace fs = std::filesystem;

namespace {

// Side of a warm-up picture, px. Software rasterizers compile one variant for sides that are powers of two and one for all
// others, so a warm-up side is a power of two if and only if the window's is.
uint32_t warmUpSide(uint32_t side) {
    uint32_t tiny = std::max(side / 8, 24u);
    while (std::has_single_bit(tiny) != std::has_single_bit(side)) ++tiny;
    return tiny;
}

app::Graphics::Choice graphicsOf(const Options& options, const app::Window* window) {
    fs::path cache;
    if (!options.noPipelineCache)
        cache = options.pipelineCache.empty() ? app::Graphics::pipelineCacheFile() : fs::path(options.pipelineCache);
    return {options.device, options.validation, options.verbose, "obscura", cache, options.noPresent ? nullptr : window};
}

}  // namespace

Engine::Engine(const Options& options, const app::Window* window) : Engine(options, window, app::now()) {}

Engine::Engine(const Options& options, const app::Window* window, double begun) : Graphics(graphicsOf(options, window)) {
    started.cacheFound = pipelineCacheFound();
    started.device = (app::now() - begun) * 1e-3;

    const double pipelinesBegun = app::now();
    const char* named = std::getenv("OBSCURA_SHADERS");
    const fs::path sources = named && *named ? fs::path(named) : fs::path(OBSCURA_SOURCE_DIR) / "shaders";
    std::error_code ignored;
    if (fs::is_directory(sources, ignored)) {
        shaders().watch(sources, gpu::compileShader);
        m_reloads = true;
    }
    m_renderer = makeRenderer();
    m_capture = std::make_unique<app::Capture>(device());
    started.pipelines = (app::now() - pipelinesBegun) * 1e-3;
}

Engine::~Engine() { waitIdle(); }

void Engine::frameOnce(const Options& options, Stage& stage, const ao::Values& values, const ao::Values* compare, render::View view) {
    expect(frames().begin(graph()), "warming up");
    render::FrameOptions frame;
    frame.visible = {warmUpSide(options.size.width), warmUpSide(options.size.height)};
    frame.guard = options.guard;
    frame.camera = stage.startCamera();
    frame.method = &values;
    frame.falloff = options.choice.falloff;
    frame.compare = compare;
    frame.view = view;
    frame.antialiasing = options.antialiasing;
    frame.cut = true;
    frame.voxels = options.voxels;
    const render::Outputs outputs = m_renderer->add(graph(), stage.world, frame);
    graph().output(outputs.color);
    expect(frames().end(graph()), "warming up");
}

void Engine::prepare(const Options& options, Stage& stage, bool allMethods) {
    double begun = app::now();
    {
        app::Progress progress("uploading " + stage.info.name, 1);
        expect(m_renderer->load(stage.world), "uploading the scene");
    }
    started.scene = stage.loadSeconds + (app::now() - begun) * 1e-3;

    begun = app::now();
    std::vector<const ao::MethodInfo*> methods;
    if (allMethods) methods.assign(ao::methods().begin(), ao::methods().end());
    else methods.push_back(&options.choice.info());
    {
        app::Progress progress("making pipelines", methods.size());
        for (size_t i = 0; i < methods.size(); ++i) {
            progress.at(i, methods[i]->id);
            // The library skips a method that this device cannot run and logs why; only the selected one must succeed.
            if (!m_renderer->library().prepare(*methods[i], options.choice.falloff.kind) && methods[i] == &options.choice.info())
                expect(gpu::Status::shaderError, "making the method's pipelines");
        }
    }
    if (options.compare && !m_renderer->otherLibrary().prepare(options.compare->info(), options.choice.falloff.kind))
        expect(gpu::Status::shaderError, "making the second method's pipelines");
    started.pipelines += (app::now() - begun) * 1e-3;

    begun = app::now();
    app::Progress progress("warming up", methods.size());
    for (size_t i = 0; i < methods.size(); ++i) {
        progress.at(i, methods[i]->id);
        frameOnce(options, stage, ao::Values(*methods[i]), nullptr, render::View::final);
        frameOnce(options, stage, ao::Values(*methods[i]), nullptr, render::View::visibility);
    }
    const ao::Values* compare = options.compare ? &options.compare->values() : nullptr;
    if (options.view != render::View::pass) frameOnce(options, stage, options.choice.values(), compare, options.view);
    expect(frames().wait(), "warming up");
    started.warmUp = (app::now() - begun) * 1e-3;
}

}  // namespace obscura::game
