// Nodes and instances: matrices, mirroring, subtrees, animation.
#include <gtest/gtest.h>

#include "gltf_builder.h"
#include "scene/world.h"

namespace obscura::scene::test {
namespace {

TEST(Node, MatrixIsDecomposedWhenItCanBe) {
    GltfBuilder b;
    b.triangle();
    // Mirrored in x, scaled by 2, 3, 4, moved.
    b.json["nodes"][0]["matrix"] = {-2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1};
    const auto model = b.load();
    EXPECT_FALSE(model->nodes[0].hasMatrix);
    EXPECT_EQ(model->nodes[0].translation, glm::vec3(5, 6, 7));
    const glm::mat4 world = evaluate(*model, -1, 0).world[0];
    EXPECT_NEAR(world[0].x, -2, 1e-5);
    EXPECT_NEAR(world[1].y, 3, 1e-5);
    EXPECT_NEAR(world[2].z, 4, 1e-5);
}

TEST(Node, ShearStaysAMatrix) {
    GltfBuilder b;
    b.triangle();
    b.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const auto model = b.load();
    EXPECT_TRUE(model->nodes[0].hasMatrix);
    EXPECT_EQ(evaluate(*model, -1, 0).world[0][1], glm::vec4(0.5f, 1, 0, 0));
}

TEST(Node, ParentsComeFirst) {
    GltfBuilder b;
    b.triangle();
    b.json["nodes"] = {{{"mesh", 0}, {"translation", {1, 0, 0}}}, {{"children", {2, 0}}, {"scale", {2, 2, 2}}}, Json::object()};
    b.json["scenes"][0]["nodes"] = {1};
    const auto model = b.load();
    EXPECT_EQ(model->order, (std::vector<int>{1, 2, 0}));
    EXPECT_EQ(model->nodes[0].parent, 1);
    EXPECT_EQ(evaluate(*model, -1, 0).world[0][3], glm::vec4(2, 0, 0, 1));
}

TEST(World, NegativeScaleIsFlipped) {
    GltfBuilder b;
    b.triangle();
    b.json["nodes"][0]["scale"] = {1, -1, 1};
    World world;
    world.add({b.load()});
    EXPECT_TRUE(pose(world, 0)[0].flipped);
    EXPECT_EQ(pose(world, 0)[0].positions[2], glm::vec3(0, -1, 0));
    world.instances()[0].placement[0][0] = -1.0f;
    EXPECT_FALSE(pose(world, 0)[0].flipped) << "mirrored twice is not mirrored";
}

TEST(World, InstancesHaveTheirOwnIdsTimesAndPlacements) {
    GltfBuilder b;
    b.triangle();
    b.json["nodes"].push_back({{"mesh", 0}});
    b.json["scenes"][0]["nodes"] = {0, 1};
    b.json["animations"] = {{{"samplers", {{{"input", b.scalars({0, 2})}, {"output", b.vec3({0, 0, 0, 2, 0, 0})}}}},
        {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    const auto model = b.load();
    World world;
    const uint32_t first = world.add({model});
    Instance late{model};
    late.timeOffset = 1.0f;
    late.placement[3] = glm::vec4(0, 10, 0, 1);
    late.root = 0;
    const uint32_t second = world.add(late);
    EXPECT_TRUE(first != 0 && second != 0 && first != second);
    EXPECT_EQ(world.triangleCount(), 3u);
    EXPECT_EQ(world.duration(), 2.0f);
    const auto posed = pose(world, 0.5f);
    ASSERT_EQ(posed.size(), 3u);
    EXPECT_TRUE(posed[0].moves && !posed[1].moves && posed[2].moves);
    EXPECT_EQ(posed[0].positions[0], glm::vec3(0.5f, 0, 0));
    EXPECT_EQ(posed[2].positions[0], glm::vec3(1.5f, 10, 0));
    EXPECT_EQ(posed[2].instance, second);
    const Bounds box = bounds(world, 0.5f);
    EXPECT_EQ(box.max, glm::vec3(2.5f, 11, 0));
    world.remove(first);
    EXPECT_EQ(world.instances().size(), 1u);
    EXPECT_GT(world.add({model}), second) << "ids are not reused";
    world.clear();
    EXPECT_TRUE(bounds(world, 0).empty);
}

TEST(World, AnimationMovesDescendants) {
    GltfBuilder b;
    b.triangle();
    b.json["nodes"] = {{{"mesh", 0}}, {{"children", {0}}}, Json::object()};
    b.json["scenes"][0]["nodes"] = {1, 2};
    b.json["animations"] = {{{"samplers", {{{"input", b.scalars({0})}, {"output", b.vec3({0, 0, 0})}}}},
        {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "scale"}}}}}}}};
    EXPECT_EQ(animatedNodes(*b.load(), 0), (std::vector<bool>{true, true, false}));
    EXPECT_EQ(animatedNodes(*b.load(), -1), (std::vector<bool>{false, false, false}));
}

TEST(World, PosesAreDeterministic) {
    GltfBuilder b;
    b.triangle();
    b.json["nodes"][0]["rotation"] = {0.1, 0.2, 0.3, 0.9273618495};
    World world;
    world.add({b.load()});
    EXPECT_EQ(pose(world, 1.0f)[0].positions, pose(world, 1.0f)[0].positions);
}

}  // namespace
}  // namespace obscura::scene::test
