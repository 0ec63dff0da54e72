#include "measure/machine.h"

#include <fmt/format.h>

#include "app/capture.h"
#include "app/complaint.h"
#include "app/statistics.h"

namespace obscura::measure {

namespace {

app::Graphics::Choice graphicsOf(const Machine::Choice& choice) {
    return {choice.device, choice.validation, choice.verbose, "obscura-evaluate", app::Graphics::pipelineCacheFile()};
}

}  // namespace

Machine::Machine(const Choice& choice) : Graphics(graphicsOf(choice)) { shaders().add(truth::shaders()); }

Machine::~Machine() { waitIdle(); }

render::Renderer& Machine::newRenderer() {
    expect(frames().wait(), "waiting for the last scene");
    m_renderer.reset();
    device().waitIdle();
    m_renderer = makeRenderer();
    return *m_renderer;
}

ao::Library& Machine::library() {
    if (!m_library) m_library = std::make_unique<ao::Library>(device(), shaders());
    return *m_library;
}

truth::ScreenReference& Machine::screen() {
    if (!m_screen) m_screen = std::make_unique<truth::ScreenReference>(device(), shaders());
    return *m_screen;
}

void Machine::expectMethod(ao::Library& library, const ao::MethodInfo& info, ao::FalloffKind falloff) {
    if (!library.prepare(info, falloff)) expect(gpu::Status::shaderError, (std::string("making the pipelines of ") + info.id).c_str());
}

Machine::Ran Machine::run(uint32_t warmUp, uint32_t timed, const Declare& declare) {
    const uint32_t last = warmUp + timed - 1;
    app::Capture capture(device());
    app::Statistics statistics(timed);
    uint64_t firstTimed = 0;
    Ran ran;
    const app::Capture::Raw keep = [&ran](std::span<const std::byte> bytes) { ran.images.emplace_back(bytes.begin(), bytes.end()); };
    // A frame's times are read when its slot is used again, so two frames follow the timed ones.
    for (uint32_t i = 0; i <= last + device().framesInFlight(); ++i) {
        expect(frames().begin(graph()), "starting a frame");
        if (i == warmUp) firstTimed = device().frame();
        const graph::Timings& timings = graph().timings();
        if (firstTimed && timings.frame >= firstTimed && timings.frame < firstTimed + timed) {
            statistics.add(timings);
            if (ran.frames.empty() || ran.frames.back().frame != timings.frame) ran.frames.push_back(timings);
        }
        if (i > last) {
            expect(frames().end(graph()), "waiting for times");
            continue;
        }
        const std::vector<graph::ImageId> images = declare(graph(), i);
        for (const graph::ImageId image : images) {
            if (!image) throw app::Complaint(fmt::format("nothing was drawn{}", lastMessage()), app::kFailed);
            if (i == last) expect(capture.addRaw(graph(), image, keep), "reading an image back");
            else graph().output(image);
        }
        expect(frames().end(graph()), "drawing");
        if (i == last) ran.bytes = frames().executor().frameBytes();
    }
    expect(frames().wait(), "drawing");

    capture.collect(true);
    for (const app::Series& series : statistics.passes())
        if (series.name != app::Capture::kPass) ran.passes.push_back({series.name, series.median()});
    for (graph::Timings& frame : ran.frames)
        std::erase_if(frame.passes, [](const gpu::PassTime& pass) { return pass.name == app::Capture::kPass; });
    return ran;
}

}  // namespace obscura::measure
