#include "app/graphics.h"

#include <cstdio>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "app/window.h"

namespace obscura::app {

namespace fs = std::filesystem;

fs::path Graphics::pipelineCacheFile() {
    const fs::path folder = cacheFolder();
    return folder.empty() ? fs::path() : folder / "pipelines.bin";
}

Graphics::Graphics(const Choice& choice) {
    std::error_code ignored;
    m_pipelineCacheFound = !choice.pipelineCache.empty() && fs::is_regular_file(choice.pipelineCache, ignored);
    gpu::DeviceOptions wanted;
    wanted.name = choice.device;
    wanted.validation = choice.validation != "off";
    wanted.synchronization = choice.validation == "sync";
    wanted.pipelineCacheFile = choice.pipelineCache.string();
    if (choice.window) {
        wanted.instanceExtensions = choice.window->instanceExtensions();
        wanted.presentation = true;
    }
    wanted.log = [this, verbose = choice.verbose, program = choice.program](gpu::Severity severity, const char* message) {
        const std::string line = oneLine(message);
        if (severity != gpu::Severity::info) m_messages.push_back(line);
        // Not printed by default: a failure is one line, which ends with the last of these messages.
        if (verbose || line.starts_with("validation")) std::fprintf(stderr, "%s: %s\n", program, line.c_str());
    };
    std::string error;
    m_device = gpu::Device::create(wanted, error);
    if (!m_device) throw Complaint(fmt::format("no device: {}", oneLine(error)), choice.device.empty() ? kFailed : kBadInput);
    m_shaders.add(ao::shaders());
    m_shaders.add(render::shaders());
    m_graph = std::make_unique<graph::Graph>(*m_device);
    m_frames = std::make_unique<Frames>(*m_device);
    if (!m_frames->valid()) expect(gpu::Status::outOfMemory, "making the frames in flight");
}

Graphics::~Graphics() { waitIdle(); }

void Graphics::waitIdle() {
    if (m_frames) m_frames->wait();
    if (m_device) m_device->waitIdle();
}

void Graphics::expect(gpu::Status status, const char* doing) const {
    if (status == gpu::Status::ok) return;
    const char* advice = status == gpu::Status::outOfMemory  ? "; try a smaller --size"
                         : status == gpu::Status::deviceLost ? "; try again, or another --device"
                                                             : "";
    throw Complaint(fmt::format("{}: {} while {}{}{}", deviceName(), gpu::name(status), doing, lastMessage(), advice), kFailed);
}

std::unique_ptr<render::Renderer> Graphics::makeRenderer() {
    auto renderer = render::Renderer::create(*m_device, m_shaders);
    if (!renderer) expect(gpu::Status::shaderError, "making the renderer");
    return renderer;
}

}  // namespace obscura::app
