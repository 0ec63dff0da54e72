// Measures: descriptions of frames, CSV and text tables.
#include <fmt/format.h>

#include "ao/settings_text.h"
#include "choice.h"
#include "measures.h"

namespace obscura::game {

Measures::Frame measuredFrame(const render::FrameOptions& frame, const scene::World& world, uint64_t number) {
    Measures::Frame measured{.number = number, .camera = frame.camera, .visible = frame.visible, .step = frame.sampleStep};
    measured.time = frame.time;
    measured.cut = frame.cut;
    measured.animated = world.duration() > 0.0f;
    measured.instances = world.instances().size();
    measured.sides.push_back(*frame.method);
    if (frame.compare) measured.sides.push_back(*frame.compare);
    measured.falloff = ao::falloffText(frame.falloff);
    truth::WorldGeometry geometry;
    geometry.skipMasked = frame.skipMasked;
    const glm::uvec2 size(frame.visible.width / frame.sampleStep, frame.visible.height / frame.sampleStep);
    // References exist only for steps that divide both sides.
    if (size * frame.sampleStep == glm::uvec2(frame.visible.width, frame.visible.height))
        measured.viewKey = truth::viewKey(world, frame.time, frame.camera, size, geometry, truth::rayFalloff(frame.falloff));
    return measured;
}

gpu::Status readInto(const std::shared_ptr<Measures>& measures, app::Capture& capture, graph::Graph& graph, const render::Outputs& outputs,
    Measures::Frame frame) {
    if (!outputs.samples) return gpu::Status::ok;
    return capture.addRaw(
        graph, outputs.samples, [weak = std::weak_ptr(measures), frame = std::move(frame)](std::span<const std::byte> texels) {
            if (const auto target = weak.lock()) target->add(frame, texels);
        });
}

std::string csv(const std::vector<Measures::Reading>& readings) {
    std::string text = "frame,time,side,share,D_A,bias,eA,e5,excess,F_e,noise,noise_p99\n";
    const auto number = [](const auto& value) { return value ? fmt::format("{:.6f}", *value) : std::string(); };
    for (const Measures::Reading& reading : readings)
        for (size_t i = 0; i < reading.sides.size(); ++i) {
            const Measures::Side& side = reading.sides[i];
            text += fmt::format("{},{:.6f},{},{:.6f},{},", reading.number, reading.time, i ? "B" : "A", reading.share, number(side.change));
            text += side.errors ? fmt::format("{:.6f},{:.6f},{:.6f},", side.errors->bias, side.errors->eA, side.errors->e5) : ",,,";
            text += fmt::format("{},{},", number(side.excess), number(side.flickerOfError));
            text += side.noise ? fmt::format("{:.6f},{:.6f}\n", side.noise->mean, side.noise->p99) : ",\n";
        }
    return text;
}

std::string summary(const std::vector<Measures::Reading>& readings) {
    if (readings.empty()) return "measures: none\n";
    const Measures::Reading& last = readings.back();
    if (!last.problem.empty()) return fmt::format("measures: {}\n", last.problem);
    size_t referenced = 0;
    for (const Measures::Reading& reading : readings) referenced += reading.rays > 0.0f;
    std::string text = fmt::format("measures of {} x {} pixels, step {} px; {} of {} frames have a reference\n", last.size.x, last.size.y,
        last.step, referenced, readings.size());
    text += fmt::format("{:<4} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "side", "D_A", "noise", "noise P99", "bias", "eA",
        "e<5%", "excess", "F_e");
    for (size_t i = 0; i < last.sides.size(); ++i) {
        const auto mean = [&](auto of) {
            double sum = 0.0;
            size_t known = 0;
            for (const Measures::Reading& reading : readings)
                if (i < reading.sides.size())
                    if (const std::optional<float> value = of(reading.sides[i])) sum += double(*value), ++known;
            return known ? fmt::format("{:.4f}", sum / double(known)) : std::string("-");
        };
        const auto error = [&](float truth::Errors::* of) {
            return mean([of](const Measures::Side& s) { return s.errors ? std::optional<float>((*s.errors).*of) : std::nullopt; });
        };
        const auto& noise = last.sides[i].noise;
        text += fmt::format("{:<4} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", i ? "B" : "A",
            mean([](const Measures::Side& s) { return s.change; }), noise ? fmt::format("{:.4f}", noise->mean) : "-",
            noise ? fmt::format("{:.4f}", noise->p99) : "-", error(&truth::Errors::bias), error(&truth::Errors::eA),
            error(&truth::Errors::e5), mean([](const Measures::Side& s) { return s.excess; }),
            mean([](const Measures::Side& s) { return s.flickerOfError; }));
    }
    return text;
}

}  // namespace obscura::game
