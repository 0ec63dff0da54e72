// Results as JSON rows.
#include "report.h"

#include "app/statistics.h"

namespace obscura::evaluate {

namespace {

void putErrors(Json& json, const truth::Errors& errors) {
    json["eA"] = app::digits(errors.eA);
    json["e5"] = app::digits(errors.e5);
    json["bias"] = app::digits(errors.bias);
    json["rmse"] = app::digits(errors.rmse);
    json["p99"] = app::digits(errors.p99);
}

// Without a pixel there are no errors.
void putMetrics(Json& json, const truth::Metrics& metrics) {
    json["pixels"] = metrics.pixels;
    if (metrics.pixels == 0) return;
    putErrors(json, metrics.raw);
    if (metrics.perceptual) {
        json["ssim"] = app::digits(metrics.ssim);
        json["flip"] = app::digits(metrics.flipMean);
        json["flipWeightedMedian"] = app::digits(metrics.flipWeightedMedian);
    }
    json["gamma"] = app::digits(metrics.gamma);
    putErrors(json["adjusted"], metrics.adjusted);
}

}  // namespace

Json rowJson(const ShotResult& shot, const Row& row, const Options& options, const About& about) {
    const Drawn& drawn = shot.drawn[row.drawn];
    const measure::ShotReference& reference = shot.references[row.reference];
    const measure::Candidate& candidate = options.candidates[drawn.candidate];
    Json json;
    json["method"] = candidate.info().id;
    json["preset"] = candidate.preset;
    if (!candidate.settings.empty()) json["set"] = candidate.settings;
    json["falloff"] = reference.falloff;
    json["reference"] = reference.kind;
    json["scene"] = shot.scene;
    json["camera"] = shot.camera;
    json["time"] = app::digits(shot.time);
    json["size"] = {shot.size.x, shot.size.y};
    json["guard"] = {shot.guard.x, shot.guard.y};
    if (shot.every > 1) json["every"] = shot.every;
    putMetrics(json, row.whole());
    for (size_t i = 1; i < row.regions.size(); ++i)
        putMetrics(json["regions"][truth::kRegionNames[size_t(row.regions[i].region)]], row.regions[i].metrics);
    if (row.bent.pixels) {
        json["bentNormals"]["pixels"] = row.bent.pixels;
        json["bentNormals"]["degrees"] = app::digits(row.bent.degrees);
        json["bentNormals"]["normalDegrees"] = app::digits(row.bent.normalDegrees);
        json["bentNormals"]["irradianceError"] = app::digits(row.bent.irradiance);
        json["bentNormals"]["irradianceErrorBent"] = app::digits(row.bent.bentIrradiance);
        const truth::BentErrors& least = shot.bent[row.reference];
        json["bentNormals"]["reference"] = {
            {"irradianceError", app::digits(least.irradiance)}, {"irradianceErrorBent", app::digits(least.bentIrradiance)}};
    }
    json["milliseconds"]["all"] = app::digits(drawn.milliseconds);
    json["milliseconds"]["passes"] = Json::object();
    for (const gpu::PassTime& pass : drawn.passes) json["milliseconds"]["passes"][pass.name] = app::digits(pass.milliseconds);
    if (reference.rays > 0.0f) {
        json["referenceRays"] = app::digits(reference.rays);
        json["referenceError"] = app::digits(reference.error);
    }
    json["device"] = about.device;
    json["frames"] = about.frames;
    return json;
}

Json rowsJson(const std::vector<ShotResult>& shots, const Options& options, const About& about) {
    Json rows = Json::array();
    for (const ShotResult& shot : shots)
        for (const Row& row : shot.rows) rows.push_back(rowJson(shot, row, options, about));
    return rows;
}

}  // namespace obscura::evaluate
