// Reads, validates and writes captures: NAME.json and NAME.capture.exr.
#include "truth/captured_frame.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "ao/prepare.h"
#include "scene/json_file.h"
#include "scene/json_text.h"

namespace obscura::truth {
namespace {

using scene::JsonAt;

std::filesystem::path stemOf(const std::filesystem::path& path) {
    std::string text = path.string();
    for (const std::string_view end : {".capture.exr", ".json"})
        if (text.size() > end.size() && text.ends_with(end)) return text.substr(0, text.size() - end.size());
    return path;
}

std::filesystem::path withSuffix(std::filesystem::path stem, const char* suffix) {
    stem += suffix;
    return stem;
}

glm::uvec2 pair(const JsonAt& at, uint64_t low) {
    at.expectNumbers(2);
    return {uint32_t(at.at(size_t(0)).whole(low, 32768)), uint32_t(at.at(1).whole(low, 32768))};
}

// True if the field is `other`; `standard` is the default.
bool choice(const JsonAt& root, const char* key, const char* standard, const char* other) {
    const auto at = root.find(key);
    if (!at) return false;
    const std::string text = at->text();
    if (text != standard && text != other) at->fail(fmt::format("must be \"{}\" or \"{}\", not \"{}\"", standard, other, text));
    return text == other;
}

ao::Frame lensOf(const CapturedFrame& frame, ao::DepthKind kind) {
    ao::Frame lens;
    lens.size = {frame.size.x, frame.size.y};
    lens.guard = {frame.guard.x, frame.guard.y};
    std::memcpy(lens.projection, glm::value_ptr(frame.projection), sizeof lens.projection);
    lens.depthKind = kind;
    lens.skyDepth = kind == ao::DepthKind::linear ? frame.skyDepth : 0.0f;
    return lens;
}

shared::View viewOf(const CapturedFrame& frame, ao::DepthKind kind) {
    shared::View view{};
    const char* reason = "";
    if (ao::viewOf(lensOf(frame, kind), view, reason) != ao::Status::ok)
        throw scene::Error(fmt::format("the frame's projection is invalid: {}", reason));
    return view;
}

glm::vec3 unproject(const shared::View& view, uint32_t x, uint32_t y, float depth) {
    const float ex = (float(x) + 0.5f) * view.unproject.x + view.unproject.z;
    const float ey = (float(y) + 0.5f) * view.unproject.y + view.unproject.w;
    return view.orthographic > 0.5f ? glm::vec3(ex, ey, -depth) : glm::vec3(ex * depth, ey * depth, -depth);
}

void linearizeDepth(CapturedFrame& frame, const std::string& file) {
    const shared::View view = viewOf(frame, ao::DepthKind::device);
    frame.skyDepth = view.skyDepth;
    for (size_t i = 0; i < frame.depth.size(); ++i) {
        float& z = frame.depth[i];
        if (!(z >= 0.0f && z <= 1.0f))
            throw scene::Error(scene::errorLine(
                file, "", fmt::format("Z is {} at pixel ({}, {}); device depth lies in [0, 1]", z, i % frame.size.x, i / frame.size.x)));
        const float linear = (z * view.linearize.x + view.linearize.y) / (z * view.linearize.z + view.linearize.w);
        z = std::isfinite(linear) && linear > 0.0f && linear < frame.skyDepth ? linear : frame.skyDepth;
    }
}

}  // namespace

glm::vec3 CapturedFrame::eyePosition(uint32_t x, uint32_t y) const { return unproject(view(), x, y, depth[index(x, y)]); }

glm::mat4 CapturedFrame::worldFromEye() const { return camera ? glm::inverse(camera->view()) : glm::mat4(1.0f); }

shared::View CapturedFrame::view() const {
    shared::View view = viewOf(*this, ao::DepthKind::linear);
    view.skyDepth = skyDepth;
    return view;
}

Plane CapturedFrame::visibleDepth() const {
    const glm::uvec2 part = visible();
    Plane plane(part.x, part.y);
    for (uint32_t y = 0; y < part.y; ++y)
        for (uint32_t x = 0; x < part.x; ++x) plane.at(x, y) = depth[visibleIndex(x, y)];
    return plane;
}

std::vector<uint8_t> CapturedFrame::visibleMask() const {
    const glm::uvec2 part = visible();
    std::vector<uint8_t> mask;
    mask.reserve(size_t(part.x) * part.y);
    for (uint32_t y = 0; y < part.y; ++y)
        for (uint32_t x = 0; x < part.x; ++x) mask.push_back(!isSky(visibleIndex(x, y)));
    return mask;
}

bool CapturedFrame::showsSurface() const {
    const std::vector<uint8_t> mask = visibleMask();
    return std::find(mask.begin(), mask.end(), uint8_t(1)) != mask.end();
}

void CapturedFrame::reconstructNormals() {
    normals.assign(depth.size(), glm::vec3(0.0f));
    const shared::View lens = view();
    const auto at = [&](uint32_t x, uint32_t y) { return unproject(lens, x, y, depth[index(x, y)]); };
    for (uint32_t y = 0; y < size.y; ++y)
        for (uint32_t x = 0; x < size.x; ++x) {
            if (isSky(index(x, y))) continue;
            const glm::vec3 here = at(x, y);
            // On each axis the neighbour with the smaller change of depth: the other one may be on another surface.
            const auto slope = [&](bool horizontal) {
                const uint32_t c = horizontal ? x : y, last = (horizontal ? size.x : size.y) - 1;
                const glm::vec3 ahead = c < last ? (horizontal ? at(x + 1, y) : at(x, y + 1)) - here : glm::vec3(1e30f);
                const glm::vec3 behind = c > 0 ? here - (horizontal ? at(x - 1, y) : at(x, y - 1)) : glm::vec3(1e30f);
                return std::fabs(ahead.z) < std::fabs(behind.z) ? ahead : behind;
            };
            const glm::vec3 n = glm::cross(slope(true), slope(false));
            const glm::vec3 towards = lens.orthographic > 0.5f ? glm::vec3(0, 0, 1) : -here;
            const float length = glm::length(n);
            if (length > 0.0f && std::isfinite(length)) normals[index(x, y)] = n / (glm::dot(n, towards) < 0.0f ? -length : length);
            else normals[index(x, y)] = glm::normalize(towards);
        }
}

void CapturedFrame::check(const std::string& name) const {
    const auto fail = [&](const std::string& what) { throw scene::Error(scene::errorLine(name, "", what)); };
    const size_t count = size_t(size.x) * size.y;
    if (count == 0 || 2 * guard.x >= size.x || 2 * guard.y >= size.y)
        fail(fmt::format("a guard band of {} x {} leaves no visible pixel of {} x {}", guard.x, guard.y, size.x, size.y));
    if (depth.size() != count) fail(fmt::format("{} depths for {} x {} pixels", depth.size(), size.x, size.y));
    if (hasNormals() && normals.size() != count) fail(fmt::format("{} normals for {} x {} pixels", normals.size(), size.x, size.y));
    for (size_t i = 0; i < count; ++i) {
        const size_t x = i % size.x, y = i / size.x;
        if (!std::isfinite(depth[i])) fail(fmt::format("Z is {} at pixel ({}, {}); write {} for sky", depth[i], x, y, skyDepth));
        if (depth[i] <= 0.0f) fail(fmt::format("Z is {} at pixel ({}, {}); linear depth is -z in metres, above 0", depth[i], x, y));
        if (!hasNormals() || isSky(i)) continue;
        const float length = glm::length(normals[i]);
        if (!(length > 0.9f && length < 1.1f))
            fail(fmt::format("N has length {} at pixel ({}, {}); normals are unit vectors", length, x, y));
    }
}

glm::vec3 unpackNormal(uint32_t bits) {
    const glm::vec2 e = glm::unpackSnorm2x16(bits);
    glm::vec3 n(e.x, e.y, 1.0f - std::abs(e.x) - std::abs(e.y));
    const float t = std::max(-n.z, 0.0f);
    n.x -= n.x >= 0.0f ? t : -t;
    n.y -= n.y >= 0.0f ? t : -t;
    return glm::normalize(n);
}

CapturedFrame emptyFrame(glm::uvec2 visible, glm::uvec2 guard, float verticalFov, float near, std::optional<scene::Camera> camera) {
    CapturedFrame frame;
    frame.size = visible + 2u * guard;
    frame.guard = guard;
    frame.verticalFov = verticalFov;
    frame.near = near;
    frame.camera = camera;
    scene::Camera lens = camera.value_or(scene::Camera());
    lens.fovY = verticalFov;
    lens.nearPlane = near;
    frame.projection = lens.projection(glm::vec2(frame.size), glm::vec2(visible));
    frame.depth.assign(size_t(frame.size.x) * frame.size.y, frame.skyDepth);
    frame.normals.assign(frame.depth.size(), glm::vec3(0.0f));
    return frame;
}

CapturedFrame readCapture(const std::filesystem::path& path) {
    const std::filesystem::path stem = stemOf(path);
    const scene::JsonFile json(withSuffix(stem, ".json"));
    const JsonAt root = json.root();
    const glm::uvec2 visible = pair(root.at("visible"), 1);
    const glm::uvec2 guard = pair(root.at("guardBand"), 0);
    const float fov = scene::fieldOfView(root.at("verticalFovDegrees"));
    const float near = float(root.at("near").number(root.has("projection") ? 0.0 : 1e-5, 1e6));
    std::optional<scene::Camera> camera;
    if (root.has("eye") || root.has("target")) {
        camera.emplace();
        camera->eye = scene::vector3(root.at("eye"));
        camera->target = scene::vector3(root.at("target"));
        if (const auto up = root.find("up")) camera->up = scene::vector3(*up);
        camera->fovY = fov;
        camera->nearPlane = near;
        if (camera->eye == camera->target) root.at("target").fail("must differ from eye");
        if (camera->up == glm::vec3(0.0f)) root.at("up").fail("must not be the zero vector");
    }
    CapturedFrame frame = emptyFrame(visible, guard, fov, near, camera);
    const bool device = choice(root, "depth", "linear", "device");
    const bool world = choice(root, "normals", "eye", "world");
    if (world && !camera) root.at("normals").fail("\"world\" needs \"eye\" and \"target\"");
    if (const auto at = root.find("projection")) {
        at->expectNumbers(16);
        for (int i = 0; i < 16; ++i) glm::value_ptr(frame.projection)[i] = float(at->at(size_t(i)).number());
        shared::View view{};
        const char* reason = "";
        if (ao::viewOf(lensOf(frame, device ? ao::DepthKind::device : ao::DepthKind::linear), view, reason) != ao::Status::ok)
            at->fail(reason);
    }
    if (const auto at = root.find("skyDepth")) frame.skyDepth = float(at->number(1e-3, 1e8));

    const std::filesystem::path file = withSuffix(stem, ".capture.exr");
    const Picture picture = readExr(file);
    const auto fail = [&](const std::string& what) { throw scene::Error(scene::errorLine(file.string(), "", what)); };
    if (picture.width != frame.size.x || picture.height != frame.size.y)
        fail(fmt::format("is {} x {} pixels, but visible + 2 * guardBand in {} makes {} x {}", picture.width, picture.height,
            withSuffix(stem, ".json").filename().string(), frame.size.x, frame.size.y));
    const auto* z = picture.find("Z");
    if (!z) fail("channel Z is missing; it holds the depth");
    frame.depth = z->values;
    if (device) linearizeDepth(frame, file.string());

    const Picture::Channel* n[3] = {picture.find("N.X"), picture.find("N.Y"), picture.find("N.Z")};
    if (!n[0] && !n[1] && !n[2]) {
        frame.normals.clear();
    } else {
        for (int i = 0; i < 3; ++i)
            if (!n[i]) fail(fmt::format("channel N.{} is missing; give N.X, N.Y and N.Z, or none of them", "XYZ"[i]));
        const glm::mat3 eyeFromSource = world ? glm::mat3(camera->view()) : glm::mat3(1.0f);
        for (size_t i = 0; i < frame.normals.size(); ++i)
            frame.normals[i] =
                frame.isSky(i) ? glm::vec3(0.0f) : eyeFromSource * glm::vec3(n[0]->values[i], n[1]->values[i], n[2]->values[i]);
    }
    frame.check(file.string());
    for (glm::vec3& normal : frame.normals)
        if (const float length = glm::length(normal); length > 0.0f) normal /= length;
    return frame;
}

void writeCapture(const std::filesystem::path& path, const CapturedFrame& frame) {
    const std::filesystem::path stem = stemOf(path);
    frame.check(stem.string());
    using Json = nlohmann::ordered_json;
    const glm::uvec2 visible = frame.visible();
    const auto vector = [](const glm::vec3& v) { return Json::array({v.x, v.y, v.z}); };
    Json json;
    json["verticalFovDegrees"] = glm::degrees(double(frame.verticalFov));
    json["visible"] = {visible.x, visible.y};
    json["guardBand"] = {frame.guard.x, frame.guard.y};
    json["near"] = frame.near;
    if (frame.camera) {
        json["eye"] = vector(frame.camera->eye);
        json["target"] = vector(frame.camera->target);
        json["up"] = vector(frame.camera->up);
    }
    if (frame.projection != emptyFrame(visible, frame.guard, frame.verticalFov, frame.near).projection) {
        json["projection"] = Json::array();
        for (int i = 0; i < 16; ++i) json["projection"].push_back(glm::value_ptr(frame.projection)[i]);
    }
    if (frame.skyDepth != CapturedFrame().skyDepth) json["skyDepth"] = frame.skyDepth;

    Picture picture;
    Plane plane(frame.size.x, frame.size.y);
    plane.values = frame.depth;
    picture.add("Z", plane);
    for (int axis = 0; axis < 3 && frame.hasNormals(); ++axis) {
        for (size_t i = 0; i < plane.values.size(); ++i) plane.values[i] = frame.normals[i][axis];
        picture.add(std::string("N.") + "XYZ"[axis], plane);
    }
    writeExr(withSuffix(stem, ".capture.exr"), picture);
    const std::string text = scene::dump(json, 2) + "\n";
    writeWhole(withSuffix(stem, ".json"), text.data(), text.size());
}

}  // namespace obscura::truth
