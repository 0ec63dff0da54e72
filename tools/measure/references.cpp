#include "measure/references.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/progress.h"
#include "scene/json_text.h"

namespace obscura::measure {

using app::Complaint;

namespace {

template <class OptionsOf>
void setRays(OptionsOf& out, const RayChoice& rays) {
    out.maxRays = rays.rays;
    out.minRays = std::min(out.minRays, rays.rays);
    if (rays.targetError <= 0.0f) out.minRays = rays.rays;
    out.targetError = rays.targetError;
    out.seed = rays.seed;
    out.stride = rays.every;
}

truth::Plane open(const truth::Plane& obscurance) {
    truth::Plane visibility = obscurance;
    for (float& value : visibility.values) value = 1.0f - value;
    return visibility;
}

float mean(const truth::Plane& plane) {
    double sum = 0.0;
    size_t count = 0;
    for (const float value : plane.values)
        if (value > 0.0f) sum += value, ++count;
    return count ? float(sum / double(count)) : 0.0f;
}

void append(References& all, const std::string& kind, const truth::Reference& made, const std::vector<FalloffChoice>& falloffs) {
    for (size_t i = 0; i < falloffs.size(); ++i)
        all.list.push_back({kind, falloffs[i].text, kind + "." + falloffs[i].fileName(), open(made.channels[i].obscurance),
            made.meanError(i), mean(made.rays), made.channels[i].bent});
    all.fromCache = all.fromCache && made.fromCache;
}

// Progress bar of tracing.
class Bar {
public:
    explicit Bar(const std::string& what) : m_progress(what, 100) {}
    std::function<bool(float)> callback() {
        return [this](float share) {
            m_progress.at(size_t(share * 100.0f));
            return true;
        };
    }

private:
    app::Progress m_progress;
};

std::string channelOf(const Measurement& what, const FalloffChoice& falloff, const truth::Picture* picture) {
    if (!what.reference.channel.empty()) return what.reference.channel;
    const std::string world = "world." + falloff.fileName();
    return picture && !picture->find(world) && picture->find("screen." + falloff.fileName()) ? "screen." + falloff.fileName() : world;
}

void readStored(References& all, const Shot& shot, const Measurement& what) {
    const std::string file = what.reference.file.string();
    const truth::Picture picture = truth::readExr(what.reference.file);
    const glm::uvec2 visible = shot.frame.visible();
    if (picture.width != visible.x || picture.height != visible.y)
        throw Complaint(fmt::format(
            "{}: is {} x {} pixels, but the frame's visible part is {} x {}", file, picture.width, picture.height, visible.x, visible.y));
    for (const FalloffChoice& falloff : what.falloffs) {
        const std::string channel = channelOf(what, falloff, &picture);
        truth::Plane obscurance = picture.plane(channel);
        for (size_t i = 0; i < obscurance.values.size(); ++i)
            if (const float a = obscurance.values[i]; !(a >= -0.001f && a <= 1.001f))
                throw Complaint(fmt::format(
                    "{}: {} is {} at pixel ({}, {}); obscurance must be in [0, 1]", file, channel, a, i % visible.x, i / visible.x));
        all.list.push_back({scene::utf8(what.reference.file.filename().string()) + ":" + channel, falloff.text, channel, open(obscurance),
            0.0f, 0.0f, {}});
    }
}

truth::Reference traceWorld(
    const Shot& shot, const Measurement& what, const std::vector<truth::RayFalloff>& falloffs, truth::ReferenceCache& cache) {
    const std::vector<scene::PosedPrimitive> primitives = scene::pose(*shot.world, shot.time);
    truth::WorldGeometry geometry;
    geometry.skipMasked = shot.skipMasked;
    truth::WorldOptions rays;
    setRays(rays, what.rays);
    rays.bentNormals = what.rays.bentNormals;
    return cache.get(truth::worldKey(primitives, geometry, shot.frame, falloffs, rays), [&] {
        Bar bar("tracing the world reference of " + shot.scene);
        rays.progress = bar.callback();
        return truth::WorldReference(primitives, geometry).trace(shot.frame, falloffs, rays);
    });
}

truth::Reference traceScreen(Machine& machine, const Shot& shot, const Measurement& what, const std::vector<truth::RayFalloff>& falloffs,
    truth::ReferenceCache& cache) {
    truth::ScreenOptions rays;
    setRays(rays, what.rays);
    return cache.get(truth::screenKey(shot.frame, falloffs, rays), [&] {
        Bar bar("tracing the screen reference of " + shot.scene);
        rays.progress = bar.callback();
        return machine.screen().trace(shot.frame, falloffs, rays);
    });
}

}  // namespace

void expectReferenceFile(const Measurement& what) {
    if (what.reference.file.empty()) return;
    const truth::Picture picture = truth::readExr(what.reference.file);
    for (const FalloffChoice& falloff : what.falloffs) {
        const std::string channel = channelOf(what, falloff, &picture);
        if (picture.find(channel)) continue;
        std::vector<std::string> names;
        for (const truth::Picture::Channel& known : picture.channels) names.push_back(known.name);
        throw Complaint(fmt::format("{}: no channel {} for {}; {} (--channel names one)", what.reference.file.string(), channel,
            falloff.text, app::choices(channel, names)));
    }
}

References referencesOf(Machine& machine, const Shot& shot, const Measurement& what) {
    References all;
    all.fromCache = what.reference.world || what.reference.screen;
    const double begun = app::now();
    std::vector<truth::RayFalloff> falloffs;
    for (const FalloffChoice& falloff : what.falloffs) falloffs.push_back(truth::rayFalloff(falloff.falloff));
    truth::ReferenceCache cache(what.rays.cache ? scene::cacheFolder() : std::filesystem::path(),
        [&](const std::string& line) { all.remarks.push_back(app::oneLine(line)); });
    if (what.reference.world) append(all, "world", traceWorld(shot, what, falloffs, cache), what.falloffs);
    if (what.reference.screen) append(all, "screen", traceScreen(machine, shot, what, falloffs, cache), what.falloffs);
    if (!what.reference.file.empty()) readStored(all, shot, what);
    all.seconds = (app::now() - begun) * 1e-3;
    return all;
}

}  // namespace obscura::measure
