// Interpolation, skinning and morphing against values computed by hand.
#include <cmath>

#include <gtest/gtest.h>

#include "gltf_builder.h"
#include "scene/pose.h"

namespace obscura::scene::test {
namespace {

constexpr float kHalf = 0.70710678f;  // sin and cos of 45 degrees

void near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

std::shared_ptr<const Model> animated(
    const char* path, const char* interpolation, const std::vector<float>& times, const std::vector<float>& values) {
    GltfBuilder b;
    b.triangle();
    const int output = std::string(path) == "rotation" ? b.vec4(values) : b.vec3(values);
    b.json["animations"] = {{{"samplers", {{{"input", b.scalars(times)}, {"output", output}, {"interpolation", interpolation}}}},
        {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
    return b.load();
}

TEST(Animation, StepHoldsTheKeyBefore) {
    const auto m = animated("translation", "STEP", {1, 2, 4}, {1, 0, 0, 2, 0, 0, 3, 0, 0});
    const auto x = [&](float t) { return evaluate(*m, 0, t, false).world[0][3].x; };
    EXPECT_EQ(x(0.0f), 1.0f);
    EXPECT_EQ(x(1.999f), 1.0f);
    EXPECT_EQ(x(2.0f), 2.0f);
    EXPECT_EQ(x(3.999f), 2.0f);
    EXPECT_EQ(x(9.0f), 3.0f);
}

TEST(Animation, LinearIsLinearAndClamped) {
    const auto m = animated("translation", "LINEAR", {1, 2, 4}, {1, 0, 0, 2, 0, 0, 6, 0, 0});
    const auto x = [&](float t) { return evaluate(*m, 0, t, false).world[0][3].x; };
    EXPECT_FLOAT_EQ(x(0.5f), 1.0f);
    EXPECT_FLOAT_EQ(x(1.25f), 1.25f);
    EXPECT_FLOAT_EQ(x(3.0f), 4.0f);
    EXPECT_FLOAT_EQ(x(5.0f), 6.0f);
}

TEST(Animation, LoopWrapsIntoTheDuration) {
    const auto m = animated("translation", "LINEAR", {0, 4}, {0, 0, 0, 8, 0, 0});
    EXPECT_FLOAT_EQ(evaluate(*m, 0, 5.0f, true).world[0][3].x, 2.0f);
    EXPECT_FLOAT_EQ(evaluate(*m, 0, -1.0f, true).world[0][3].x, 6.0f);
    EXPECT_FLOAT_EQ(m->animations[0].duration, 4.0f);
}

TEST(Animation, CubicSplineByHand) {
    // Keys 1 and 5 at times 0 and 2, out-tangent 2, in-tangent -1. At t = 1/2: 0.5*1 + 2*0.125*2 + 0.5*5 + 2*-0.125*-1.
    const auto m = animated("translation", "CUBICSPLINE", {0, 2}, {9, 9, 9, 1, 0, 0, 2, 0, 0, -1, 0, 0, 5, 0, 0, 9, 9, 9});
    const auto x = [&](float t) { return evaluate(*m, 0, t, false).world[0][3].x; };
    EXPECT_FLOAT_EQ(x(0.0f), 1.0f);
    EXPECT_FLOAT_EQ(x(1.0f), 0.5f + 0.5f + 2.5f + 0.25f);
    EXPECT_FLOAT_EQ(x(2.0f), 5.0f);
    // The slope at the start is the out-tangent.
    EXPECT_NEAR((x(0.001f) - x(0.0f)) / 0.001f, 2.0f, 0.02f);
}

TEST(Animation, RotationTakesTheShorterWay) {
    // From 0 to -90 degrees about z, as a quaternion of opposite sign: the shorter way is 90 degrees, not 270.
    const auto m = animated("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, kHalf, -kHalf});
    const glm::mat4 w = evaluate(*m, 0, 0.5f, false).world[0];
    near(glm::vec3(w[0]), {kHalf, -kHalf, 0});
}

TEST(Animation, RestPoseWithoutAnimation) {
    const auto m = animated("translation", "LINEAR", {0, 1}, {1, 0, 0, 2, 0, 0});
    EXPECT_EQ(evaluate(*m, -1, 0.5f).world[0][3].x, 0.0f);
    EXPECT_EQ(evaluate(*m, 7, 0.5f).world[0][3].x, 0.0f);
}

TEST(Animation, NormalizedRotationKeys) {
    GltfBuilder b;
    b.triangle();
    const int output = b.accessor(std::vector<int8_t>{0, 0, 0, 127, 0, 0, 127, 0}, "VEC4", 5120, 4, true);
    b.json["animations"] = {{{"samplers", {{{"input", b.scalars({0, 1})}, {"output", output}}}},
        {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}}};
    near(glm::vec3(evaluate(*b.load(), 0, 1.0f, false).world[0][0]), {-1, 0, 0});
}

TEST(Animation, TimesMustRise) {
    GltfBuilder b;
    b.triangle();
    b.json["animations"] = {{{"samplers", {{{"input", b.scalars({0, 1, 1})}, {"output", b.vec3({0, 0, 0, 0, 0, 0, 0, 0, 0})}}}},
        {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
    EXPECT_TRUE(contains(b.error(), "/animations/0/samplers/0/input: key 2 at 1 s")) << b.error();
    b.json["animations"][0]["channels"][0]["target"]["node"] = 3;
    EXPECT_TRUE(contains(b.error(), "/animations/0/channels/0/target/node: node 3 does not exist")) << b.error();
}

// Two joints along y, the upper one turned by 90 degrees about z.
GltfBuilder arm() {
    GltfBuilder b;
    const int positions = b.vec3({0, 0, 0, 0, 2, 0, 1, 2, 0});
    const int joints = b.accessor(std::vector<uint8_t>{0, 1, 9, 9, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4", 5121, 4);
    const int weights = b.vec4({1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 2, 0, 0, 0});
    b.mesh({{"POSITION", positions}, {"NORMAL", b.vec3({0, 0, 1, 0, 1, 0, 1, 0, 0})}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
    b.json["nodes"][0]["skin"] = 0;
    b.json["nodes"][0]["translation"] = {100, 0, 0};  // ignored for skinned geometry
    b.json["nodes"].push_back({{"children", {2}}});
    b.json["nodes"].push_back({{"translation", {0, 1, 0}}, {"rotation", {0, 0, kHalf, kHalf}}});
    b.json["scenes"][0]["nodes"] = {0, 1};
    b.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", b.mat4({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0,
                                                                        1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1})}}};
    return b;
}

TEST(Skinning, BlendsJointMatrices) {
    const auto model = arm().load();
    const Primitive& primitive = model->meshes[0].primitives[0];
    std::vector<glm::vec3> positions, normals;
    deform(*model, 0, primitive, evaluate(*model, -1, 0.0f), positions, &normals);
    near(positions[0], {0, 0, 0});
    // Half of (0,2,0) and half of (0,2,0) turned about (0,1,0): (-1,1,0).
    near(positions[1], {-0.5f, 1.5f, 0});
    // Joint 1 alone, its weight of 2 normalized to 1: (1,1,0) about the joint turns to (-1,1,0).
    near(positions[2], {-1, 2, 0});
    near(normals[0], {0, 0, 1});
    near(normals[2], {0, 1, 0});
    EXPECT_FLOAT_EQ(primitive.weights[2][0], 1.0f);
    EXPECT_EQ(primitive.joints[0][2], 0) << "joints without weight do not matter";
}

TEST(Skinning, EightInfluences) {
    GltfBuilder b = arm();
    b.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_1"] =
        b.accessor(std::vector<uint16_t>{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 5123, 4);
    b.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_1"] = b.vec4({3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    const auto model = b.load();
    const Primitive& primitive = model->meshes[0].primitives[0];
    EXPECT_EQ(primitive.joints[0][4], 1);
    EXPECT_FLOAT_EQ(primitive.weights[0][0], 0.25f);
    EXPECT_FLOAT_EQ(primitive.weights[0][4], 0.75f);
}

TEST(Skinning, JointBeyondTheSkinIsNamed) {
    GltfBuilder b = arm();
    b.json["skins"][0]["joints"] = {1};
    EXPECT_TRUE(contains(b.error(), "/meshes/0/primitives/0/attributes/JOINTS_0: vertex 1 follows joint 1")) << b.error();
    b.json["skins"][0]["joints"] = {1, 5};
    EXPECT_TRUE(contains(b.error(), "/skins/0/joints/1: node 5 does not exist")) << b.error();
}

TEST(Morph, WeightsMoveVertices) {
    GltfBuilder b;
    Json& primitive = b.mesh({{"POSITION", b.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0})}, {"NORMAL", b.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1})}});
    primitive["targets"] = {{{"POSITION", b.vec3({0, 0, 1, 0, 0, 0, 0, 0, 0})}, {"NORMAL", b.vec3({1, 0, 0, 0, 0, 0, 0, 0, 0})}},
        {{"POSITION", b.vec3({0, 2, 0, 0, 0, 0, 0, 0, 0})}}};
    b.json["meshes"][0]["weights"] = {0.5, 0};
    b.json["animations"] = {{{"samplers", {{{"input", b.scalars({0, 1})}, {"output", b.scalars({0, 0, 1, 0.5f})}}}},
        {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
    const auto model = b.load();
    std::vector<glm::vec3> positions, normals;
    deform(*model, 0, model->meshes[0].primitives[0], evaluate(*model, -1, 0.0f), positions, &normals);
    near(positions[0], {0, 0, 0.5f});
    near(normals[0], glm::normalize(glm::vec3(0.5f, 0, 1)));
    deform(*model, 0, model->meshes[0].primitives[0], evaluate(*model, 0, 0.5f), positions, nullptr);
    near(positions[0], {0, 0.5f, 0.5f});
    EXPECT_EQ(model->meshes[0].primitives[0].boundsMax, glm::vec3(1, 2, 1));
}

TEST(Morph, CubicSplineWeights) {
    GltfBuilder b;
    Json& primitive = b.triangle();
    primitive["targets"] = {{{"POSITION", b.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1})}}, {{"POSITION", b.vec3({1, 0, 0, 1, 0, 0, 1, 0, 0})}}};
    // Per key: two in-tangents, two values, two out-tangents.
    b.json["animations"] = {{{"samplers", {{{"input", b.scalars({0, 1})}, {"interpolation", "CUBICSPLINE"},
                                              {"output", b.scalars({0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0})}}}},
        {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
    const auto model = b.load();
    const auto weights = evaluate(*model, 0, 0.5f, false).weights[0];
    EXPECT_FLOAT_EQ(weights[0], 0.125f * 1 + 0.5f);
    EXPECT_FLOAT_EQ(weights[1], 0.5f);
}

TEST(Morph, NodeWeightsOverride) {
    GltfBuilder b;
    Json& primitive = b.triangle();
    primitive["targets"] = {{{"POSITION", b.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1})}}};
    b.json["nodes"][0]["weights"] = {0.25};
    EXPECT_EQ(evaluate(*b.load(), -1, 0).weights[0], std::vector<float>{0.25f});
    b.json["nodes"][0]["weights"] = {0.25, 1};
    EXPECT_TRUE(contains(b.error(), "/nodes/0/weights")) << b.error();
}

// Four animations of one node each, as exporters write an object's actions, and one more that moves a node again.
class Together : public testing::Test {
protected:
    static std::shared_ptr<const Model> model() {
        GltfBuilder b;
        b.triangle();
        b.json["nodes"] = Json::array();
        for (int i = 0; i < 4; ++i) {
            b.json["nodes"].push_back({{"mesh", 0}, {"translation", {i, 0, 0}}});
            b.json["animations"].push_back(move(b, i, "box" + std::to_string(i), 2.0f + float(i)));
        }
        b.json["animations"].push_back(move(b, 2, "again", 9.0f));
        b.json["scenes"] = Json::array({{{"nodes", {0, 1, 2, 3}}}});
        return b.load();
    }
    // From 0 to `seconds` up by as many metres.
    static Json move(GltfBuilder& b, int node, const std::string& name, float seconds) {
        return {{"name", name},
            {"samplers", {{{"input", b.scalars({0, seconds})}, {"output", b.vec3({float(node), 0, 0, float(node), seconds, 0})}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}};
    }
};

TEST_F(Together, allPlayEachInItsOwnLoop) {
    const auto m = model();
    EXPECT_EQ(playing(*m, kAllAnimations), (std::vector<int>{0, 1, 2, 3})) << "the fifth moves what the third moves";
    const Pose pose = evaluate(*m, kAllAnimations, 4.5f);
    const float heights[] = {0.5f, 1.5f, 0.5f, 4.5f};  // 4.5 s in loops of 2, 3, 4 and 5 s
    for (size_t i = 0; i < 4; ++i) near(glm::vec3(pose.world[i][3]), {float(i), heights[i], 0});
}

TEST_F(Together, oneOrNonePlaysIfChosen) {
    const auto m = model();
    const Pose one = evaluate(*m, 1, 1.0f), alternative = evaluate(*m, 4, 8.0f), none = evaluate(*m, kRestPose, 1.0f);
    near(glm::vec3(one.world[1][3]), {1, 1, 0});
    near(glm::vec3(one.world[0][3]), {0, 0, 0});
    near(glm::vec3(alternative.world[2][3]), {2, 8, 0});
    near(glm::vec3(none.world[1][3]), {1, 0, 0});
    EXPECT_TRUE(playing(*m, 5).empty());
    EXPECT_TRUE(playing(*m, kRestPose).empty());
}

}  // namespace
}  // namespace obscura::scene::test
