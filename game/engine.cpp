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

void Engine::warmUp(const Options& options, Stage& stage, const ao::MethodInfo& info) {
    for (const render::View view : {render::View::final, render::View::visibility})
        frameOnce(options, stage, options.choice.valuesOf(info), nullptr, view);
}

void Engine::prepare(const Options& options, Stage& stage, std::span<const ao::MethodInfo* const> methods) {
    double begun = app::now();
    {
        app::Progress progress("uploading " + stage.info.name, 1);
        expect(m_renderer->load(stage.world), "uploading the scene");
    }
    started.scene = stage.loadSeconds + (app::now() - begun) * 1e-3;

    begun = app::now();
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
        warmUp(options, stage, *methods[i]);
    }
    const ao::Values* compare = options.compare ? &options.compare->values() : nullptr;
    if (options.view != render::View::pass && !methods.empty()) frameOnce(options, stage, options.choice.values(), compare, options.view);
    expect(frames().wait(), "warming up");
    started.warmUp = (app::now() - begun) * 1e-3;
}

double obscuranceCost(const app::Statistics& statistics, std::string_view side) {
    // The passes that draw a frame and are no method's.
    constexpr std::string_view kFrame[] = {"antialias", "blend", "capture", "deform", "deform.grow", "depth", "difference", "gbuffer",
        "lighting", "overlay", "present", "samples", "shadow", "shadow.copy", "shadow.rest", "split", "tone map", "view", "voxels.view"};
    double sum = 0.0;
    for (const app::Series& pass : statistics.passes())
        if (pass.name.starts_with(side) && std::find(std::begin(kFrame), std::end(kFrame), pass.name) == std::end(kFrame))
            sum += pass.median();
    return sum;
}

std::vector<double> Engine::costs(
    const Options& options, Stage& stage, std::span<const ao::Values> settings, double enough, double seconds) {
    constexpr uint32_t kSettling = 2, kTimed = 3;  // frames
    std::vector<double> costs;
    if (!device().caps().timestamps) return costs;
    const double begun = app::now();
    const uint32_t divisor = device().caps().software ? 2 : 1;
    const auto passesOf = [&](const ao::Values& values) {
        render::FrameOptions frame;
        frame.visible = {std::max(options.size.width / divisor, 1u), std::max(options.size.height / divisor, 1u)};
        frame.guard = options.guard;
        frame.camera = stage.camera(options.camera, options.time);
        frame.time = options.time;
        frame.method = &values;
        frame.falloff = options.choice.falloff;
        frame.voxels = options.voxels;
        app::Statistics statistics(kTimed);
        const uint32_t frameCount = kSettling + kTimed;
        for (uint32_t i = 0; i < frameCount + device().framesInFlight(); ++i) {
            expect(frames().begin(graph()), "measuring");
            if (i >= device().framesInFlight()) statistics.add(graph().timings());
            if (i < frameCount) graph().output(m_renderer->add(graph(), stage.world, frame).color);
            expect(frames().end(graph()), "measuring");
        }
        return statistics;
    };
    for (const ao::Values& values : settings) {
        costs.push_back(obscuranceCost(passesOf(values)) * double(divisor * divisor));
        if (costs.back() > enough || (app::now() - begun) * 1e-3 > seconds) break;
    }
    return costs;
}

}  // namespace obscura::game
