// Properties of `layered` that do not depend on sampling: convex solids are open, values are finite, results are deterministic.
#include "layered/fixture.h"

namespace obscura::test {
namespace {

using Kind = Solid::Kind;

TEST_F(LayeredTest, convexSolidsAreExactlyOpen) {
    const auto worlds = convexWorlds();
    for (size_t i = 0; i < worlds.size(); ++i) {
        const Room room = frameOf(worlds[i], 200, 120, 20);
        for (const auto& changes : {Changes{{"steps", 4}}, Changes{{"slices", 3}}, Changes{{"depth_layers", 0}, {"thickness", 1000}}})
            EXPECT_EQ(highest(run(room, values(changes, "ultra"), "ramp:0.385:1")), 0.0f) << "world " << i;
    }
}

TEST_F(LayeredTest, slicesCoverTheHemisphere) {
    // Slices are uniform around the view ray; directions uniform on the screen would have a mean error of 0.034 here.
    const Room room = frameOf({{Kind::plane, {0, -1.5f, 0}, {0.3f, 1, 0.05f}}}, 200, 120, 20);
    m_probe = "layered.shares";
    for (const auto& [slices, tolerance] :
        {std::pair{16.0f, 0.004f}, {9.0f, 0.011f}}) {  // plus half a quantization step of the stored value
        run(room, values({{"slices", slices}, {"steps", 1}}, "reference"), "ramp:0.385:1");
        for (uint32_t y = 0; y < m_probed.height; ++y)
            for (uint32_t x = 0; x < m_probed.width; ++x) {
                const size_t i = size_t(y + room.guard) * room.width + x + room.guard;
                if (room.depth[i] > 100.0f) continue;
                const float whole = glm::unpackHalf2x16(m_probed.at(x, y, 1)).y;
                ASSERT_NEAR(whole, 1.0f, tolerance + 0.0005f) << slices << " slices at " << x << ", " << y;
            }
    }
}

TEST_F(LayeredTest, interleavingShowsNoTile) {
    // Along a row of the floor the distance to the wall is constant, so the interleaving tile must not show.
    const Room room = frameOf(floorAndWall(), 384, 216, 32);
    for (const float side : {1.0f, 2.0f, 3.0f}) {
        const Picture picture = run(room, values({{"interleave", side}, {"slices", 16}, {"map", 1}}), "ramp:0.385:1");
        double change = 0.0, dark = 0.0;
        int count = 0;
        for (uint32_t y = 0; y < room.visibleHeight(); ++y)
            for (uint32_t x = 120; x < 200; ++x) {
                const size_t i = size_t(y) * room.visibleWidth() + x;
                if (room.normals[4 * (size_t(y + room.guard) * room.width + x + room.guard) + 1] < 0.5f || picture[i] < 0.02f) continue;
                change += std::abs(picture[i + 1] - picture[i]);
                dark += picture[i];
                ++count;
            }
        ASSERT_GT(count, 200);
        EXPECT_LT(change / count, 0.005 * dark / count) << side + 1.0f << " pixels a side";
    }
}

TEST_F(LayeredTest, everySizeAndSkyGiveValidObscurance) {
    const std::vector<Solid> world = {{Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}, {Kind::cylinder, {0.2f, 0, -2}, {0.1f, 0, 0}}};
    for (const auto& [width, height, guard] : {std::tuple{8u, 8u, 0u}, {9u, 13u, 0u}, {37u, 21u, 4u}, {64u, 40u, 7u}})
        for (const bool half : {false, true})
            for (const char* preset : {"default", "low", "medium", "high", "ultra", "reference"}) {
                const Room room = frameOf(world, width, height, guard, half);
                for (const float a : run(room, values({}, preset), "exponential:1"))
                    EXPECT_TRUE(a >= 0.0f && a <= 1.0f) << width << "x" << height << " " << preset;
            }
    Room sky = frameOf({}, 32, 24, 2);
    EXPECT_EQ(highest(run(sky, values({}), "quadratic:2")), 0.0f);
}

TEST_F(LayeredTest, reducedMapMatchesFullResolution) {
    // Along a row of the floor the distance to the wall is constant: rows must be even, without steps between pixels of the map.
    const Room room = frameOf(floorAndWall(), 383, 215, 32);  // the last pixels of the map cover fewer pixels
    const Picture all = run(room, values({{"slices", 16}, {"interleave", 3}, {"map", 1}}), "linear:3");
    for (const float map : {2.0f, 3.0f}) {
        const Picture some = run(room, values({{"slices", 16}, {"interleave", 3}, {"map", map}}), "linear:3");
        EXPECT_TRUE(m_passes.count("layered.upsample"));
        int rows = 0;
        for (uint32_t y = 0; y < room.visibleHeight(); ++y) {
            const uint32_t first = 120, end = 200;
            const size_t row = size_t(y) * room.visibleWidth();
            const auto normalAt = [&](int there) {
                return room.normals[4 * (size_t(int(y + room.guard) + there) * room.width + first + room.guard) + 1];
            };
            if (normalAt(0) < 0.5f || normalAt(-12) < 0.5f || all[row + first] < 0.02f) continue;  // a tile away from the edge
            double dark = 0.0, apart = 0.0, change = 0.0;
            for (uint32_t x = first; x < end; ++x) {
                dark += all[row + x];
                apart += some[row + x] - all[row + x];
                change += std::abs(some[row + x + 1] - some[row + x]);
            }
            // Obscurance falls by 1/8 per row, so a mean over more rows is darker: by half of (1/8)^2 times the variance of the rows.
            EXPECT_NEAR(apart / dark, map == 2.0f ? 0.04 : 0.09, 0.03) << map << ", row " << y;
            EXPECT_LT(change, 0.01 * dark) << map << ", row " << y;
            ++rows;
        }
        EXPECT_GT(rows, 8);
    }
}

TEST_F(LayeredTest, sameFrameTwiceIsBitIdentical) {
    const Room room = frameOf({{Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}, {Kind::box, {0.4f, -1.0f, -4}, {0.8f, 0.5f, 0.6f}}}, 200, 120, 20);
    EXPECT_EQ(run(room, values({}), "ramp:0.385:1"), run(room, values({}), "ramp:0.385:1"));
}

TEST_F(LayeredTest, missingLayersAreIgnored) {
    const std::vector<Solid> world = {{Kind::plane, {0, 0, -5}, {0, 0, 1}}, {Kind::box, {0, 0, -4.5f}, {0.4f, 2, 0.05f}}};
    const Room both = frameOf(world, 200, 120, 20);
    Room first = both, none = both;
    first.second.clear();
    none.second.clear();
    none.thickness.clear();
    const ao::Values two = values({{"depth_layers", float(ao::LayerMode::second)}});
    const Picture one = run(first, two, "ramp:0.385:1"), bare = run(none, two, "ramp:0.385:1");
    EXPECT_EQ(one, run(both, values({{"depth_layers", float(ao::LayerMode::first)}}), "ramp:0.385:1"));
    EXPECT_EQ(bare, run(both, values({{"depth_layers", 0}}), "ramp:0.385:1"));
    EXPECT_NE(one, bare);
    // A thickness beyond the reach is infinite, so missing layers do not matter.
    EXPECT_GT(mean(run(none, values({{"thickness", 1000}}), "ramp:0.385:1")), mean(one));
}

}  // namespace
}  // namespace obscura::test
