#include "engine.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "app/progress.h"
#include "gpu/compiler/compile.h"

namespace obscura::game {

namespace fs = std::filesystem;
using app::Complaint;

namespace {

// Side of a warm-up picture, px. Software rasterizers compile one variant for sides that are powers of two and one for all
// others, so a warm-up side is a power of two if and only if the window's is.
uint32_t warmUpSide(uint32_t side) {
    uint32_t tiny = std::max(side / 8, 24u);
    while (std::has_single_bit(tiny) != std::has_single_bit(side)) ++tiny;
    return tiny;
}

fs::path pipelineCacheFile(const Options& options) {
    if (options.noPipelineCache) return {};
    if (!options.pipelineCache.empty()) return options.pipelineCache;
    const fs::path folder = app::cacheFolder();
    return folder.empty() ? fs::path() : folder / "pipelines.bin";
}

}  // namespace

Engine::Engine(const Options& options, app::Window* window) : m_verbose(options.verbose) {
    const double begun = app::now();
    const fs::path cache = pipelineCacheFile(options);
    std::error_code ignored;
    started.cacheFound = !cache.empty() && fs::is_regular_file(cache, ignored);
    gpu::DeviceOptions wanted;
    wanted.name = options.device;
    wanted.validation = options.validation != "off";
    wanted.synchronization = options.validation == "sync";
    wanted.pipelineCacheFile = cache.string();
    if (window && !options.noPresent) {
        wanted.instanceExtensions = window->instanceExtensions();
        wanted.presentation = true;
    }
    wanted.log = [this](gpu::Severity severity, const char* message) {
        const std::string line = app::oneLine(message);
        if (severity != gpu::Severity::info) m_messages.push_back(line);
        // Not printed by default: a failure is one line, which ends with the last of these messages.
        if (m_verbose || line.starts_with("validation")) std::fprintf(stderr, "obscura: %s\n", line.c_str());
    };
    std::string error;
    m_device = gpu::Device::create(wanted, error);
    if (!m_device)
        throw Complaint(fmt::format("no device: {}", app::oneLine(error)), options.device.empty() ? app::kFailed : app::kBadInput);
    started.device = (app::now() - begun) * 1e-3;

    const double pipelinesBegun = app::now();
    m_shaders.add(ao::shaders());
    m_shaders.add(render::shaders());
    const char* named = std::getenv("OBSCURA_SHADERS");
    const fs::path sources = named && *named ? fs::path(named) : fs::path(OBSCURA_SOURCE_DIR) / "shaders";
    if (fs::is_directory(sources, ignored)) {
        m_shaders.watch(sources, gpu::compileShader);
        m_reloads = true;
    }
    m_renderer = render::Renderer::create(*m_device, m_shaders);
    if (!m_renderer) expect(gpu::Status::shaderError, "making the renderer");
    m_graph = std::make_unique<graph::Graph>(*m_device);
    m_frames = std::make_unique<app::Frames>(*m_device);
    if (!m_frames->good()) expect(gpu::Status::outOfMemory, "making the frames in flight");
    m_capture = std::make_unique<app::Capture>(*m_device);
    started.pipelines = (app::now() - pipelinesBegun) * 1e-3;
}

Engine::~Engine() {
    if (m_frames) m_frames->wait();
    if (m_device) m_device->waitIdle();
}

void Engine::expect(gpu::Status status, const char* doing) const {
    if (status == gpu::Status::ok) return;
    const std::string last = m_messages.empty() ? "" : ": " + m_messages.back();
    const char* advice = status == gpu::Status::outOfMemory  ? "; try a smaller --size"
                         : status == gpu::Status::deviceLost ? "; try again, or another --device"
                                                             : "";
    throw Complaint(fmt::format("{}: {} while {}{}{}", m_device->caps().deviceName, gpu::name(status), doing, last, advice), app::kFailed);
}

void Engine::frameOnce(const Options& options, Stage& stage, const ao::Values& values, const ao::Values* compare, render::View view) {
    expect(m_frames->begin(*m_graph), "warming up");
    render::FrameOptions frame;
    frame.visible = {warmUpSide(options.size.width), warmUpSide(options.size.height)};
    frame.guard = options.guard;
    frame.camera = stage.startCamera();
    frame.method = &values;
    frame.falloff = options.choice.falloff;
    frame.compare = compare;
    frame.view = view;
    frame.cut = true;
    frame.voxels = options.voxels;
    const render::Outputs outputs = m_renderer->add(*m_graph, stage.world, frame);
    m_graph->output(outputs.color);
    expect(m_frames->end(*m_graph), "warming up");
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
            if (!m_renderer->library().prepare(*methods[i]) && methods[i] == &options.choice.info())
                expect(gpu::Status::shaderError, "making the method's pipelines");
        }
    }
    if (options.compare && !m_renderer->otherLibrary().prepare(options.compare->info()))
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
    expect(m_frames->wait(), "warming up");
    started.warmUp = (app::now() - begun) * 1e-3;
}

}  // namespace obscura::game
