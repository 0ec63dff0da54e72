// Analytic depth, normals and voxels for tests: a floor and, optionally, a wall, seen from 1.6 m above the floor; one plane. Eye space,
// metres.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include "ao/library.h"
#include "gpu/resources.h"
#include "gpu/test_device.h"

namespace obscura::test {

struct Room {
    uint32_t width = 160, height = 96, guard = 8;
    float floor = -1.6f;           // y, eye space
    float wall = 0.0f;             // z of a wall that faces the camera; 0: none
    std::vector<float> depth;      // linear, 1e4 for sky
    std::vector<float> normals;    // xyz0
    std::vector<float> thickness;  // depth layers, optional: see ao::DepthLayers
    std::vector<float> second;     // second layer: depth and thickness, of every pixel or every second one
    std::vector<float> motion;     // xy, px, optional
    float projection[16] = {};
    ao::Volume volume;           // around the camera, its buffer left out
    std::vector<uint32_t> bits;  // of the volume: every cell that the floor's or the wall's plane touches

    void build() {
        voxelize(128, 0.12f);
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
    // The eye is at the window's middle; `tilt` rotates its axes about x, radians. `origin` changes addresses, not the voxelized world.
    void voxelize(uint32_t cells, float cellSize, float tilt = 0.0f, std::array<int, 3> origin = {}) {
        const float c = std::cos(tilt), s = std::sin(tilt), half = 0.5f * float(cells), scale = 1.0f / cellSize;
        volume = {};
        volume.cells = cells;
        const float columns[16] = {scale, 0, 0, 0, 0, c * scale, s * scale, 0, 0, -s * scale, c * scale, 0, half, half, half, 1};
        std::copy(std::begin(columns), std::end(columns), volume.cellFromEye);
        std::copy(origin.begin(), origin.end(), volume.origin);
        bits.assign(size_t(cells) * cells * cells / 32, 0);
        // The plane n . cell = d, in cells, touches the cells whose middle is within half of |n.x| + |n.y| + |n.z| of it.
        const auto touches = [&](float ny, float nz, float d, float y, float z) {
            return std::abs(ny * (y + 0.5f - half) + nz * (z + 0.5f - half) - d) <= 0.5f * (std::abs(ny) + std::abs(nz)) + 1e-4f;
        };
        for (uint32_t y = 0; y < cells; ++y)
            for (uint32_t z = 0; z < cells; ++z) {
                if (!touches(c, s, floor * scale, float(y), float(z)) && !(wall < 0.0f && touches(-s, c, wall * scale, float(y), float(z))))
                    continue;
                for (uint32_t x = 0; x < cells; ++x) set(x, y, z);
            }
    }
    void set(uint32_t x, uint32_t y, uint32_t z) {
        const uint32_t mask = volume.cells - 1, side = volume.cells / 8;
        x = (x + uint32_t(volume.origin[0])) & mask;
        y = (y + uint32_t(volume.origin[1])) & mask;
        z = (z + uint32_t(volume.origin[2])) & mask;
        bits[(((x / 8) * side + y / 8) * side + z / 8) * 16 + (x & 7) * 2 + ((y & 7) >> 2)] |= 1u << ((y & 3) * 8 + (z & 7));
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
        result.volume = volume;
        return result;
    }

    VkExtent2D secondSize() const {
        return second.size() == thickness.size() * 2 ? VkExtent2D{width, height} : VkExtent2D{(width + 1) / 2, (height + 1) / 2};
    }
    gpu::Image layer(gpu::Device& device, bool ofSecond) const {
        return ofSecond ? uploaded(device, VK_FORMAT_R32G32_SFLOAT, secondSize(), second, "layer")
                        : uploaded(device, VK_FORMAT_R32_SFLOAT, {width, height}, thickness, "layer");
    }
    gpu::Image motionImage(gpu::Device& device) const {
        return uploaded(device, VK_FORMAT_R32G32_SFLOAT, {width, height}, motion, "motion");
    }
    gpu::Image image(gpu::Device& device, bool ofNormals) const {
        return ofNormals ? uploaded(device, VK_FORMAT_R32G32B32A32_SFLOAT, {width, height}, normals, "room")
                         : uploaded(device, VK_FORMAT_R32_SFLOAT, {width, height}, depth, "room");
    }
    static gpu::Image uploaded(gpu::Device& device, VkFormat format, VkExtent2D size, const std::vector<float>& texels, const char* name) {
        gpu::Image result;
        EXPECT_EQ(gpu::Image::create(device,
                      {format, size.width, size.height, 1, 1, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}, name, result),
            gpu::Status::ok);
        EXPECT_EQ(gpu::upload(device, result, std::as_bytes(std::span(texels)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL), gpu::Status::ok);
        return result;
    }
};

// Direction of the view ray through (x, y) px, guard band included: metres right and up per metre of depth.
inline std::array<float, 2> rayAt(const Room& room, float x, float y) {
    return {(x / float(room.width) * 2.0f - 1.0f) / room.projection[0], (y / float(room.height) * 2.0f - 1.0f) / room.projection[5]};
}

// The plane of the points p with p . normal / |normal| = -1.6; sky elsewhere, and where it is farther than `farthest`.
inline Room plane(const std::array<float, 3>& normal, float farthest = 200.0f) {
    Room room;
    room.build();
    const float length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (uint32_t y = 0; y < room.height; ++y)
        for (uint32_t x = 0; x < room.width; ++x) {
            const size_t i = size_t(y) * room.width + x;
            const auto [right, up] = rayAt(room, float(x) + 0.5f, float(y) + 0.5f);
            const float facing = (normal[0] * right + normal[1] * up - normal[2]) / length;
            const float z = facing < 0.0f ? -1.6f / facing : 1e4f;
            room.depth[i] = z < farthest ? z : 1e4f;
            for (size_t c = 0; c < 3; ++c) room.normals[4 * i + c] = normal[c] / length;
        }
    return room;
}

// A floor at y = `floor` and a wall that faces the camera at z = `wall`.
inline Room crease(uint32_t width = 320, uint32_t height = 240, uint32_t guard = 32, float floor = -1.0f, float wall = -3.0f) {
    Room room;
    room.width = width;
    room.height = height;
    room.guard = guard;
    room.floor = floor;
    room.wall = wall;
    room.build();
    return room;
}

inline float halfToFloat(uint16_t h) {
    const int exponent = (h >> 10) & 31, mantissa = h & 1023;
    const float magnitude = exponent == 0 ? std::ldexp(float(mantissa), -24) : std::ldexp(float(mantissa) / 1024.0f + 1.0f, exponent - 15);
    return h & 0x8000 ? -magnitude : magnitude;
}
// Half floats as floats; of a buffer in host memory.
inline std::vector<float> halvesOf(std::span<const std::byte> bytes) {
    std::vector<uint16_t> halves(bytes.size() / 2);
    std::memcpy(halves.data(), bytes.data(), halves.size() * 2);
    std::vector<float> floats(halves.size());
    std::transform(halves.begin(), halves.end(), floats.begin(), halfToFloat);
    return floats;
}
inline std::vector<float> halvesOf(const gpu::Buffer& buffer) { return halvesOf({buffer.mapped(), size_t(buffer.bytes())}); }

}  // namespace obscura::test
