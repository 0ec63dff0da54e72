// Depth layers: solids in front of a background, against ray-traced obscurance.
#include "ao/solids.h"
#include "far_field/fixture.h"

namespace obscura::test {
namespace {

using Kind = Solid::Kind;
constexpr const char* kFalloff = "exponential:1";
const Solid kFloor{Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}, kWall{Kind::plane, {0, 0, -8}, {0, 0, 1}};

class FarFieldLayers : public FarFieldTest {
protected:
    // Mean error against rays in the world, over every third visible pixel on both axes for which `counts` holds.
    template <class Counts> double error(const std::vector<Solid>& world, const ao::Values& values, Counts counts) {
        const Room room = frameOf(world, 384, 216, 32);
        const Picture picture = run(room, values, kFalloff);
        ao::Falloff rho;
        EXPECT_TRUE(ao::parseFalloff(kFalloff, rho));
        double sum = 0.0;
        int pixels = 0;
        for (uint32_t y = 0; y < room.visibleHeight(); y += 3)
            for (uint32_t x = 0; x < room.visibleWidth(); x += 3) {
                const size_t i = size_t(y + room.guard) * room.width + x + room.guard;
                const glm::vec3 p = pointAt(room, x + room.guard, y + room.guard),
                                n(room.normals[4 * i], room.normals[4 * i + 1], room.normals[4 * i + 2]);
                if (room.depth[i] > 100.0f || !counts(p, n)) continue;
                sum += std::abs(double(picture[size_t(y) * room.visibleWidth() + x]) - worldObscurance(world, p, n, rho, 512));
                ++pixels;
            }
        EXPECT_GT(pixels, 60);
        return sum / pixels;
    }
    ao::Values layers(ao::LayerMode use) const { return values({{"depth_layers", float(use)}}, "layers"); }
};

constexpr auto kAll = [](const glm::vec3&, const glm::vec3&) { return true; };
constexpr auto kNearPillar = [](const glm::vec3& p, const glm::vec3& n) {
    return n.z > 0.9f && std::abs(p.x) < 0.8f && std::abs(p.y) < 1.5f;
};

// The obscurance is 0.044; the tolerance is a quarter of it. Round solids obscure too much, since the corners of segments lie outside them.
TEST_F(FarFieldLayers, pillarDoesNotHideTheWallBeside) {
    const std::vector<Solid> world{kWall, {Kind::cylinder, {0, 0, -7.4f}, {0.1f, 0, 0}}};
    EXPECT_GT(error(world, values({}), kNearPillar), 0.09);
    EXPECT_LE(error(world, layers(ao::LayerMode::first), kNearPillar), 0.013);
    EXPECT_LE(error(world, layers(ao::LayerMode::second), kNearPillar), 0.013);
}

TEST_F(FarFieldLayers, floatingBoxMatchesTheReference) {
    const std::vector<Solid> world{kFloor, kWall, {Kind::box, {0, -0.5f, -6}, {0.5f, 0.5f, 0.4f}}};
    EXPECT_GT(error(world, values({}), kAll), 0.006);
    EXPECT_LE(error(world, layers(ao::LayerMode::first), kAll), 0.0032);
    EXPECT_LE(error(world, layers(ao::LayerMode::second), kAll), 0.003);
}

// Floor and wall are boxes as well: the scene consists of finite solids that touch each other.
TEST_F(FarFieldLayers, touchingSlabsMatchTheReference) {
    const std::vector<Solid> world{{Kind::box, {0, -1.7f, -5}, {20, 0.2f, 20}}, {Kind::box, {0, 0, -8.2f}, {20, 20, 0.2f}},
        {Kind::box, {0, -1.0f, -6}, {0.5f, 0.5f, 0.4f}}};
    EXPECT_LE(error(world, layers(ao::LayerMode::second), kAll), 0.004);
}

// Bars 1 px wide with gaps of 1 px in front of a wall block half as much as a board in their place.
TEST_F(FarFieldLayers, halfCoverageBlocksHalf) {
    Room empty = crease(), board = empty, bars = empty;
    for (Room* room : {&empty, &board, &bars}) {
        room->thickness.assign(room->depth.size(), 65504.0f);
        room->second.assign(room->depth.size() * 2, 0.0f);
    }
    for (uint32_t y = 40; y < 120; ++y)
        for (uint32_t x = 0; x < empty.width; ++x) {
            const size_t i = size_t(y) * empty.width + x;
            if (empty.normals[4 * i + 1] > 0.5f) continue;
            const auto put = [&](Room& room) {
                room.second[2 * i] = room.depth[i];
                room.second[2 * i + 1] = 65504.0f;
                room.depth[i] = 2.0f;
                room.thickness[i] = 0.02f;
                for (int c = 0; c < 3; ++c) room.normals[4 * i + size_t(c)] = c == 2 ? 1.0f : 0.0f;
            };
            put(board);
            if (x % 2 == 0) put(bars);
        }
    const auto onFloor = [&](const Room& room) {
        const Picture picture = run(room, layers(ao::LayerMode::second), kFalloff);
        double sum = 0.0;
        const uint32_t width = room.visibleWidth(), y = room.visibleHeight() - 30;
        for (uint32_t x = width / 4; x < 3 * width / 4; ++x) sum += picture[size_t(y) * width + x];
        return sum / (width / 2);
    };
    const double none = onFloor(empty), all = onFloor(board), half = onFloor(bars);
    EXPECT_GT(all, none + 0.015);
    EXPECT_NEAR(half, 0.5 * (none + all), 0.1 * (all - none));
}

TEST_F(FarFieldLayers, withoutRequestNothingChanges) {
    Room room = frameOf({kFloor, kWall, {Kind::box, {0, -1.0f, -6}, {0.5f, 0.5f, 0.4f}}}, 192, 108, 16), bare = room;
    bare.thickness.clear();
    bare.second.clear();
    for (const char* preset : {"default", "paper_16x2", "fast", "thin"})
        EXPECT_EQ(run(room, values({}, preset), kFalloff), run(bare, values({}, preset), kFalloff)) << preset;
    EXPECT_EQ(run(bare, layers(ao::LayerMode::second), kFalloff), run(bare, layers(ao::LayerMode::none), kFalloff));
    // Settings that do not read depth layers ignore the parameter.
    for (const Changes& other :
        {Changes{{"averaging", 1}}, Changes{{"averaging", 3}}, Changes{{"thickness", 0.5f}}, Changes{{"interleave", 2}}}) {
        Changes asked = other;
        asked.push_back({"depth_layers", float(ao::LayerMode::second)});
        EXPECT_EQ(run(room, values(asked), kFalloff), run(room, values(other), kFalloff)) << other[0].id;
    }
    EXPECT_NE(run(room, layers(ao::LayerMode::second), kFalloff), run(room, layers(ao::LayerMode::none), kFalloff));
}

TEST_F(FarFieldLayers, withoutFiniteSolidsLayersChangeNothing) {
    const Room room = frameOf({kFloor, kWall}, 192, 108, 16);
    const Picture one = run(room, layers(ao::LayerMode::none), kFalloff), two = run(room, layers(ao::LayerMode::second), kFalloff);
    for (size_t i = 0; i < one.size(); ++i) ASSERT_NEAR(one[i], two[i], 0.001) << i;
    EXPECT_GT(mean(one), 0.02);
}

TEST_F(FarFieldLayers, sameFrameTwiceIsBitIdenticalAndFinite) {
    const std::vector<Solid> world{kFloor, {Kind::sphere, {0, -0.5f, -6}, {0.5f, 0, 0}}, {Kind::cylinder, {1, 0, -7}, {0.1f, 0, 0}}};
    for (const auto& [width, height, guard, half] :
        {std::tuple{192u, 108u, 16u, false}, {191u, 107u, 16u, true}, {8u, 8u, 0u, false}, {9u, 40u, 0u, true}}) {
        const Room room = frameOf(world, width, height, guard, half);
        const Picture picture = run(room, layers(ao::LayerMode::second), kFalloff);
        EXPECT_TRUE(finite(picture)) << width;
        EXPECT_EQ(picture, run(room, layers(ao::LayerMode::second), kFalloff)) << width;
    }
}

}  // namespace
}  // namespace obscura::test
