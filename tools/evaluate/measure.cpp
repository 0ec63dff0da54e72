#include "measure.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/progress.h"
#include "app/statistics.h"
#include "render/renderer.h"

namespace obscura::evaluate {

namespace {

// The list is run round by round; the times that count are medians over the rounds.
std::vector<Drawn> drawAll(measure::Machine& machine, measure::Shot& shot, const Options& options) {
    const size_t perFalloff = options.candidates.size(), count = perFalloff * options.falloffs.size();
    app::Progress progress("running methods on " + shot.scene, count * options.rounds);
    std::vector<Drawn> all;
    std::vector<std::vector<app::Series>> passes(count);  // per drawing: each pass's medians, of the rounds in which it ran
    std::vector<std::vector<double>> sums(count);
    for (uint32_t round = 0; round < options.rounds; ++round)
        for (size_t i = 0; i < count; ++i) {
            progress.at(round * count + i, options.candidates[i % perFalloff].label());
            measure::Drawing drawing = measure::draw(machine, shot, options.candidates[i % perFalloff],
                options.falloffs[i / perFalloff].falloff, options.warmUp, options.frames);
            sums[i].push_back(app::percentile(drawing.own, 0.5));
            for (const app::Series& pass : drawing.passes) app::named(passes[i], pass.name).values.push_back(pass.median());
            if (round == 0)
                all.push_back({i % perFalloff, i / perFalloff, std::move(drawing.visibility), std::move(drawing.bentNormals), {}, 0.0});
        }
    for (size_t i = 0; i < count; ++i) {
        for (const app::Series& pass : passes[i]) all[i].passes.push_back({pass.name, pass.median()});
        all[i].milliseconds = app::percentile(sums[i], 0.5);
    }
    return all;
}

// eA alone, which is all that a baseline stores; 1/100 of the time of all metrics.
std::vector<truth::RegionMetrics> meanError(const truth::Plane& visibility, const truth::Plane& reference, const truth::Mask& valid) {
    truth::Metrics metrics;
    double sum = 0.0;
    for (size_t i = 0; i < valid.size(); ++i)
        if (valid[i])
            sum += std::fabs(std::clamp(visibility.values[i], 0.0f, 1.0f) - std::clamp(reference.values[i], 0.0f, 1.0f)), ++metrics.pixels;
    metrics.raw.eA = metrics.pixels ? float(sum / double(metrics.pixels)) : 0.0f;
    return {{truth::Region::whole, metrics}};
}

// Bent normals, and the sample's ambient light with and without them. found: eye space, one per visible pixel; empty: the reference's own.
truth::BentErrors bentErrors(const truth::CapturedFrame& frame, std::vector<glm::vec3> found, const truth::Plane& visibility,
    const measure::ShotReference& reference, const truth::Mask& valid) {
    const glm::mat3 worldFromEye(frame.worldFromEye());
    const glm::uvec2 size = frame.visible();
    std::vector<glm::vec3> normals;
    for (glm::vec3& direction : found) direction = worldFromEye * direction;
    for (size_t i = 0; found.size() < valid.size(); ++i)
        found.push_back({reference.bent.mean[0].values[i], reference.bent.mean[1].values[i], reference.bent.mean[2].values[i]});
    for (uint32_t y = 0; y < size.y; ++y)
        for (uint32_t x = 0; x < size.x; ++x) {
            const glm::vec3 eye = frame.eyePosition(x + frame.guard.x, y + frame.guard.y), n = frame.normals[frame.visibleIndex(x, y)];
            const glm::vec3 towards = frame.view().orthographic > 0.5f ? glm::vec3(0, 0, 1) : -eye;
            normals.push_back(worldFromEye * (glm::dot(n, towards) < 0.0f ? -n : n));
        }
    const auto luminance = [](const glm::vec3& c) { return glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f)); };
    const render::Sun sun;
    return truth::compareBent(
        found, visibility, normals, reference.bent, reference.visibility, luminance(sun.ground) / luminance(sun.sky), valid);
}

}  // namespace

ShotResult measure(measure::Machine& machine, measure::Shot& shot, const Options& options) {
    ShotResult result;
    result.scene = shot.scene;
    result.camera = shot.camera;
    result.remark = shot.remark;
    result.time = shot.time;
    result.size = shot.frame.visible();
    result.guard = shot.frame.guard;
    result.every = options.rays.every;
    result.seconds.frame = shot.seconds;

    for (const measure::FalloffChoice& falloff : options.falloffs)
        for (const measure::Candidate& candidate : options.candidates)
            machine.expectMethod(*shot.library, candidate.info(), falloff.falloff.kind);
    measure::References references = measure::referencesOf(machine, shot, options);
    result.references = std::move(references.list);
    result.referencesFromCache = references.fromCache;
    result.seconds.references = references.seconds;
    result.bent.resize(result.references.size());
    for (const std::string& remark : references.remarks) result.remark += (result.remark.empty() ? "" : "; ") + remark;

    double begun = app::now();
    result.drawn = drawAll(machine, shot, options);
    result.seconds.methods = (app::now() - begun) * 1e-3;

    begun = app::now();
    const truth::Regions regions = truth::everyNth(truth::regionsOf(shot.frame), result.size.x, result.every);
    app::Progress progress("comparing", result.references.size());
    for (size_t r = 0; r < result.references.size(); ++r) {
        progress.at(r);
        for (size_t d = 0; d < result.drawn.size(); ++d) {
            if (options.falloffs[result.drawn[d].falloff].text != result.references[r].falloff) continue;
            const truth::Plane &visibility = result.drawn[d].visibility, &reference = result.references[r].visibility;
            result.rows.push_back({d, r,
                options.errorsOnly ? meanError(visibility, reference, regions[truth::Region::whole])
                                   : truth::compare(visibility, reference, regions),
                {}});
            if (result.drawn[d].bentNormals.empty() || !result.references[r].bent) continue;
            const truth::Mask& valid = regions[truth::Region::whole];
            result.rows.back().bent = bentErrors(shot.frame, result.drawn[d].bentNormals, visibility, result.references[r], valid);
            result.bent[r] = bentErrors(shot.frame, {}, reference, result.references[r], valid);
        }
    }
    if (result.empty()) {
        const bool sampled = shot.frame.showsSurface();
        result.remark += fmt::format("{}{}: no errors", result.remark.empty() ? "" : "; ",
            sampled ? fmt::format("--every {} meets only sky", result.every)
                    : fmt::format("no surface is nearer than {:g} m", shot.frame.skyDepth));
    }
    result.seconds.metrics = (app::now() - begun) * 1e-3;
    if (!options.captureOut.empty()) result.frame = std::move(shot.frame);
    return result;
}

}  // namespace obscura::evaluate
