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
inline Room hall() { return crease(384, 216, 18, -1.5f, -8.0f); }

}  // namespace obscura::test
