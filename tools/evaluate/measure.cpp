#include "measure.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "app/complaint.h"
#include "app/progress.h"
#include "app/statistics.h"

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
    const bool gathers = (candidate.info().needs & ao::kMotion) || (candidate.info().needs && candidate.values["temporal"] > 0.0f);
    const uint32_t warmUp = gathers ? std::max(options.warmUp, kGathered) : options.warmUp;
    Machine::Ran ran = machine.run(warmUp, options.frames, [&](graph::Graph& graph, uint32_t index) {
        return std::vector{shot.add(graph, candidate, options.falloffs[falloffIndex].falloff, index)};
    });
    Drawn drawn{candidateIndex, falloffIndex, planeOf(ran.images[0], shot.frame.visible(), candidate.label()), {}, 0.0};
    for (graph::PassTime& pass : ran.passes)
        if (std::find(shot.framePasses.begin(), shot.framePasses.end(), pass.name) == shot.framePasses.end()) drawn.passes.push_back(std::move(pass));
    return drawn;
}

// The list is run round by round; the times that count are medians over the rounds.
std::vector<Drawn> drawAll(Machine& machine, Shot& shot, const Options& options) {
    const size_t perFalloff = options.candidates.size(), count = perFalloff * options.falloffs.size();
    app::Progress progress("running methods on " + shot.scene, count * options.rounds);
    std::vector<Drawn> all;
    std::vector<std::vector<std::vector<double>>> times(count);  // of each drawing, pass and round
    for (uint32_t round = 0; round < options.rounds; ++round)
        for (size_t i = 0; i < count; ++i) {
            progress.at(round * count + i, options.candidates[i % perFalloff].label());
            Drawn drawn = draw(machine, shot, options, i % perFalloff, i / perFalloff);
            times[i].resize(drawn.passes.size());
            for (size_t p = 0; p < drawn.passes.size(); ++p) times[i][p].push_back(drawn.passes[p].milliseconds);
            if (round == 0) all.push_back(std::move(drawn));
        }
    for (size_t i = 0; i < count; ++i)
        for (size_t p = 0; p < all[i].passes.size(); ++p) {
            all[i].passes[p].milliseconds = app::percentile(times[i][p], 0.5);
            all[i].milliseconds += all[i].passes[p].milliseconds;
        }
    return all;
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
    result.drawn = drawAll(machine, shot, options);
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
