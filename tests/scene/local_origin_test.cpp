// Scenes in map coordinates: moved to a local origin in double precision, wherever in the nodes the distance is added.
#include <cmath>

#include <gtest/gtest.h>

#include "gltf_builder.h"
#include "scene/camera.h"

namespace obscura::scene::test {
namespace {

constexpr double kEast = 500000.37, kNorth = 5200000.61;

// A triangle 3 m from the local origin, a second one at it, a camera, and a node that moves by 1 m in 2 s.
enum class Where { nowhere, root, leaves, matrix, turned };
std::shared_ptr<const Model> scene(Where where) {
    GltfBuilder b;
    b.triangle();
    b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}}};
    const bool far = where != Where::nowhere;
    // The local scene stands at (kEast, 0, kNorth) in the file.
    const auto at = [&](double x, double y, double z) {
        const bool here = where == Where::leaves;
        return Json{x + (here ? kEast : 0), y, z + (here ? kNorth : 0)};
    };
    b.json["nodes"] = {{{"mesh", 0}, {"translation", at(3, 0, 0)}}, {{"mesh", 0}, {"translation", at(0, 0, 0)}},
        {{"camera", 0}, {"translation", at(0.25, 3, 8)}}, {{"mesh", 0}, {"translation", at(0, 1, 0)}}, {{"children", {0, 1, 2, 3}}}};
    Json& root = b.json["nodes"][4];
    if (where == Where::root) root["translation"] = {kEast, 0, kNorth};
    if (where == Where::matrix) root["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, kEast, 0, kNorth, 1};
    if (where == Where::turned) {  // z up above nodes that add the distance
        root["rotation"] = {-0.7071067811865476, 0, 0, 0.7071067811865476};
        for (size_t i = 0; i < 4; ++i) {
            Json& t = b.json["nodes"][i]["translation"];
            t = {t[0].get<double>() + kEast, -(t[2].get<double>() + kNorth), t[1].get<double>()};
            b.json["nodes"][i]["rotation"] = {0.7071067811865476, 0, 0, 0.7071067811865476};
        }
    }
    const bool above = where == Where::root || where == Where::matrix || !far;
    if (above)
        b.json["animations"] = {{{"samplers", {{{"input", b.scalars({0, 2})}, {"output", b.vec3({0, 1, 0, 0, 2, 0})}}}},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 3}, {"path", "translation"}}}}}}}};
    b.json["scenes"] = Json::array({{{"nodes", {4}}}});
    return b.load();
}

TEST(LocalOrigin, distancesBetweenNodesKeepTheirPrecision) {
    const auto home = scene(Where::nowhere);
    EXPECT_EQ(home->origin, glm::dvec3(0.0));
    for (const Where where : {Where::root, Where::leaves, Where::matrix, Where::turned}) {
        const auto away = scene(where);
        EXPECT_EQ(away->origin.y, 0.0) << int(where);
        EXPECT_NEAR(away->origin.x, kEast, 4.0) << int(where);
        EXPECT_NEAR(away->origin.z, kNorth, 4.0) << int(where);
        ASSERT_FALSE(away->warnings.empty());
        EXPECT_TRUE(contains(away->warnings.back(), "it is moved there")) << away->warnings.back();
        const Pose a = evaluate(*home, kRestPose, 0), b = evaluate(*away, kRestPose, 0);
        const glm::dvec3 offset = glm::dvec3(kEast, 0, kNorth) - away->origin;
        for (size_t node = 0; node < 4; ++node)
            EXPECT_LT(glm::length(glm::dvec3(b.world[node][3]) - glm::dvec3(a.world[node][3]) - offset), 2e-6) << int(where) << " " << node;
        const Camera camera = lensCamera({.model = away}, b, 0), own = lensCamera({.model = home}, a, 0);
        EXPECT_LT(glm::length(glm::dvec3(camera.eye - own.eye) - offset), 2e-6);
        World world;
        world.add({.model = away, .animation = kRestPose});
        EXPECT_LT(glm::length(glm::dvec3(bounds(world, 0).centre())), 5.0) << int(where);
    }
}

TEST(LocalOrigin, animationsBelowTheMovedNodePlayAsBefore) {
    const Pose a = evaluate(*scene(Where::nowhere), kAllAnimations, 1.0f), b = evaluate(*scene(Where::root), kAllAnimations, 1.0f);
    EXPECT_NEAR(b.world[3][3].y, 1.5f, 1e-6f);
    EXPECT_EQ(a.world[3][3].y, b.world[3][3].y);
}

// An animated node that adds the distance itself: its keys lose it too.
TEST(LocalOrigin, animatedDistancesAreMoved) {
    GltfBuilder b;
    b.triangle();
    b.json["nodes"][0]["translation"] = {400000, 0, 0};
    b.json["animations"] = {{{"samplers", {{{"input", b.scalars({0, 2})}, {"output", b.vec3({400000, 0, 0, 400004, 0, 0})}}}},
        {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    const auto model = b.load();
    EXPECT_NEAR(model->origin.x, 400000, 1.0);
    EXPECT_NEAR(double(evaluate(*model, kAllAnimations, 1.0f).world[0][3].x) + model->origin.x, 400002.0, 1e-6);
}

// What a float still resolves stays where the file puts it.
TEST(LocalOrigin, nearScenesStay) {
    GltfBuilder b;
    b.triangle();
    b.json["nodes"][0]["translation"] = {80, 0, -60};
    const auto model = b.load();
    EXPECT_EQ(model->origin, glm::dvec3(0.0));
    EXPECT_EQ(evaluate(*model, kRestPose, 0).world[0][3].x, 80.0f);
}

}  // namespace
}  // namespace obscura::scene::test
