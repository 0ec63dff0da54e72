#include "balls.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "app/files.h"
#include "meshkit/glb_writer.h"
#include "meshkit/shapes.h"

namespace obscura::bench {

std::filesystem::path writeBalls(uint64_t triangles, const std::filesystem::path& folder) {
    constexpr int kSide = 8;
    constexpr float kRadius = 0.5f, kSpacing = 1.1f, kHalf = 6.0f;
    // A ball of s segments and s/2 rings has about s^2 triangles.
    const int segments = std::max(4, int(std::lround(std::sqrt(double(triangles) / (kSide * kSide)))));
    kit::Scene scene;
    scene.name = "balls";
    const int material = scene.addMaterial({.name = "plaster"});
    kit::Geometry ball{kit::sphere(kRadius, segments, std::max(2, segments / 2)), {}, {}};
    kit::smoothNormals(ball.mesh, 80.0f);
    kit::Geometry room;
    room.mesh.addFace({-kHalf, 0, kHalf}, {kHalf, 0, kHalf}, {kHalf, 0, -kHalf}, {-kHalf, 0, -kHalf});
    room.mesh.addFace({-kHalf, 0, -kHalf}, {kHalf, 0, -kHalf}, {kHalf, kHalf, -kHalf}, {-kHalf, kHalf, -kHalf});
    kit::smoothNormals(room.mesh);
    const int ballMesh = scene.addMesh("ball", scene.addGeometry(std::move(ball)), {material});
    const int roomMesh = scene.addMesh("room", scene.addGeometry(std::move(room)), {material});
    scene.addNode({.name = "room", .mesh = roomMesh});
    for (int i = 0; i < kSide * kSide; ++i) {
        const glm::vec2 at = kSpacing * (glm::vec2(i % kSide, i / kSide) - 0.5f * (kSide - 1));
        scene.addNode({.name = "ball " + std::to_string(i), .translation = {at.x, kRadius, at.y}, .mesh = ballMesh});
    }
    scene.addCamera({.name = "view"}, {4.0f, 3.5f, 7.5f}, {0.0f, 0.4f, -0.5f});
    std::filesystem::path file = folder / ("balls-" + std::to_string(triangles) + ".glb");
    const std::vector<uint8_t> bytes = kit::writeGlb(scene);
    app::writeFile(file, std::as_bytes(std::span(bytes)));
    return file;
}

}  // namespace obscura::bench
