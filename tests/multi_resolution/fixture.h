// Fixture of multi_resolution: read-back of its levels, and analytic frames.
#pragma once

#include <array>
#include <bit>

#include "ao/method_test.h"

namespace obscura::test {

class MultiResolutionTest : public MethodTest {
protected:
    MultiResolutionTest() : MethodTest("multi_resolution") {}
    using MethodTest::run;
    Picture run(const Room& room, const ao::Values& values) { return run(room, values, "quadratic:2"); }

    // Makes run() read back the image `what` of the level at 1/side of full resolution.
    void readLevel(const char* what, int side) { m_probe = std::string("multi_resolution.") + what + " 1/" + std::to_string(side); }
    float depthAt(uint32_t x, uint32_t y) const { return std::bit_cast<float>(m_probed.at(x, y)); }
    float samplesAt(uint32_t x, uint32_t y) const { return float(m_probed.at(x, y) >> 22) * 0.5f; }
    float maximumAt(uint32_t x, uint32_t y) const { return float(m_probed.at(x, y) & 2047u) / 2047.0f; }
};

// 320x180 px visible with a guard band of a tenth; a wall facing the camera at this depth, with the given normal.
inline Room wall(float depth, const std::array<float, 3>& normal = {0, 0, 1}) {
    Room room;
    room.width = 384;
    room.height = 216;
    room.guard = 18;
    room.build();
    std::fill(room.depth.begin(), room.depth.end(), depth);
    for (size_t i = 0; i < room.depth.size(); ++i)
        for (size_t c = 0; c < 3; ++c) room.normals[4 * i + c] = normal[c];
    return room;
}

// A floor 1.5 m below the camera and a wall 8 m away.
inline Room hall() {
    Room room;
    room.width = 384;
    room.height = 216;
    room.guard = 18;
    room.floor = -1.5f;
    room.wall = -8.0f;
    room.build();
    return room;
}

// Direction of the view ray through (x, y) px: metres right and up per metre of depth.
inline std::array<float, 2> rayAt(const Room& room, float x, float y) {
    return {(x / float(room.width) * 2.0f - 1.0f) / room.projection[0], (y / float(room.height) * 2.0f - 1.0f) / room.projection[5]};
}

// The plane n.x = -1.6, sky elsewhere.
inline Room plane(std::array<float, 3> n) {
    Room room;
    room.build();
    const float length = std::hypot(n[0], n[1], n[2]);
    for (float& c : n) c /= length;
    for (uint32_t y = 0; y < room.height; ++y)
        for (uint32_t x = 0; x < room.width; ++x) {
            const size_t i = size_t(y) * room.width + x;
            const auto [right, up] = rayAt(room, float(x) + 0.5f, float(y) + 0.5f);
            const float facing = n[0] * right + n[1] * up - n[2];
            const float z = facing < 0.0f ? -1.6f / facing : 1e4f;
            room.depth[i] = z < 200.0f ? z : 1e4f;
            for (size_t c = 0; c < 3; ++c) room.normals[4 * i + c] = n[c];
        }
    return room;
}

}  // namespace obscura::test
