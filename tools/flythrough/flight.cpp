#include "flight.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "app/complaint.h"
#include "app/files.h"
#include "app/progress.h"
#include "app/statistics.h"
#include "measure/draw.h"
#include "measure/false_colour.h"
#include "scene/hash.h"
#include "truth/cache.h"
#include "truth/world_reference.h"

namespace obscura::flythrough {

using app::Complaint;

namespace {

constexpr uint32_t kMeasure = 3;  // version of the measurement; chunks of other versions are measured again
constexpr uint32_t kStillWarmUp = 32, kStillFrames = 32;

// A method uses shaders of its own folder and shared ones.
bool mayRun(const measure::Candidate& candidate, std::string_view shader) {
    if (shader == "ao/common/temporal.comp") return hasHistory(candidate);
    return shader.starts_with("ao/common/") || shader.starts_with(fmt::format("ao/{}/", candidate.info().id)) ||
           (shader.starts_with("ao/offscreen/") && candidate.values.has("offscreen") && candidate.values["offscreen"] > 0.0f);
}

std::filesystem::path pictureFile(const std::filesystem::path& folder, uint32_t frame) { return folder / fmt::format("{:04}.png", frame); }

}  // namespace

bool hasHistory(const measure::Candidate& candidate) { return candidate.values.has("temporal") && candidate.values["temporal"] > 0.0f; }
const ao::Preset& ownFilter(const measure::Candidate& candidate) {
    return *ao::findResolvePreset(hasHistory(candidate) ? "temporal" : "spatial");
}

measure::Candidate filtered(const measure::Candidate& candidate, const ao::Preset& filter) {
    measure::Candidate result = candidate;
    result.values.resolve(filter);
    const bool asked = hasHistory(candidate) || std::any_of(candidate.settings.begin(), candidate.settings.end(),
                                                    [](const std::string& s) { return s.starts_with("temporal="); });
    if (asked && hasHistory(result)) result.values.set("temporal", candidate.values["temporal"]);
    return result;
}

Flight::Flight(measure::Machine& machine, const Script& script, const Settings& settings)
    : m_machine(machine),
      m_settings(settings),
      m_stage(script),
      m_falloff(settings.falloff ? *settings.falloff : measure::falloffs({script.falloff})[0]) {
    for (const Event& event : script.events)
        if (event.frame > 0 && event.frame >= settings.first && event.frame < settings.end &&
            (m_events.empty() || m_events.back() != event.frame))
            m_events.push_back(event.frame);
    m_renderer = machine.makeRenderer();
    if (m_renderer->load(m_stage.worldAt(0)) != gpu::Status::ok)
        throw Complaint(fmt::format("{}: cannot be uploaded to {}", script.scene, machine.deviceName()), app::kFailed);
    draw();
    trace();
}

render::FrameOptions Flight::options(uint32_t frame) const {
    render::FrameOptions options;
    options.visible = {m_settings.size.x, m_settings.size.y};
    options.guard = m_settings.guard;
    options.camera = m_stage.cameraAt(frame);
    options.time = m_stage.worldTimeAt(frame);
    options.falloff = m_falloff.falloff;
    options.view = render::View::visibility;
    return options;
}

uint32_t Flight::endOfState(uint32_t frame) const {
    for (const Event& event : m_stage.script().events)
        if (event.frame > frame) return std::min(event.frame, m_settings.length);
    return m_settings.length;
}

void Flight::draw() {
    const ao::Values none(*ao::methods()[0]);
    uint32_t end = m_settings.end;
    for (const uint32_t event : m_events) end = std::max(end, endOfState(event));
    app::Progress progress("drawing " + m_stage.script().name, end);
    for (uint32_t frame = 0; frame < end; ++frame) {
        progress.at(frame);
        glm::uvec2 size(0);
        const measure::Machine::Ran ran = m_machine.run(0, 1, [&](graph::Graph& graph, uint32_t) {
            render::FrameOptions wanted = options(frame);
            wanted.method = &none;
            wanted.cut = frame == 0;
            const render::Outputs outputs = m_renderer->add(graph, m_stage.worldAt(frame), wanted);
            size = {graph.desc(outputs.linearDepth).width, graph.desc(outputs.linearDepth).height};
            return std::vector{outputs.linearDepth, outputs.normals, outputs.motion};
        });
        Geometry geometry{measure::capturedFrame(m_settings.size, m_stage.cameraAt(frame), size, ran.images[0], ran.images[1]), {}, {}};
        const truth::CapturedFrame& captured = geometry.frame;
        std::vector<uint32_t> halves(captured.depth.size());
        std::memcpy(halves.data(), ran.images[2].data(), ran.images[2].size());
        for (const uint32_t both : halves) geometry.motion.push_back(glm::unpackHalf2x16(both));
        captured.check(fmt::format("{} frame {}", m_stage.script().name, frame));
        geometry.visible = captured.visibleMask();
        m_geometry.push_back(std::move(geometry));
        if (frame == 0)
            for (const gpu::PassTime& pass : ran.passes)
                if (!pass.name.starts_with("prepare.")) m_framePasses.push_back(pass.name);
    }
}

void Flight::trace() {
    truth::ReferenceCache cache(m_settings.cache ? scene::cacheFolder() : std::filesystem::path());
    const std::vector<truth::RayFalloff> falloffs{truth::rayFalloff(m_falloff.falloff)};
    truth::WorldOptions rays;
    rays.minRays = rays.maxRays = m_settings.rays;
    rays.targetError = 0.0f;
    rays.seed = m_settings.seed;
    const uint32_t begin = m_settings.first ? m_settings.first - 1 : 0;
    m_references.resize(m_settings.end);
    app::Progress progress("tracing " + m_stage.script().name, m_settings.end - begin);
    for (uint32_t frame = begin; frame < m_settings.end; ++frame) {
        progress.at(frame - begin);
        const std::vector<scene::PosedPrimitive> primitives = scene::pose(m_stage.worldAt(frame), m_stage.worldTimeAt(frame));
        const std::string key = truth::worldKey(primitives, {}, m_geometry[frame].frame, falloffs, rays);
        const truth::Reference reference =
            cache.get(key, [&] { return truth::WorldReference(primitives).trace(m_geometry[frame].frame, falloffs, rays); });
        // The game looks references up by this key, which it knows before drawing.
        cache.note(
            truth::viewKey(m_stage.worldAt(frame), m_stage.worldTimeAt(frame), m_stage.cameraAt(frame), m_settings.size, {}, falloffs[0]),
            key);
        m_references[frame] = {reference.channels[0].obscurance, reference.channels[0].error};
        for (float& v : m_references[frame].visibility.values) v = 1.0f - v;
    }
}

std::string Flight::keyOf(const measure::Candidate& candidate, const ao::Preset& filter) const {
    scene::Hash hash;
    const Script& script = m_stage.script();
    hash.add(kMeasure)
        .add(script.name)
        .add(script.scene)
        .add(m_falloff.text)
        .add(m_settings.size.x)
        .add(m_settings.size.y)
        .add(m_settings.guard);
    hash.add(m_settings.length)
        .add(m_settings.rays)
        .add(m_settings.seed)
        .add(int(m_settings.still))
        .add(std::string(candidate.info().id))
        .add(std::string(filter.id));
    const measure::Candidate used = filtered(candidate, filter);
    for (const float value : used.values.values()) hash.add(value);
    for (const std::string& setting : candidate.settings)
        if (setting.starts_with("voxel")) hash.add(setting);
    for (uint32_t frame = 0; frame < m_settings.length; ++frame) {
        const scene::Camera camera = m_stage.cameraAt(frame);
        for (const glm::vec3& v : {camera.eye, camera.target, camera.up}) hash.add(v.x).add(v.y).add(v.z);
        hash.add(camera.fovY).add(camera.nearPlane).add(camera.farPlane).add(camera.orthoHalfHeight).add(m_stage.worldTimeAt(frame));
    }
    for (const Event& event : script.events)
        hash.add(event.frame).add(event.box).add(&event.size, sizeof(event.size)).add(&event.at, sizeof(event.at)).add(int(event.gone));
    hash.add(m_stage.sceneHash()).add(script.animation);
    for (const gpu::EmbeddedShader& shader : ao::shaders())  // identify the method
        if (mayRun(used, shader.name)) hash.add(shader.spirv.data(), shader.spirv.size_bytes());
    return hash.hex();
}

Chunk Flight::empty(const measure::Candidate& candidate, const ao::Preset& filter) const {
    Chunk chunk;
    chunk.flythrough = m_stage.script().name;
    chunk.method = candidate.info().id;
    chunk.preset = candidate.preset;
    for (const std::string& setting : candidate.settings) chunk.settings += (chunk.settings.empty() ? "" : " ") + setting;
    chunk.filter = filter.id;
    chunk.falloff = m_falloff.text;
    chunk.width = m_settings.size.x;
    chunk.height = m_settings.size.y;
    chunk.rays = m_settings.rays;
    chunk.first = m_settings.first;
    chunk.end = m_settings.end;
    chunk.key = keyOf(candidate, filter);
    return chunk;
}

Flight::Drawn Flight::draw(const measure::Candidate& candidate, uint32_t frame, bool cut) {
    measure::Machine::Ran ran = m_machine.run(0, 1, [&](graph::Graph& graph, uint32_t) {
        render::FrameOptions wanted = options(frame);
        wanted.method = &candidate.values;
        wanted.voxels = candidate.voxels.over(wanted.voxels);
        wanted.cut = cut;
        return std::vector{m_renderer->add(graph, m_stage.worldAt(frame), wanted).visibility};
    });
    Drawn drawn{measure::planeOf(
                    ran.images[0], m_settings.size, fmt::format("{}, frame {} of {}", candidate.label(), frame, m_stage.script().name)),
        {}};
    for (gpu::PassTime& pass : ran.passes)
        if (std::find(m_framePasses.begin(), m_framePasses.end(), pass.name) == m_framePasses.end())
            drawn.passes.push_back(std::move(pass));
    return drawn;
}

Chunk Flight::measure(const measure::Candidate& chosen, const ao::Preset& filter) {
    const measure::Candidate candidate = filtered(chosen, filter);
    Chunk chunk = empty(chosen, filter);
    m_machine.expectMethod(m_renderer->library(), candidate.info(), m_falloff.falloff.kind);
    const std::filesystem::path folder = m_settings.out / "frames" / chunk.name();
    if (m_settings.pictures) {
        chunk.pictures = "frames/" + chunk.name();
        app::expectFolder(folder);
    }
    std::map<std::string, app::Series> times;
    std::vector<truth::Plane> pictures;
    app::Progress progress(chunk.name(), m_geometry.size() + (m_settings.still && m_settings.first == 0 ? kStillWarmUp + kStillFrames : 0));
    for (uint32_t frame = 0; frame < m_geometry.size(); ++frame) {
        progress.at(frame);
        Drawn drawn = draw(candidate, frame, frame == 0);
        pictures.push_back(std::move(drawn.visibility));
        if (frame < m_settings.first || frame >= m_settings.end) continue;
        const truth::Plane& picture = pictures.back();
        const Geometry& geometry = m_geometry[frame];
        for (const gpu::PassTime& pass : drawn.passes) {
            times[pass.name].name = pass.name;
            times[pass.name].values.push_back(pass.milliseconds);
        }
        FrameRow row{.frame = frame, .time = m_stage.script().timeAt(frame)};
        double error = 0.0, absolute = 0.0, square = 0.0;
        size_t pixels = 0;
        for (size_t i = 0; i < geometry.visible.size(); ++i) {
            if (!geometry.visible[i]) continue;
            const double e = double(picture.values[i]) - double(m_references[frame].visibility.values[i]);
            error += e, absolute += std::fabs(e), square += e * e, ++pixels;
        }
        row.empty = pixels == 0;
        if (pixels)
            row.bias = float(error / double(pixels)), row.eA = float(absolute / double(pixels)),
            row.rmse = float(std::sqrt(square / double(pixels)));
        if (frame > 0 && pixels) {
            const truth::Correspondence way = truth::correspond(geometry.frame, m_geometry[frame - 1].frame, geometry.motion);
            const truth::Change change = truth::change(way, picture, pictures[frame - 1], m_references[frame], m_references[frame - 1]);
            row.share = way.share();
            row.difference = change.difference;
            row.referenceDifference = change.referenceDifference;
            row.flickerOfError = change.flickerOfError;
            row.referenceFlicker = change.referenceFlicker;
        }
        chunk.frames.push_back(row);
        if (m_settings.pictures) app::writePng(pictureFile(folder, frame), measure::greyPicture(picture));
    }
    for (const uint32_t event : m_events) {
        const std::span<const truth::Plane> after(pictures.begin() + event, pictures.begin() + endOfState(event));
        const truth::Lag lag = truth::lag(pictures[event - 1], after, m_references[event - 1].visibility, m_references[event].visibility,
            truth::stayed(m_geometry[event - 1].frame, m_geometry[event].frame));
        chunk.events.push_back({event, uint32_t(lag.pixels), lag.t90, lag.ghost});
    }
    if (m_settings.still && m_settings.first == 0) {
        truth::StaticNoise noise;
        for (uint32_t i = 0; i < kStillWarmUp + kStillFrames; ++i) {
            progress.at(m_geometry.size() + i);
            const Drawn drawn = draw(candidate, 0, i == 0);
            if (i >= kStillWarmUp) noise.add(drawn.visibility);
        }
        const truth::StaticNoise::Result spread = noise.over(m_geometry[0].visible);
        chunk.still = StaticRow{spread.mean, spread.p99};
    }
    for (const auto& [pass, series] : times) chunk.passes.push_back({pass, series.median(), series.p95()});
    return chunk;
}

bool Flight::showsSurface() const {
    return std::any_of(m_geometry.begin() + m_settings.first, m_geometry.begin() + m_settings.end,
        [](const Geometry& geometry) { return geometry.frame.showsSurface(); });
}

void Flight::writeReferencePictures() const {
    const std::filesystem::path folder = m_settings.out / "frames" / (m_stage.script().name + ".reference");
    app::expectFolder(folder);
    for (uint32_t frame = m_settings.first; frame < m_settings.end; ++frame)
        app::writePng(pictureFile(folder, frame), measure::greyPicture(m_references[frame].visibility));
}

}  // namespace obscura::flythrough
