// Helpers of the tests of generated content.
#include "content_helpers.h"

#include "atrium/atrium_scene.h"
#include "toasters/toaster_scene.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <tuple>

namespace obscura::content {

const kit::Scene& toasters() {
    static const kit::Scene scene = obscura::toasters::buildScene();
    return scene;
}

const kit::Scene& atrium() {
    static const kit::Scene scene = obscura::atrium::buildScene();
    return scene;
}

int openEdges(const kit::Mesh& mesh, std::uint32_t ignoredMaterial) {
    using Point = std::tuple<long, long, long>;
    const auto pointAt = [&](std::uint32_t index) {
        constexpr float kCellsPerMetre = 20000.0f;
        const glm::vec3 p = mesh.vertices[index].position * kCellsPerMetre;
        return Point{std::lround(p.x), std::lround(p.y), std::lround(p.z)};
    };
    std::map<std::pair<Point, Point>, int> balance;
    for (const kit::Triangle& triangle : mesh.triangles) {
        if (triangle.material == ignoredMaterial) continue;
        for (int i = 0; i < 3; ++i) {
            const Point a = pointAt(triangle.corner[i]);
            const Point b = pointAt(triangle.corner[(i + 1) % 3]);
            if (a < b) ++balance[{a, b}];
            else if (b < a) --balance[{b, a}];
        }
    }
    int open = 0;
    for (const auto& [edge, sum] : balance) open += std::abs(sum);
    return open;
}

}  // namespace obscura::content
