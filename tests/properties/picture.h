// Analytic worlds seen by cameras of any field of view and pixel shape, perspective or orthographic, with voxels; and how far two pictures
// differ. Eye space, metres.
#pragma once

#include "ao/solids.h"

namespace obscura::test {

struct Lens {
    float degrees = 60.0f;  // vertical field of view of the visible part
    float height = 0.0f;    // orthographic: height of the visible part, metres; 0: perspective
    float away = 0.0f;      // orthographic: metres by which the camera's plane is farther back
    uint32_t columns = 1;   // pixels side by side in the place of a square one
    float ahead = 4.0f;     // metres to the middle of the voxels
    glm::mat3 turn{1.0f};   // of the camera
};
inline constexpr uint32_t kVisibleWidth = 96, kVisibleHeight = 64, kBand = 16;

inline float distanceTo(const Solid& s, const glm::vec3& p) {  // signed
    const glm::vec3 v = p - s.at;
    if (s.kind == Solid::Kind::plane) return glm::dot(v, glm::normalize(s.size));
    if (s.kind == Solid::Kind::sphere) return glm::length(v) - s.size.x;
    if (s.kind == Solid::Kind::cylinder) return glm::length(glm::vec2(v.x, v.z)) - s.size.x;
    const glm::vec3 q = glm::abs(v) - s.size;
    return glm::length(glm::max(q, glm::vec3(0.0f))) + std::min(std::max({q.x, q.y, q.z}), 0.0f);
}

// Voxels of the solids' surfaces.
inline void voxelizeSolids(Room& room, const std::vector<Solid>& solids, const Lens& lens) {
    constexpr uint32_t kCells = 64;
    constexpr float kCell = 0.12f, kHalf = 0.5f * float(kCells);
    room.volume = {};
    room.volume.cells = kCells;
    const float scale = 1.0f / kCell;
    for (int axis = 0; axis < 3; ++axis)
        for (int row = 0; row < 3; ++row) room.volume.cellFromEye[4 * axis + row] = scale * lens.turn[axis][row];
    room.volume.cellFromEye[12] = room.volume.cellFromEye[13] = kHalf;
    room.volume.cellFromEye[14] = kHalf + (lens.ahead + lens.away) * scale;
    room.volume.cellFromEye[15] = 1.0f;
    room.bits.assign(size_t(kCells) * kCells * kCells / 32, 0);
    for (uint32_t x = 0; x < kCells; ++x)
        for (uint32_t y = 0; y < kCells; ++y)
            for (uint32_t z = 0; z < kCells; ++z) {
                const glm::vec3 p = (glm::vec3(x, y, z) + 0.5f - kHalf) * kCell - glm::vec3(0, 0, lens.ahead);
                for (const Solid& solid : solids)
                    if (std::abs(distanceTo(solid, p)) <= 0.5f * kCell + 1e-4f) {
                        room.set(x, y, z);
                        break;
                    }
            }
}

inline Room seen(const std::vector<Solid>& solids, const Lens& lens) {
    Room room;
    room.guard = kBand;
    room.width = kVisibleWidth * lens.columns + 2 * kBand;
    room.height = kVisibleHeight + 2 * kBand;
    const bool parallel = lens.height > 0.0f;
    const float visible = float(kVisibleHeight) / float(room.height),
                half = parallel ? 0.5f * lens.height : std::tan(glm::radians(0.5f * lens.degrees)), fy = visible / half,
                fx = fy * float(room.height) * float(lens.columns) / float(room.width);
    const float perspective[16] = {fx, 0, 0, 0, 0, -fy, 0, 0, 0, 0, 0, -1, 0, 0, 0.1f, 0},
                orthographic[16] = {fx, 0, 0, 0, 0, -fy, 0, 0, 0, 0, -1e-4f, 0, 0, 0, 0, 1};
    std::memcpy(room.projection, parallel ? orthographic : perspective, sizeof(perspective));
    room.depth.assign(size_t(room.width) * room.height, 1e4f);
    room.normals.assign(room.depth.size() * 4, 0.0f);
    for (uint32_t y = 0; y < room.height; ++y)
        for (uint32_t x = 0; x < room.width; ++x) {
            const auto [right, up] = rayAt(room, float(x) + 0.5f, float(y) + 0.5f);
            const glm::vec3 from = parallel ? glm::vec3(right, up, 0) : glm::vec3(0),
                            along = parallel ? glm::vec3(0, 0, -1) : glm::vec3(right, up, -1);
            Hit nearest, hit;
            for (const Solid& solid : solids)
                if (solid.meets(lens.turn * from, lens.turn * along, hit)) nearest = std::min(nearest, hit);
            const size_t i = size_t(y) * room.width + x;
            if (nearest.front > 200.0f) continue;
            room.depth[i] = nearest.front + lens.away;
            const glm::vec3 n = glm::transpose(lens.turn) * nearest.normal;
            for (int axis = 0; axis < 3; ++axis) room.normals[i * 4 + size_t(axis)] = n[axis];
        }
    voxelizeSolids(room, solids, lens);
    return room;
}

// The world mirrored in an axis.
inline std::vector<Solid> mirrored(std::vector<Solid> solids, int axis) {
    for (Solid& solid : solids) {
        solid.at[axis] = -solid.at[axis];
        if (solid.kind == Solid::Kind::plane) solid.size[axis] = -solid.size[axis];
    }
    return solids;
}
// The same frame upside down: a projection whose y points up in the image.
inline Room upsideDown(Room room) {
    for (uint32_t y = 0; y < room.height / 2; ++y) {
        const auto swapRows = [&](std::vector<float>& texels, size_t each) {
            const size_t row = each * room.width, other = room.height - 1 - y;
            std::swap_ranges(texels.begin() + long(y * row), texels.begin() + long((y + 1) * row), texels.begin() + long(other * row));
        };
        swapRows(room.depth, 1);
        swapRows(room.normals, 4);
    }
    room.projection[5] = -room.projection[5];
    return room;
}
inline Picture mirrored(const Picture& picture, int axis) {
    Picture result(picture.size());
    for (uint32_t y = 0; y < kVisibleHeight; ++y)
        for (uint32_t x = 0; x < kVisibleWidth; ++x)
            result[y * kVisibleWidth + x] =
                picture[(axis == 1 ? kVisibleHeight - 1 - y : y) * kVisibleWidth + (axis == 0 ? kVisibleWidth - 1 - x : x)];
    return result;
}
inline Picture squarePixels(const Picture& picture, uint32_t columns) {
    Picture result(size_t(kVisibleWidth) * kVisibleHeight, 0.0f);
    for (size_t i = 0; i < picture.size(); ++i) result[i / columns] += picture[i] / float(columns);
    return result;
}

// Differences of the means over 4x4 pixels, a tile of the methods' noise, of the blocks whose pixels all count.
struct Apart {
    double most = 0.0, mean = 0.0;
};
inline Apart apart(const Picture& a, const Picture& b, const std::vector<bool>& counts = {}) {
    constexpr uint32_t kBlock = 4;
    Apart result;
    double blocks = 0.0;
    for (uint32_t y = 0; y < kVisibleHeight; y += kBlock)
        for (uint32_t x = 0; x < kVisibleWidth; x += kBlock) {
            double sum = 0.0;
            bool all = true;
            for (uint32_t i = 0; i < kBlock * kBlock; ++i) {
                const size_t at = size_t(y + i / kBlock) * kVisibleWidth + x + i % kBlock;
                sum += (double(a[at]) - double(b[at])) / (kBlock * kBlock);
                all = all && (counts.empty() || counts[at]);
            }
            if (!all) continue;
            result.most = std::max(result.most, std::abs(sum));
            result.mean += std::abs(sum);
            ++blocks;
        }
    EXPECT_GT(blocks, 20.0);
    result.mean /= std::max(blocks, 1.0);
    return result;
}

}  // namespace obscura::test
