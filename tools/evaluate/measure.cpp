#include "measure.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "app/complaint.h"
#include "app/progress.h"

namespace obscura::evaluate {

namespace {

truth::Plane planeOf(const std::vector<std::byte>& halves, glm::uvec2 size, const std::string& what) {
    truth::Plane plane(size.x, size.y);
    if (halves.size() != plane.pixels() * 2)
        throw app::Complaint(fmt::format("{}: its visibility has another size than the frame", what), app::kFailed);
    for (size_t i = 0; i < plane.pixels(); ++i) {
        uint16_t half;
        std::memcpy(&half, halves.data() + 2 * i, 2);
        plane.values[i] = glm::unpackHalf1x16(half);
        if (!std::isfinite(plane.values[i]))
            throw app::Complaint(fmt::format("{}: drew {} at pixel ({}, {})", what, plane.values[i], i % size.x, i / size.x), app::kFailed);
    }
    return plane;
}

Drawn draw(Machine& machine, Shot& shot, const Options& options, size_t candidateIndex, size_t falloffIndex) {
    const Candidate& candidate = options.candidates[candidateIndex];
    // A method that gathers over frames is judged once it has gathered.
    constexpr uint32_t kGathered = 16;
    const uint32_t warmUp = candidate.info().needs & ao::kMotion ? std::max(options.warmUp, kGathered) : options.warmUp;
    Machine::Ran ran = machine.run(warmUp, options.frames, [&](graph::Graph& graph, uint32_t index) {
        return std::vector{shot.add(graph, candidate, options.falloffs[falloffIndex].falloff, index)};
    });
    Drawn drawn{candidateIndex, falloffIndex, planeOf(ran.images[0], shot.frame.visible(), candidate.label()), {}, 0.0};
    for (graph::PassTime& pass : ran.passes) {
        if (std::find(shot.framePasses.begin(), shot.framePasses.end(), pass.name) != shot.framePasses.end()) continue;
        drawn.milliseconds += pass.milliseconds;
        drawn.passes.push_back(std::move(pass));
    }
    return drawn;
}

// The one number a gate needs, in a hundredth of the time.
std::vector<truth::RegionMetrics> meanError(const truth::Plane& visibility, const truth::Plane& reference, const truth::Mask& valid) {
    truth::Metrics metrics;
    double sum = 0.0;
    for (size_t i = 0; i < valid.size(); ++i)
        if (valid[i]) sum += std::fabs(std::clamp(visibility.values[i], 0.0f, 1.0f) - std::clamp(reference.values[i], 0.0f, 1.0f)), ++metrics.pixels;
    metrics.raw.eA = metrics.pixels ? float(sum / double(metrics.pixels)) : 0.0f;
    return {{truth::Region::whole, metrics}};
}

}  // namespace

ShotResult measure(Machine& machine, Shot& shot, const Options& options) {
    ShotResult result;
    result.scene = shot.scene;
    result.camera = shot.camera;
    result.remark = shot.remark;
    result.time = shot.time;
    result.size = shot.frame.visible();
    result.guard = shot.frame.guard;
    result.seconds.frame = shot.seconds;

    for (const Candidate& candidate : options.candidates) machine.expectMethod(*shot.library, candidate.info());
    References references = referencesOf(machine, shot, options);
    result.references = std::move(references.list);
    result.referencesFromCache = references.fromCache;
    result.seconds.references = references.seconds;
    for (const std::string& remark : references.remarks) result.remark += (result.remark.empty() ? "" : "; ") + remark;

    double begun = app::now();
    {
        app::Progress progress("running methods on " + shot.scene, options.candidates.size() * options.falloffs.size());
        for (size_t f = 0; f < options.falloffs.size(); ++f)
            for (size_t c = 0; c < options.candidates.size(); ++c) {
                progress.at(f * options.candidates.size() + c, options.candidates[c].label());
                result.drawn.push_back(draw(machine, shot, options, c, f));
            }
    }
    result.seconds.methods = (app::now() - begun) * 1e-3;

    begun = app::now();
    const truth::Regions regions = truth::regionsOf(shot.frame);
    const truth::Mask valid = shot.frame.visibleMask();
    app::Progress progress("comparing", result.references.size());
    for (size_t r = 0; r < result.references.size(); ++r) {
        progress.at(r);
        for (size_t d = 0; d < result.drawn.size(); ++d) {
            if (options.falloffs[result.drawn[d].falloff].text != result.references[r].falloff) continue;
            const truth::Plane &visibility = result.drawn[d].visibility, &reference = result.references[r].visibility;
            result.rows.push_back(
                {d, r, options.errorsOnly ? meanError(visibility, reference, valid) : truth::compare(visibility, reference, regions)});
        }
    }
    result.seconds.metrics = (app::now() - begun) * 1e-3;
    if (!options.captureOut.empty()) result.frame = std::move(shot.frame);
    return result;
}

}  // namespace obscura::evaluate
