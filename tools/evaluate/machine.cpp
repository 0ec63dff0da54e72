#include "machine.h"

#include <cstdio>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "app/statistics.h"

namespace obscura::evaluate {

using app::Complaint;

namespace {

constexpr const char* kReadBack = "evaluate.read";

gpu::Status readBack(gpu::Device& device, graph::Graph& graph, graph::ImageId image, gpu::Buffer& buffer) {
    const gpu::ImageDesc desc = graph.desc(image);
    const uint64_t bytes = uint64_t(desc.width) * desc.height * gpu::bytesPerTexel(desc.format);
    const gpu::Status status =
        gpu::Buffer::create(device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback, kReadBack, buffer);
    if (status != gpu::Status::ok) return status;
    const VkBuffer target = buffer.handle();
    graph.pass(kReadBack)
        .use(image, graph::Access::transferRead)
        .use(graph.import(kReadBack, buffer, graph::Graph::Shared::written), graph::Access::transferWrite)
        .keep()
        .record([=](const graph::PassContext& context) {
            const VkBufferImageCopy region{
                .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, .imageExtent = {desc.width, desc.height, 1}};
            const gpu::Api& vk = context.device.vk();
            vk.CmdCopyImageToBuffer(context.cmd, context.image(image), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target, 1, &region);
            // The fence alone does not make device writes visible to the host.
            const VkMemoryBarrier2 toHost{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                .srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
            const VkDependencyInfo dependency{
                .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &toHost};
            vk.CmdPipelineBarrier2(context.cmd, &dependency);
        });
    return gpu::Status::ok;
}

}  // namespace

Machine::Machine(const Choice& choice) {
    gpu::DeviceOptions wanted;
    wanted.name = choice.device;
    wanted.validation = choice.validation != "off";
    wanted.synchronization = choice.validation == "sync";
    wanted.log = [this, verbose = choice.verbose](gpu::Severity severity, const char* message) {
        const std::string line = app::oneLine(message);
        if (severity != gpu::Severity::info) m_messages.push_back(line);
        // Not printed by default: a failure is one line, which ends with the last of these messages.
        if (verbose || line.starts_with("validation")) std::fprintf(stderr, "obscura-evaluate: %s\n", line.c_str());
    };
    if (const auto cache = app::cacheFolder(); !cache.empty()) wanted.pipelineCacheFile = (cache / "pipelines.bin").string();
    std::string error;
    m_device = gpu::Device::create(wanted, error);
    if (!m_device)
        throw Complaint(fmt::format("no device: {}", app::oneLine(error)), choice.device.empty() ? app::kFailed : app::kBadInput);
    m_shaders.add(ao::shaders());
    m_shaders.add(render::shaders());
    m_shaders.add(truth::shaders());
    m_graph = std::make_unique<graph::Graph>(*m_device);
    m_frames = std::make_unique<app::Frames>(*m_device);
    if (!m_frames->good()) expect(gpu::Status::outOfMemory, "making the frames in flight");
}

Machine::~Machine() {
    if (m_frames) m_frames->wait();
    if (m_device) m_device->waitIdle();
}

void Machine::expect(gpu::Status status, const char* doing) const {
    if (status == gpu::Status::ok) return;
    const char* advice = status == gpu::Status::outOfMemory ? "; try a smaller --size" : "";
    throw Complaint(fmt::format("{}: {} while {}{}{}", deviceName(), gpu::name(status), doing,
                        m_messages.empty() ? "" : ": " + m_messages.back(), advice),
        app::kFailed);
}

render::Renderer& Machine::newRenderer() {
    expect(m_frames->wait(), "waiting for the last scene");
    m_renderer.reset();
    m_device->waitIdle();
    m_renderer = makeRenderer();
    return *m_renderer;
}

std::unique_ptr<render::Renderer> Machine::makeRenderer() {
    auto renderer = render::Renderer::create(*m_device, m_shaders);
    if (!renderer) expect(gpu::Status::shaderError, "making the renderer");
    return renderer;
}

ao::Library& Machine::library() {
    if (!m_library) m_library = std::make_unique<ao::Library>(*m_device, m_shaders);
    return *m_library;
}

truth::ScreenReference& Machine::screen() {
    if (!m_screen) m_screen = std::make_unique<truth::ScreenReference>(*m_device, m_shaders);
    return *m_screen;
}

void Machine::expectMethod(ao::Library& library, const ao::MethodInfo& info) {
    if (!library.prepare(info)) expect(gpu::Status::shaderError, (std::string("making the pipelines of ") + info.id).c_str());
}

Machine::Ran Machine::run(uint32_t warmUp, uint32_t timed, const Declare& declare) {
    const uint32_t last = warmUp + timed - 1;
    std::vector<gpu::Buffer> buffers;
    app::Statistics statistics(timed);
    uint64_t firstTimed = 0;
    Ran ran;
    // A frame's times are read when its slot is used again, so two frames follow the timed ones.
    for (uint32_t i = 0; i <= last + m_device->framesInFlight(); ++i) {
        expect(m_frames->begin(*m_graph), "starting a frame");
        if (i == warmUp) firstTimed = m_device->frame();
        const graph::Timings& timings = m_graph->timings();
        if (firstTimed && timings.frame >= firstTimed && timings.frame < firstTimed + timed) {
            statistics.add(timings);
            if (ran.frames.empty() || ran.frames.back().frame != timings.frame) ran.frames.push_back(timings);
        }
        if (i > last) {
            expect(m_frames->end(*m_graph), "waiting for times");
            continue;
        }
        const std::vector<graph::ImageId> images = declare(*m_graph, i);
        if (i == last) buffers.resize(images.size());
        for (size_t k = 0; k < images.size(); ++k) {
            if (!images[k])
                throw Complaint(fmt::format("nothing was drawn{}", m_messages.empty() ? "" : ": " + m_messages.back()), app::kFailed);
            if (i == last) expect(readBack(*m_device, *m_graph, images[k], buffers[k]), "reading an image back");
            else m_graph->output(images[k]);
        }
        expect(m_frames->end(*m_graph), "drawing");
        if (i == last) ran.bytes = m_frames->executor().frameBytes();
    }
    expect(m_frames->wait(), "drawing");

    for (const gpu::Buffer& buffer : buffers) ran.images.emplace_back(buffer.mapped(), buffer.mapped() + buffer.bytes());
    for (const app::Series& series : statistics.passes())
        if (series.name != kReadBack) ran.passes.push_back({series.name, series.median()});
    for (graph::Timings& frame : ran.frames)
        std::erase_if(frame.passes, [](const graph::PassTime& pass) { return pass.name == kReadBack; });
    return ran;
}

}  // namespace obscura::evaluate
