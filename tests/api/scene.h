// A scene of boxes and a floating ball, ray-traced in double precision for any camera, projection, size and scale. All of it lies inside
// the visible part, so the guard band shows only sky.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "obscura/ao.h"

namespace obscura::test {

struct Box {
    glm::dvec3 low, high;
};
inline constexpr Box kBoxes[] = {{{-3, -0.2, -3}, {3, 0, 3}}, {{-3, 0, -3}, {3, 2, -2.8}}, {{2.8, 0, -2.8}, {3, 1.2, 0}},
    {{-1.5, 0, -1.5}, {-0.5, 1, -0.5}}, {{1.0, 0, 0.0}, {1.1, 1.6, 0.1}}};
inline constexpr glm::dvec3 kBall{0.3, 0.5, 0.6};
inline constexpr double kRadius = 0.5;
inline constexpr uint32_t kCells = 128;  // a side of the volume, whose middle is the origin of the world
inline constexpr double kCell = 0.0625;  // metres

struct Camera {
    glm::dvec3 eye{-1.5, 3.2, 6.5}, target{0, 0.4, -0.5};
    glm::dmat3 axes() const {  // columns: the x, y, z axes of eye space in the world
        const glm::dvec3 z = glm::normalize(eye - target), x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), z));
        return {x, glm::cross(z, x), z};
    }
};

// Camera and projection onto the image; the depth convention is separate.
struct Geometry {
    VkExtent2D visible{160, 90}, guard{16, 16};
    bool orthographic = false, flipped = false;
    glm::dvec2 shift{0, 0};  // off-centre: eye.xy per metre of depth in the middle of the image
    double scale = 1.0;      // of the world
    double zoom = 1.0;
    Camera camera;               // of the world at scale 1
    glm::dvec3 origin{0, 0, 0};  // origin of the scene in the host's world, metres

    VkExtent2D size() const { return {visible.width + 2 * guard.width, visible.height + 2 * guard.height}; }
    double focal() const { return zoom * 0.5 * std::max(double(visible.height), visible.width * 9.0 / 16.0) / std::tan(0.5236); }  // px
    // Eye-space x and y of a pixel's ray, a metre away (orthographic: anywhere).
    glm::dvec2 slope(double x, double y) const {
        const glm::dvec2 s{(x + 0.5 - 0.5 * size().width) / focal(), (y + 0.5 - 0.5 * size().height) / focal() * (flipped ? 1.0 : -1.0)};
        return (s + shift) * (orthographic ? kMiddle * scale : 1.0);
    }
    glm::dvec2 pixel(const glm::dvec3& eyeSpace) const {
        const glm::dvec2 s = glm::dvec2(eyeSpace) / (orthographic ? kMiddle * scale : -eyeSpace.z) - shift;
        return {s.x * focal() + 0.5 * size().width - 0.5, s.y * focal() * (flipped ? 1.0 : -1.0) + 0.5 * size().height - 0.5};
    }
    static constexpr double kMiddle = 7.0;  // metres: depth at which the orthographic image has the perspective scale
};

// Depths at which a ray enters and leaves solids.
struct Span {
    double enter, leave;
    glm::dvec3 normal;
};

inline std::vector<Span> spansAlong(const glm::dvec3& from, const glm::dvec3& along) {
    std::vector<Span> spans;
    for (const Box& box : kBoxes) {
        const glm::dvec3 a = (box.low - from) / along, b = (box.high - from) / along, near = glm::min(a, b), far = glm::max(a, b);
        const double enter = std::max({near.x, near.y, near.z}), leave = std::min({far.x, far.y, far.z});
        if (!(enter > 1e-6 && enter < leave)) continue;
        glm::dvec3 normal(0.0);
        const int axis = near.x >= near.y && near.x >= near.z ? 0 : near.y >= near.z ? 1 : 2;
        normal[axis] = along[axis] > 0.0 ? -1.0 : 1.0;
        spans.push_back({enter, leave, normal});
    }
    const glm::dvec3 to = from - kBall;
    const double a = glm::dot(along, along), b = glm::dot(to, along), c = glm::dot(to, to) - kRadius * kRadius, root = b * b - a * c;
    if (root > 0.0 && (-b - std::sqrt(root)) / a > 1e-6) {
        const double enter = (-b - std::sqrt(root)) / a;
        spans.push_back({enter, (-b + std::sqrt(root)) / a, (to + enter * along) / kRadius});
    }
    std::sort(spans.begin(), spans.end(), [](const Span& x, const Span& y) { return x.enter < y.enter; });
    return spans;
}

// The traced image, guard band included. Depth 0 is sky.
struct Picture {
    std::vector<double> depth;
    std::vector<glm::dvec3> normal;        // eye space
    std::vector<float> thickness, second;  // as ao::DepthLayers says, second of full size
};

inline Picture trace(const Geometry& g) {
    const VkExtent2D size = g.size();
    Picture picture;
    const size_t count = size_t(size.width) * size.height;
    picture.depth.assign(count, 0.0);
    picture.normal.assign(count, {0, 0, 1});
    picture.thickness.assign(count, 0.0f);
    picture.second.assign(2 * count, 0.0f);
    const glm::dmat3 axes = g.camera.axes();
    for (uint32_t y = 0; y < size.height; ++y)
        for (uint32_t x = 0; x < size.width; ++x) {
            const glm::dvec2 s = g.slope(x, y);
            const glm::dvec3 from = g.orthographic ? axes * glm::dvec3(s / g.scale, 0) : glm::dvec3(0.0);
            const glm::dvec3 along = g.orthographic ? axes * glm::dvec3(0, 0, -1) : axes * glm::dvec3(s, -1);
            const std::vector<Span> spans = spansAlong(g.camera.eye + from, along);
            if (spans.empty()) continue;
            const size_t i = size_t(y) * size.width + x;
            picture.depth[i] = spans[0].enter * g.scale;
            picture.normal[i] = glm::transpose(axes) * spans[0].normal;
            picture.thickness[i] = float((spans[0].leave - spans[0].enter) * g.scale);
            for (const Span& behind : spans) {
                if (behind.enter <= spans[0].leave) continue;
                picture.second[2 * i] = float(behind.enter * g.scale);
                picture.second[2 * i + 1] = float((behind.leave - behind.enter) * g.scale);
                break;
            }
        }
    return picture;
}

// Motion in px from each pixel to its surface's position last frame, x and y interleaved.
inline std::vector<float> motionOf(const Geometry& now, const Geometry& before, const Picture& picture) {
    std::vector<float> motion(picture.depth.size() * 2, 0.0f);
    for (size_t i = 0; i < picture.depth.size(); ++i) {
        const double x = double(i % now.size().width), y = double(i / now.size().width), depth = picture.depth[i];
        if (depth == 0.0) continue;
        const glm::dvec2 s = now.slope(x, y) * (now.orthographic ? 1.0 : depth);
        const glm::dvec3 world = now.camera.axes() * glm::dvec3(s, -depth) / now.scale + now.camera.eye;
        const glm::dvec2 was = before.pixel(glm::transpose(before.camera.axes()) * (world - before.camera.eye) * before.scale);
        motion[2 * i] = float(was.x - x);
        motion[2 * i + 1] = float(was.y - y);
    }
    return motion;
}

// Every cell that a surface touches (the ball's shell slightly thicker), in the layout of ao::Volume.
inline std::vector<uint32_t> voxelize() {
    std::vector<uint32_t> bits(size_t(kCells) * kCells * kCells / 32, 0u);
    const double half = 0.5 * kCell, corner = half * std::sqrt(3.0);
    for (uint32_t x = 0; x < kCells; ++x)
        for (uint32_t y = 0; y < kCells; ++y)
            for (uint32_t z = 0; z < kCells; ++z) {
                const glm::dvec3 middle = (glm::dvec3(x, y, z) + 0.5 - 0.5 * kCells) * kCell;
                bool set = std::abs(glm::length(middle - kBall) - kRadius) <= corner;
                for (const Box& box : kBoxes) {
                    const bool touches =
                        glm::all(glm::greaterThanEqual(middle + half, box.low)) && glm::all(glm::lessThanEqual(middle - half, box.high));
                    const bool within =
                        glm::all(glm::greaterThan(middle - half, box.low)) && glm::all(glm::lessThan(middle + half, box.high));
                    set |= touches && !within;
                }
                if (set)
                    bits[(((x / 8) * (kCells / 8) + y / 8) * (kCells / 8) + z / 8) * 16 + (x & 7) * 2 + ((y & 7) >> 2)] |=
                        1u << ((y & 3) * 8 + (z & 7));
            }
    return bits;
}

}  // namespace obscura::test
