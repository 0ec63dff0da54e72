// What must come out whatever the sampling: nothing where nothing stands, finite numbers everywhere, the same bytes twice.
#include "layered/solids.h"

namespace obscura::test {
namespace {

using Kind = Solid::Kind;

TEST_F(LayeredTest, whatIsConvexAndAloneIsOpenToTheLastBit) {
    const std::vector<std::vector<Solid>> worlds = {{{Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}},
                                                    {{Kind::plane, {0, -1.5f, 0}, {0.5f, 1, 0.05f}}},
                                                    {{Kind::plane, {0, 0, -6}, {0.5f, 0.3f, 1}}},
                                                    {{Kind::sphere, {0.3f, 0.2f, -4}, {1.2f, 0, 0}}},
                                                    {{Kind::box, {0.4f, -0.7f, -4}, {0.8f, 0.5f, 0.6f}}}};
    for (size_t i = 0; i < worlds.size(); ++i) {
        const Room room = frameOf(worlds[i], 200, 120, 20);
        for (const auto& changes : {Changes{{"steps", 4}}, Changes{{"slices", 3}}, Changes{{"depth_layers", 0}, {"thickness", 1000}}})
            EXPECT_EQ(highest(run(room, values(changes, "quality"), "ramp:0.385:1")), 0.0f) << "world " << i;
    }
}

TEST_F(LayeredTest, everySizeAndSkyGiveFiniteValues) {
    const std::vector<Solid> world = {{Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}, {Kind::cylinder, {0.2f, 0, -2}, {0.1f, 0, 0}}};
    for (const auto& [width, height, guard] : {std::tuple{8u, 8u, 0u}, {9u, 13u, 0u}, {37u, 21u, 4u}, {64u, 40u, 7u}})
        for (const bool half : {false, true})
            for (const char* preset : {"default", "fast", "reference"}) {
                const Room room = frameOf(world, width, height, guard, half);
                for (const float a : run(room, values({}, preset), "exponential:1")) EXPECT_TRUE(a >= 0.0f && a <= 1.0f) << width << "x" << height << " " << preset;
            }
    Room sky = frameOf({}, 32, 24, 2);
    EXPECT_EQ(highest(run(sky, values({}), "quadratic:2")), 0.0f);
}

TEST_F(LayeredTest, theSameFrameTwiceIsTheSame) {
    const Room room = frameOf({{Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}, {Kind::box, {0.4f, -1.0f, -4}, {0.8f, 0.5f, 0.6f}}}, 200, 120, 20);
    EXPECT_EQ(run(room, values({}), "ramp:0.385:1"), run(room, values({}), "ramp:0.385:1"));
}

TEST_F(LayeredTest, layersThatAreMissingAreDoneWithout) {
    const std::vector<Solid> world = {{Kind::plane, {0, 0, -5}, {0, 0, 1}}, {Kind::box, {0, 0, -4.5f}, {0.4f, 2, 0.05f}}};
    const Room both = frameOf(world, 200, 120, 20);
    Room first = both, none = both;
    first.second.clear();
    none.second.clear();
    none.thickness.clear();
    const Picture one = run(first, values({}), "ramp:0.385:1"), bare = run(none, values({}), "ramp:0.385:1");
    EXPECT_EQ(one, run(both, values({{"depth_layers", float(ao::LayerUse::first)}}), "ramp:0.385:1"));
    EXPECT_EQ(bare, run(both, values({{"depth_layers", 0}}), "ramp:0.385:1"));
    EXPECT_NE(one, bare);
    // What is thicker than the reach is as good as endless: nothing depends on what the layers would have said.
    EXPECT_GT(mean(run(none, values({{"thickness", 1000}}), "ramp:0.385:1")), mean(one));
}

}  // namespace
}  // namespace obscura::test
