#include "measure/draw.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "app/complaint.h"

namespace obscura::measure {

truth::Plane planeOf(const std::vector<std::byte>& halves, glm::uvec2 size, const std::string& drawn) {
    truth::Plane plane(size.x, size.y);
    if (halves.size() != plane.pixels() * 2)
        throw app::Complaint(fmt::format("{}: its visibility does not have the frame's size", drawn), app::kFailed);
    for (size_t i = 0; i < plane.pixels(); ++i) {
        uint16_t half;
        std::memcpy(&half, halves.data() + 2 * i, 2);
        plane.values[i] = glm::unpackHalf1x16(half);
        if (!std::isfinite(plane.values[i]))
            throw app::Complaint(
                fmt::format("{}: drew {} at pixel ({}, {})", drawn, plane.values[i], i % size.x, i / size.x), app::kFailed);
    }
    return plane;
}

Drawing draw(Machine& machine, Shot& shot, const Candidate& candidate, const ao::Falloff& falloff, uint32_t warmUp, uint32_t frames) {
    // A method with a history is measured after its history has converged.
    constexpr uint32_t kGathered = 16;
    const bool gathers = (candidate.info().needs & ao::kMotion) || (candidate.info().needs && candidate.values["temporal"] > 0.0f);
    const Machine::Ran ran = machine.run(gathers ? std::max(warmUp, kGathered) : warmUp, frames,
        [&](graph::Graph& graph, uint32_t index) { return shot.add(graph, candidate, falloff, index); });
    Drawing drawing{planeOf(ran.images[0], shot.frame.visible(), candidate.label()), {}, {}, {}, {}, ran.bytes};
    for (size_t i = 0; ran.images.size() > 1 && 4 * i < ran.images[1].size(); ++i) {
        const auto at = [&](size_t axis) { return float(int8_t(ran.images[1][4 * i + axis])) / 127.0f; };
        drawing.bentNormals.push_back({at(0), at(1), at(2)});
    }
    const auto drawsTheFrame = [&](const std::string& pass) {
        return std::find(shot.framePasses.begin(), shot.framePasses.end(), pass) != shot.framePasses.end();
    };
    app::Statistics statistics(frames);
    for (graph::Timings frame : ran.frames) {
        double all = 0.0, own = 0.0;
        for (const gpu::PassTime& pass : frame.passes) all += pass.milliseconds;
        std::erase_if(frame.passes, [&](const gpu::PassTime& pass) { return drawsTheFrame(pass.name); });
        for (const gpu::PassTime& pass : frame.passes) own += pass.milliseconds;
        statistics.add(frame);
        drawing.own.push_back(own);
        drawing.rest.push_back(all - own);
    }
    drawing.passes = statistics.passes();
    return drawing;
}

}  // namespace obscura::measure
