// Analytic depth and normals for tests: a floor and, optionally, a wall, seen from 1.6 m above the floor.
#pragma once

#include <cmath>
#include <cstring>
#include <vector>

#include "ao/library.h"
#include "gpu/resources.h"
#include "gpu/test_device.h"

namespace obscura::test {

struct Room {
    uint32_t width = 160, height = 96, guard = 8;
    float floor = -1.6f;           // y, eye space
    float wall = 0.0f;             // z of a wall that faces the camera; 0: none
    std::vector<float> depth;      // linear, 1e4 where nothing is
    std::vector<float> normals;    // xyz0
    float projection[16] = {};

    void build() {
        const float f = 1.0f / std::tan(0.5236f);
        const float fy = f * float(height - 2 * guard) / float(height), fx = fy * float(height) / float(width);
        const float p[16] = {fx, 0, 0, 0, 0, -fy, 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0};
        std::memcpy(projection, p, sizeof(p));
        depth.assign(size_t(width) * height, 1e4f);
        normals.assign(size_t(width) * height * 4, 0.0f);
        for (uint32_t y = 0; y < height; ++y) {
            for (uint32_t x = 0; x < width; ++x) {
                const size_t i = size_t(y) * width + x;
                const float slope = -((float(y) + 0.5f) / float(height) * 2.0f - 1.0f) / fy;  // eye y per metre of depth
                float z = 1e4f;
                if (slope < 0.0f) z = floor / slope;
                const bool onWall = wall < 0.0f && z > -wall;
                if (onWall) z = -wall;
                if (z > 200.0f) z = 1e4f;
                depth[i] = z;
                normals[i * 4 + (onWall ? 2 : 1)] = 1.0f;
            }
        }
    }
    uint32_t visibleWidth() const { return width - 2 * guard; }
    uint32_t visibleHeight() const { return height - 2 * guard; }

    ao::Frame frame() const {
        ao::Frame result;
        result.size = {width, height};
        result.guard = {guard, guard};
        std::memcpy(result.projection, projection, sizeof(projection));
        result.depthKind = ao::DepthKind::linear;
        result.skyDepth = 9000.0f;
        return result;
    }

    gpu::Image image(gpu::Device& device, bool ofNormals) const {
        gpu::Image result;
        EXPECT_EQ(gpu::Image::create(device, {ofNormals ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R32_SFLOAT, width, height, 1, 1,
                                              VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}, "room", result), gpu::Status::ok);
        EXPECT_EQ(gpu::upload(device, result, std::as_bytes(std::span(ofNormals ? normals : depth)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL), gpu::Status::ok);
        return result;
    }
};

inline float halfToFloat(uint16_t h) {
    const int exponent = (h >> 10) & 31, mantissa = h & 1023;
    const float magnitude = exponent == 0 ? std::ldexp(float(mantissa), -24) : std::ldexp(float(mantissa) / 1024.0f + 1.0f, exponent - 15);
    return h & 0x8000 ? -magnitude : magnitude;
}

}  // namespace obscura::test
