// Fixture: triangles and worlds for voxel tests.
#pragma once

#include <cmath>
#include <filesystem>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "../folders.h"
#include "../temporary_folder.h"
#include "scene/gltf/gltf.h"
#include "scene/world.h"
#include "voxel/bricks.h"
#include "voxel/rasterise.h"

namespace obscura::test {

struct Soup {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        for (const glm::vec3& p : {a, b, c}) {
            indices.push_back(uint32_t(positions.size()));
            positions.push_back(p);
        }
    }
    voxel::Triangles triangles() const { return {positions, indices}; }
};

inline Soup randomSoup(size_t count, float spread, float longest, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    Soup soup;
    for (size_t i = 0; i < count; ++i) {
        const glm::vec3 at = spread * vector();
        const float size = longest * std::abs(unit(random) * unit(random));
        soup.add(at, at + size * vector(), at + size * vector());
    }
    return soup;
}

inline std::shared_ptr<scene::Model> modelOf(const Soup& soup) {
    auto model = std::make_shared<scene::Model>();
    model->name = "soup";
    model->materials.resize(1);
    scene::Primitive primitive;
    primitive.positions = soup.positions;
    primitive.indices = soup.indices;
    model->meshes.resize(1);
    model->meshes[0].primitives.push_back(std::move(primitive));
    model->nodes.resize(1);
    model->nodes[0].mesh = 0;
    model->roots = model->order = {0};
    return model;
}

using Cells = std::set<std::array<int, 3>>;
inline Cells cellsOf(const voxel::BrickSet& bricks) {
    Cells cells;
    for (size_t i = 0; i < bricks.size(); ++i)
        for (int x = 0; x < 8; ++x)
            for (int y = 0; y < 8; ++y)
                for (int z = 0; z < 8; ++z)
                    if (bricks[i].test(x, y, z))
                        cells.insert({bricks.place(i).x * 8 + x, bricks.place(i).y * 8 + y, bricks.place(i).z * 8 + z});
    return cells;
}

}  // namespace obscura::test
