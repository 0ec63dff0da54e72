// Flythroughs: a centripetal Catmull-Rom curve through the keys, with a continuous velocity.
//
// A curve through unevenly spaced points loops and overshoots unless its knots follow the distances of the points [Yuksel et al. 2011].
// Since keys also have times, a second, monotone function maps time to knots [Fritsch and Carlson 1980]. Both functions are C1, and so is
// the path in time.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include <fmt/format.h>

#include "scene/camera.h"
#include "scene/json_file.h"
#include "scene/json_text.h"

namespace obscura::scene {
namespace {

template <class T>
T hermite(const T& a, const T& ta, const T& b, const T& tb, float t, float step) {
    const float t2 = t * t, t3 = t2 * t;
    return (2.0f * t3 - 3.0f * t2 + 1.0f) * a + step * (t3 - 2.0f * t2 + t) * ta + (-2.0f * t3 + 3.0f * t2) * b + step * (t3 - t2) * tb;
}

// The keys i - 1 to i + 2 of the segment from i to i + 1; indices and times continue across the end of a loop.
struct Around {
    size_t key[4];
    float time[4];
};

// Slope of the monotone curve at a key between secants d0 (over h0) and d1 (over h1): zero at a turning point, else
// their weighted harmonic mean, which never overshoots.
float monotoneSlope(float d0, float h0, float d1, float h1) {
    if (d0 * d1 <= 0.0f) return 0.0f;
    const float w0 = 2.0f * h1 + h0, w1 = h1 + 2.0f * h0;
    return (w0 + w1) / (w0 / d0 + w1 / d1);
}

float monotone(const float (&value)[4], const float (&time)[4], float t) {
    float d[3], h[3];
    for (int i = 0; i < 3; ++i) {
        h[i] = time[i + 1] - time[i];
        d[i] = h[i] > 0.0f ? (value[i + 1] - value[i]) / h[i] : 0.0f;
    }
    // At the ends of an open path the neighbour repeats the key: the slope there is the segment's own.
    const float start = h[0] > 0.0f ? monotoneSlope(d[0], h[0], d[1], h[1]) : d[1];
    const float end = h[2] > 0.0f ? monotoneSlope(d[1], h[1], d[2], h[2]) : d[1];
    return hermite(value[1], start, value[2], end, t, h[1]);
}

// Catmull-Rom through p[1] and p[2] with centripetal knots, at the fraction t of the segment's time.
glm::vec3 alongCurve(const glm::vec3 (&p)[4], const float (&time)[4], float t) {
    constexpr float kMinStep = 1e-3f;  // knots of equal points (a camera at rest) must differ
    float knot[4] = {0.0f, 0.0f, 0.0f, 0.0f}, step[3];
    for (int i = 0; i < 3; ++i) {
        step[i] = std::max(std::sqrt(glm::length(p[i + 1] - p[i])), kMinStep);
        knot[i + 1] = knot[i] + step[i];
    }
    // At an end of an open path one neighbour is missing: the tangent is the segment's.
    const bool hasFirst = time[0] < time[1], hasLast = time[2] < time[3];
    const glm::vec3 before = (p[1] - p[0]) / step[0], own = (p[2] - p[1]) / step[1], after = (p[3] - p[2]) / step[2];
    const glm::vec3 start = hasFirst ? (before * step[1] + own * step[0]) / (step[0] + step[1]) : own;
    const glm::vec3 end = hasLast ? (own * step[2] + after * step[1]) / (step[1] + step[2]) : own;
    const float at = (monotone(knot, time, t) - knot[1]) / step[1];
    return hermite(p[1], start, p[2], end, std::clamp(at, 0.0f, 1.0f), step[1]);
}

Around around(const CameraPath& path, float time) {
    const size_t count = path.keys.size();
    // A loop may repeat its first key as the last one: both are the same key.
    const size_t own = path.loop && count > 1 && path.keys.back().time >= path.keys.front().time + path.duration ? count - 1 : count;
    const auto timeOf = [&](ptrdiff_t i) {
        const ptrdiff_t n = ptrdiff_t(own);
        if (!path.loop) return path.keys[size_t(std::clamp<ptrdiff_t>(i, 0, n - 1))].time;
        const ptrdiff_t turn = i < 0 ? -1 : i / n;
        return path.keys[size_t(i - turn * n)].time + float(turn) * path.duration;
    };
    const auto keyOf = [&](ptrdiff_t i) {
        const ptrdiff_t n = ptrdiff_t(own);
        return size_t(path.loop ? (i % n + n) % n : std::clamp<ptrdiff_t>(i, 0, n - 1));
    };
    const auto after = std::upper_bound(
        path.keys.begin(), path.keys.begin() + ptrdiff_t(own), time, [](float t, const CameraPath::Key& key) { return t < key.time; });
    const ptrdiff_t segment = std::max<ptrdiff_t>(after - path.keys.begin() - 1, 0);
    Around out;
    for (int i = 0; i < 4; ++i) {
        out.key[i] = keyOf(segment + i - 1);
        out.time[i] = timeOf(segment + i - 1);
    }
    return out;
}

CameraPath::Key keyOf(const JsonAt& at) {
    at.only({"time", "eye", "target", "verticalFovDegrees"});
    CameraPath::Key key;
    key.time = float(at.at("time").number(0.0, 1e6));
    key.eye = vector3(at.at("eye"));
    key.target = vector3(at.at("target"));
    if (const auto fov = at.find("verticalFovDegrees")) key.fovY = fieldOfView(*fov);
    if (key.eye == key.target) at.at("target").fail("must differ from eye");
    return key;
}

}  // namespace

Camera CameraPath::at(float time) const {
    Camera camera;
    if (keys.empty()) return camera;
    if (!std::isfinite(time)) time = 0.0f;
    const float first = keys.front().time;
    if (loop && duration > 0.0f) {
        time = std::fmod(time - first, duration);
        if (time < 0.0f) time += duration;
        time += first;
    } else {
        time = std::clamp(time, first, keys.back().time);
    }
    const Around a = around(*this, time);
    const float span = a.time[2] - a.time[1];
    const float t = span > 0.0f ? std::clamp((time - a.time[1]) / span, 0.0f, 1.0f) : 0.0f;
    const Key* k[4];
    for (int i = 0; i < 4; ++i) k[i] = &keys[a.key[i]];
    camera.eye = alongCurve({k[0]->eye, k[1]->eye, k[2]->eye, k[3]->eye}, a.time, t);
    camera.target = alongCurve({k[0]->target, k[1]->target, k[2]->target, k[3]->target}, a.time, t);
    camera.fovY = monotone({k[0]->fovY, k[1]->fovY, k[2]->fovY, k[3]->fovY}, a.time, t);
    return camera;
}

CameraPath loadCameraPath(const std::filesystem::path& file) {
    const JsonFile json(file);
    const JsonAt root = json.root();
    root.only({"name", "scene", "duration", "loop", "keys", "events"});
    CameraPath path;
    if (const auto name = root.find("name")) path.name = name->text();
    if (const auto scene = root.find("scene")) path.scene = scene->text();
    if (const auto loop = root.find("loop")) path.loop = loop->truth();
    const JsonAt keys = root.at("keys").expectArray();
    if (keys.size() == 0) keys.fail("must have at least one key");
    for (size_t i = 0; i < keys.size(); ++i) {
        path.keys.push_back(keyOf(keys.at(i)));
        if (i > 0 && path.keys[i].time <= path.keys[i - 1].time)
            keys.at(i).at("time").fail(
                fmt::format("{} s does not come after the key before, at {} s", path.keys[i].time, path.keys[i - 1].time));
    }
    const auto& first = path.keys.front();
    const auto& last = path.keys.back();
    path.duration = last.time - first.time;
    if (const auto duration = root.find("duration")) {
        path.duration = float(duration->number(0.0, 1e6));
        if (last.time - first.time > path.duration)
            duration->fail(fmt::format("is {} s, but the keys span {} s", path.duration, last.time - first.time));
    }
    if (path.loop && path.keys.size() > 1 && last.time >= first.time + path.duration &&
        (last.eye != first.eye || last.target != first.target || last.fovY != first.fovY))
        keys.at(keys.size() - 1).fail("a loop's last key has the time of its first; make both equal, or raise the duration");
    if (const auto events = root.find("events")) path.events = dump(events->expectArray().json());
    return path;
}

CameraPath orbit(const Bounds& bounds) {
    const Camera first = frame(bounds);
    const glm::vec3 arm = first.eye - first.target;
    CameraPath path;
    path.name = "orbit";
    constexpr int kKeys = 12;
    path.duration = 24.0f;
    for (int i = 0; i < kKeys; ++i) {
        const float turn = glm::radians(360.0f * float(i) / kKeys);
        const glm::vec3 turned(arm.x * std::cos(turn) + arm.z * std::sin(turn), arm.y, arm.z * std::cos(turn) - arm.x * std::sin(turn));
        path.keys.push_back({path.duration * float(i) / kKeys, first.target + turned, first.target, first.fovY});
    }
    return path;
}

void CameraPath::save(const std::filesystem::path& file) const {
    const auto triple = [](const glm::vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); };
    const auto quoted = [](const std::string& text) { return dump(nlohmann::json(text)); };
    std::string text = fmt::format("{{\n  \"name\": {},\n  \"scene\": {},\n  \"duration\": {},\n  \"loop\": {},\n  \"keys\": [\n",
        quoted(name), quoted(scene), duration, loop);
    for (size_t i = 0; i < keys.size(); ++i) {
        // Double precision: loading gives the same float in radians.
        text += fmt::format("    {{\"time\": {}, \"eye\": {}, \"target\": {}, \"verticalFovDegrees\": {}}}{}\n", keys[i].time,
            triple(keys[i].eye), triple(keys[i].target), glm::degrees(double(keys[i].fovY)), i + 1 < keys.size() ? "," : "");
    }
    text += events.empty() ? std::string("  ]\n}\n") : fmt::format("  ],\n  \"events\": {}\n}}\n", events);

    std::filesystem::path temporary = file;
    temporary += ".tmp";
    std::error_code error;
    {
        std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
        out << text;
        out.close();
        if (!out) {
            std::filesystem::remove(temporary, error);
            throw Error(errorLine(file.string(), "", "cannot be written; choose a folder that exists and is writable"));
        }
    }
    std::filesystem::rename(temporary, file, error);
    if (error) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw Error(errorLine(file.string(), "", fmt::format("cannot be written: {}", error.message())));
    }
}

}  // namespace obscura::scene
