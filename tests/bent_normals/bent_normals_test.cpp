// Bent normals of every method that gives them: open planes keep their normal, a wall turns them away by the analytic angle, a corner and
// a small scene agree with ray tracing, a mirrored world gives mirrored bent normals, and asking for them leaves visibility as it is.
#include "properties/picture.h"

namespace obscura::test {
namespace {

using Kind = Solid::Kind;

float degreesBetween(const glm::vec3& a, const glm::vec3& b) {
    return glm::degrees(std::acos(glm::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0f, 1.0f)));
}

// The mean direction of unblocked light at a point, by cosine-weighted rays. At most as many metres off the surface as worldObscurance().
glm::vec3 worldBent(const std::vector<Solid>& solids, const glm::vec3& p, const glm::vec3& n, const ao::Falloff& rho, int rays) {
    const glm::vec3 t = glm::normalize(glm::cross(n, std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0))), b = glm::cross(n, t);
    glm::vec3 sum(0.0f);
    for (int i = 0; i < rays; ++i) {
        const float u = (float(i) + 0.5f) / float(rays), phi = 6.2831853f * std::fmod(float(i) * 0.61803399f, 1.0f), r = std::sqrt(u);
        const glm::vec3 d = r * std::cos(phi) * t + r * std::sin(phi) * b + std::sqrt(1.0f - u) * n;
        float nearest = std::numeric_limits<float>::infinity();
        Hit hit;
        for (const Solid& solid : solids)
            if (solid.meets(p + 1e-4f * n, d, hit)) nearest = std::min(nearest, hit.front);
        sum += (nearest < 1e30f ? 1.0f - ao::evaluate(rho, nearest) : 1.0f) * d;
    }
    return sum;
}

struct Row {
    const char *method, *preset;
    float plane;          // degrees, most off the normal of an open plane
    float wall;           // degrees, off the mean direction beside a wall
    float corner;         // degrees, mean, in a corner of three walls
    float scene;          // degrees, mean, of solids on a floor
    float mirror;         // degrees, mean, between the bent normals of a world and its mirror image
    bool layers = false;  // with the parameter depth_layers
};
constexpr Row kRows[] = {
    {"gtao", "default", 4.0f, 6.0f, 2.3f, 2.5f, 0.5f},  // the published horizon obscures bare planes: the nearest texels raise it
    {"gtao", "tuned", 1.3f, 5.5f, 2.7f, 2.8f, 0.5f},
    {"visibility_bitmask", "default", 2.5f, 9.5f, 3.5f, 3.2f, 0.5f},
    {"visibility_bitmask", "tuned", 2.0f, 4.0f, 2.7f, 2.7f, 0.5f},
    {"gtao", "tuned", 1.3f, 4.0f, 2.7f, 2.7f, 0.5f, true},
    {"layered", "default", 1.3f, 3.0f, 1.0f, 1.2f, 0.3f},
    {"layered", "low", 1.3f, 8.0f, 1.5f, 1.2f, 0.9f},  // a map of 3x3 pixels
    {"hybrid", "default", 1.3f, 10.0f, 3.2f, 3.6f, 2.0f},
    {"hybrid", "quality", 1.3f, 5.5f, 1.0f, 1.7f, 0.3f},
    {"hbao", "default", 2.3f, 3.5f, 2.4f, 2.3f, 0.3f},
    {"hbao", "tuned", 2.3f, 4.2f, 1.4f, 1.9f, 0.3f},
    {"hbao", "tuned", 2.3f, 4.5f, 1.5f, 1.6f, 0.3f, true},
    {"horizon_split", "default", 1.3f, 3.0f, 0.8f, 1.6f, 0.4f},
    {"horizon_split", "quality", 1.3f, 3.0f, 0.8f, 1.6f, 0.3f},
    {"horizon_split", "default", 1.3f, 3.0f, 0.8f, 1.4f, 0.5f, true},
    {"gtao", "half", 4.0f, 8.0f, 3.5f, 3.5f, 1.0f},
    {"layered", "half", 1.3f, 6.0f, 2.0f, 2.0f, 1.0f},
    {"hybrid", "half", 1.3f, 12.0f, 5.5f, 5.0f, 3.0f},
    {"horizon_split", "paper_fast", 1.3f, 6.5f, 1.8f, 2.3f, 0.3f},
};

std::vector<Solid> corner() {
    return {{Kind::plane, {0, -1.2f, 0}, {0, 1, 0}}, {Kind::plane, {0, 0, -4}, {0, 0, 1}}, {Kind::plane, {1.2f, 0, 0}, {-1, 0, 0}}};
}
std::vector<Solid> solidsOnAFloor() {
    return {{Kind::plane, {0, -1.2f, 0}, {0, 1, 0}}, {Kind::sphere, {-0.8f, -0.6f, -3.2f}, {0.6f, 0, 0}},
        {Kind::box, {0.9f, -0.8f, -3.4f}, {0.4f, 0.4f, 0.4f}}, {Kind::plane, {0, 0, -5}, {0, 0, 1}}};
}

Lens down(float height = 0.0f) {  // by 40 degrees, so that rows of pixels are near each other on a floor
    Lens lens;
    lens.height = height;
    const float c = std::cos(0.7f), s = std::sin(0.7f);
    lens.turn = glm::mat3(glm::vec3(1, 0, 0), glm::vec3(0, c, -s), glm::vec3(0, s, c));
    return lens;
}

Room withLayers(Room room, const std::vector<Solid>& world, const Lens& lens) {  // thickness of what seen() shows
    room.thickness.assign(room.depth.size(), 0.0f);
    for (uint32_t y = 0; y < room.height; ++y)
        for (uint32_t x = 0; x < room.width; ++x) {
            const auto [right, up] = rayAt(room, float(x) + 0.5f, float(y) + 0.5f);
            const bool parallel = lens.height > 0.0f;
            Hit nearest, hit;
            for (const Solid& solid : world)
                if (solid.meets(lens.turn * (parallel ? glm::vec3(right, up, 0) : glm::vec3(0)),
                        lens.turn * (parallel ? glm::vec3(0, 0, -1) : glm::vec3(right, up, -1)), hit))
                    nearest = std::min(nearest, hit);
            if (nearest.front < 1e30f) room.thickness[size_t(y) * room.width + x] = std::min(nearest.back - nearest.front, 65504.0f);
        }
    return room;
}

class BentNormals : public MethodTest {
protected:
    BentNormals() : MethodTest("gtao") {}

    // Per visible pixel; 0 for sky.
    std::vector<glm::vec3> bent(const Row& row, const Room& room, const char* falloff) {
        m_method = row.method;
        ao::Values asked = values(row.layers ? Changes{{"depth_layers", 1}} : Changes{}, row.preset);
        asked.bentNormals = true;
        run(room, asked, falloff);
        std::vector<glm::vec3> result;
        for (const auto& texel : m_bent) result.push_back({texel[0], texel[1], texel[2]});
        return result;
    }
    // Mean degrees between a picture's bent normals and ray tracing, of every `step`th pixel whose visibility is below `below`.
    double meanAngle(const Row& row, const std::vector<Solid>& world, const Lens& lens, const char* falloff, uint32_t step) {
        ao::Falloff rho;
        EXPECT_TRUE(ao::parseFalloff(falloff, rho));
        const Room room = withLayers(seen(world, lens), world, lens);
        const std::vector<glm::vec3> found = bent(row, room, falloff);
        double sum = 0.0, count = 0.0;
        for (uint32_t y = 2; y < room.visibleHeight(); y += step)
            for (uint32_t x = 2; x < room.visibleWidth(); x += step) {
                const size_t i = size_t(y + room.guard) * room.width + x + room.guard;
                if (room.depth[i] > 200.0f) continue;
                const auto [right, up] = rayAt(room, float(x + room.guard) + 0.5f, float(y + room.guard) + 0.5f);
                const glm::vec3 p = lens.height > 0.0f ? glm::vec3(right, up, -room.depth[i]) : room.depth[i] * glm::vec3(right, up, -1);
                const glm::vec3 n(room.normals[4 * i], room.normals[4 * i + 1], room.normals[4 * i + 2]);
                sum += degreesBetween(
                    lens.turn * found[size_t(y) * room.visibleWidth() + x], worldBent(world, lens.turn * p, lens.turn * n, rho, 256));
                count += 1.0;
            }
        EXPECT_GT(count, 50.0);
        return sum / count;
    }
};

TEST_F(BentNormals, openPlanesKeepTheirNormal) {
    for (const Row& row : kRows)
        for (const Lens& lens : {Lens{}, Lens{.height = 6.0f}, Lens{.columns = 2}})
            for (const std::vector<Solid>& world : planeWorlds()) {
                const Room room = withLayers(seen(world, lens), world, lens);
                const std::vector<glm::vec3> found = bent(row, room, "quadratic:1");
                double most = 0.0;
                size_t sky = 0;
                for (uint32_t y = 0; y < room.visibleHeight(); ++y)
                    for (uint32_t x = 0; x < room.visibleWidth(); ++x) {
                        const size_t i = size_t(y + room.guard) * room.width + x + room.guard, at = size_t(y) * room.visibleWidth() + x;
                        if (room.depth[i] > 200.0f) {
                            EXPECT_EQ(m_bent[at], (std::array<float, 4>{0, 0, 0, 1})) << row.method;
                            ++sky;
                            continue;
                        }
                        const glm::vec3 n(room.normals[4 * i], room.normals[4 * i + 1], room.normals[4 * i + 2]);
                        most = std::max(most, double(degreesBetween(found[at], n)));
                    }
                EXPECT_LT(most, row.plane) << row.method << " " << row.preset << " of height " << lens.height;
                EXPECT_TRUE(sky < found.size() || lens.height > 0.0f) << "a parallel view along a floor shows none";
            }
}

// A floor point at a wall without end sees a quarter sphere, whose cosine-weighted mean direction is atan(2/pi) off the normal. One that is
// not quite at the wall, with occluders that count up to 1.5 m, is compared with rays.
TEST_F(BentNormals, aWallTurnsThemAway) {
    const std::vector<Solid> world = floorAndWall();
    ao::Falloff endless, rho;
    ASSERT_TRUE(ao::parseFalloff("constant:1000", endless));
    EXPECT_NEAR(degreesBetween(worldBent(world, {0, -1.4999f, -4.9999f}, {0, 1, 0}, endless, 4096), {0, 1, 0}),
        glm::degrees(std::atan(2.0f / 3.14159265f)), 0.5f);
    ASSERT_TRUE(ao::parseFalloff("quadratic:1.5", rho));
    const Lens lens = down();
    const Room room = withLayers(seen(world, lens), world, lens);
    for (const Row& row : kRows) {
        const std::vector<glm::vec3> found = bent(row, room, "quadratic:1.5");
        int rows = 0;
        double most = 0.0;
        for (uint32_t y = room.guard; y < room.height - room.guard; ++y) {
            const glm::vec3 p = lens.turn * pointAt(room, room.width / 2, y);
            if (p.y > -1.49f || p.z < -4.85f || p.z > -3.8f) continue;
            glm::vec3 mean(0.0f);
            for (uint32_t x = room.width / 2 - 8; x < room.width / 2 + 8; ++x)
                mean += lens.turn * found[size_t(y - room.guard) * room.visibleWidth() + x - room.guard];
            most = std::max(most, double(degreesBetween(mean, worldBent(world, p, {0, 1, 0}, rho, 1024))));
            EXPECT_GT(mean.z, 0.0f) << "towards the camera, away from the wall";
            ++rows;
        }
        EXPECT_LT(most, row.wall) << row.method << " " << row.preset;
        std::printf("%s %s: wall %.2f degrees at most over %d rows\n", row.method, row.preset, most, rows);
        EXPECT_GE(rows, 4);
    }
}

TEST_F(BentNormals, cornerAndSceneAgreeWithRays) {
    for (const Row& row : kRows) {
        const double inCorner = meanAngle(row, corner(), {}, "quadratic:1", 5),
                     inScene = meanAngle(row, solidsOnAFloor(), {}, "quadratic:1", 5),
                     parallel = meanAngle(row, solidsOnAFloor(), down(4.0f), "quadratic:1", 5);
        EXPECT_LT(inCorner, row.corner) << row.method << " " << row.preset;
        EXPECT_LT(inScene, row.scene) << row.method << " " << row.preset;
        EXPECT_LT(parallel, row.scene) << row.method << " " << row.preset << ", orthographic";
        std::printf("%s %s: corner %.2f, scene %.2f, orthographic %.2f degrees\n", row.method, row.preset, inCorner, inScene, parallel);
    }
}

// Bent normals of the mirrored world, mirrored back, averaged over the tiles of the methods' noise.
TEST_F(BentNormals, mirroredWorldsGiveMirroredBentNormals) {
    for (const Row& row : kRows)
        for (int axis = 0; axis < 2; ++axis) {
            const std::vector<Solid> world = solidsOnAFloor(), image = mirrored(world, axis);
            const std::vector<glm::vec3> a = bent(row, withLayers(seen(world, {}), world, {}), "quadratic:1"),
                                         b = bent(row, withLayers(seen(image, {}), image, {}), "quadratic:1");
            double sum = 0.0, count = 0.0;
            for (uint32_t y = 0; y < kVisibleHeight; y += 4)
                for (uint32_t x = 0; x < kVisibleWidth; x += 4) {
                    glm::vec3 here(0.0f), there(0.0f);
                    for (uint32_t i = 0; i < 16; ++i) {
                        const uint32_t u = x + i % 4, v = y + i / 4;
                        here += a[size_t(v) * kVisibleWidth + u];
                        there +=
                            b[size_t(axis == 1 ? kVisibleHeight - 1 - v : v) * kVisibleWidth + (axis == 0 ? kVisibleWidth - 1 - u : u)];
                    }
                    there[axis] = -there[axis];
                    if (glm::length(here) < 1.0f) continue;  // sky
                    sum += degreesBetween(here, there);
                    count += 1.0;
                }
            EXPECT_LT(sum / count, row.mirror) << row.method << " " << row.preset << " axis " << axis;
            std::printf("%s %s axis %d: %.2f degrees\n", row.method, row.preset, axis, sum / count);
        }
}

TEST_F(BentNormals, askingForThemLeavesVisibility) {
    const Room room = withLayers(seen(solidsOnAFloor(), {}), solidsOnAFloor(), {});
    for (const Row& row : kRows) {
        m_method = row.method;
        ao::Values asked = values(row.layers ? Changes{{"depth_layers", 1}} : Changes{}, row.preset);
        const Picture without = run(room, asked, "quadratic:1");
        EXPECT_FALSE(m_passes.contains("bent normals"));
        asked.bentNormals = true;
        const Picture with = run(room, asked, "quadratic:1");
        EXPECT_EQ(with, without) << row.method << " " << row.preset;
        const auto first = m_bent;
        run(room, asked, "quadratic:1");
        EXPECT_EQ(m_bent, first) << "the same frame twice";
        for (size_t i = 0; i < with.size(); ++i) ASSERT_NEAR(m_bent[i][3], 1.0f - with[i], 0.5f / 127.0f + 1e-3f);
        asked.set("intensity", 0.5f);  // w is the visibility that is handed out
        const Picture halved = run(room, asked, "quadratic:1");
        for (size_t i = 0; i < halved.size(); ++i) ASSERT_NEAR(m_bent[i][3], 1.0f - halved[i], 0.5f / 127.0f + 1e-3f);
    }
}

TEST_F(BentNormals, everyMethodWithThemHasARow) {
    for (const ao::MethodInfo* info : ao::methods()) {
        const bool hasRow =
            std::any_of(std::begin(kRows), std::end(kRows), [&](const Row& row) { return std::string(row.method) == info->id; });
        EXPECT_EQ(hasRow, info->bentNormals) << info->id;
    }
    for (const ao::MethodEntry& entry : ao::registry()) EXPECT_EQ(entry.createBent != nullptr, entry.info->bentNormals) << entry.info->id;
}

}  // namespace
}  // namespace obscura::test
