// Fixture of far_field and mipmap: analytic planes and a crease.
#pragma once

#include "ao/falloff_table.h"
#include "ao/method_test.h"
#include "ao/methods/far_field/grid.h"

namespace obscura::test {

class FarFieldTest : public MethodTest {
protected:
    FarFieldTest() : MethodTest("far_field") {}
};

// The plane n.x = -1.6, sky elsewhere.
inline Room plane(const std::array<float, 3>& normal) {
    Room room;
    room.build();
    const float length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (uint32_t y = 0; y < room.height; ++y) {
        for (uint32_t x = 0; x < room.width; ++x) {
            const size_t i = size_t(y) * room.width + x;
            const float right = ((float(x) + 0.5f) / float(room.width) * 2.0f - 1.0f) / room.projection[0];
            const float up = ((float(y) + 0.5f) / float(room.height) * 2.0f - 1.0f) / room.projection[5];
            const float facing = (normal[0] * right + normal[1] * up - normal[2]) / length;
            const float z = facing < 0.0f ? -1.6f / facing : 1e4f;
            room.depth[i] = z < 200.0f ? z : 1e4f;
            for (int c = 0; c < 3; ++c) room.normals[4 * i + c] = normal[c] / length;
        }
    }
    return room;
}

// A floor and a wall that faces the camera, 3 m away.
inline Room crease(uint32_t width = 320, uint32_t height = 240, uint32_t guard = 32) {
    Room room;
    room.width = width;
    room.height = height;
    room.guard = guard;
    room.floor = -1.0f;
    room.wall = -3.0f;
    room.build();
    return room;
}

inline bool finite(const Picture& picture) {
    return std::all_of(picture.begin(), picture.end(), [](float v) { return v >= 0.0f && v <= 1.0f; });
}

}  // namespace obscura::test
