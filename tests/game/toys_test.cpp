// Dropped toasters in a world: they stand on the floor, walk as their animation does, collide, and are picked up and thrown.
#include "toys.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <optional>

namespace obscura::game {
namespace {

// A room's floor, 20 m wide, without walls: one triangle far below, since a world has at least one instance.
scene::World emptyWorld() {
    auto model = std::make_shared<scene::Model>();
    scene::World world;
    world.add({.model = model});
    return world;
}

class ToysTest : public testing::Test {
protected:
    void SetUp() override {
        const std::optional<std::filesystem::path> file = app::findContent("toasters.glb");
        if (!file) GTEST_SKIP() << "toasters.glb is missing; build the target content, which makes it";
        m_model = scene::loadGltf(*file);
        m_toys.emplace(m_world, m_info, m_model);
    }
    // Lowest point, and middle, of a dropped one as drawn.
    scene::Bounds drawn(size_t index, float time) {
        scene::World alone;
        alone.add(m_world.instances()[1 + index]);
        return scene::bounds(alone, time);
    }
    void run(float from, float to, const Toys::Pusher* player = nullptr) {
        for (float time = from; time < to + 1e-4f; time += 1.0f / 60.0f) m_toys->advance(time, player, true);
    }

    app::SceneInfo m_info;
    scene::World m_world = emptyWorld();
    std::shared_ptr<const scene::Model> m_model;
    std::optional<Toys> m_toys;
};

TEST_F(ToysTest, standsWhereItWasDroppedAndWalksAsItsAnimation) {
    ASSERT_TRUE(m_toys->drop({1, 0, 2}, 0.0f, 1.0f));
    const scene::Bounds at = drawn(0, 1.0f);
    EXPECT_NEAR(at.centre().x, 1.0f, 0.25f);
    EXPECT_NEAR(at.centre().z, 2.0f, 0.25f);
    // Where the animation alone takes it: the same placement at a later time.
    const scene::Bounds expected = drawn(0, 1.9f);
    run(1.0f, 1.9f);
    const scene::Bounds walked = drawn(0, 1.9f);
    EXPECT_LT(glm::distance(walked.centre(), expected.centre()), 0.03f);
    EXPECT_NEAR(walked.min.y, 0.0f, 0.03f);
}

TEST_F(ToysTest, aJumpInTimeLeavesItWhereItStands) {
    ASSERT_TRUE(m_toys->drop({0, 0, 0}, 0.0f, 0.0f));
    run(0.0f, 0.5f);
    const glm::vec3 before = drawn(0, 0.5f).centre();
    m_toys->advance(7.0f, nullptr, true);
    EXPECT_LT(glm::distance(glm::vec2(before.x, before.z), glm::vec2(drawn(0, 7.0f).centre().x, drawn(0, 7.0f).centre().z)), 0.2f);
}

TEST_F(ToysTest, manyStayApart) {
    while (m_toys->drop({0, 0, 0}, float(m_toys->dropped()), 0.0f)) {}
    EXPECT_EQ(m_toys->dropped(), Toys::kMost);
    run(0.0f, 3.0f);
    for (size_t a = 0; a < Toys::kMost; ++a)
        for (size_t b = 0; b < a; ++b) {
            const glm::vec3 between = drawn(a, 3.0f).centre() - drawn(b, 3.0f).centre();
            if (std::abs(between.y) < 0.1f) {
                EXPECT_GT(glm::length(glm::vec2(between.x, between.z)), 0.15f) << a << " and " << b;
            }
        }
}

TEST_F(ToysTest, isPickedUpCarriedAndThrown) {
    scene::Camera camera;
    camera.eye = {0, 1.2f, 2};
    camera.target = {0, 0.2f, 0};
    EXPECT_EQ(m_toys->pickOrThrow(camera), Toys::Grabbed::nothing);
    ASSERT_TRUE(m_toys->drop({0.2f, 0, 0}, 0.0f, 0.0f));
    run(0.0f, 0.1f);
    scene::Camera away = camera;
    away.target = {0, 1.2f, 4};
    EXPECT_EQ(m_toys->pickOrThrow(away), Toys::Grabbed::nothing);
    EXPECT_EQ(m_toys->pickOrThrow(camera), Toys::Grabbed::picked);
    camera.target = {5, 1.2f, 2};
    const Toys::Pusher player{camera, false};
    run(0.1f, 0.5f, &player);
    EXPECT_GT(drawn(0, 0.5f).centre().y, 0.5f) << "it is not carried";
    EXPECT_GT(drawn(0, 0.5f).centre().x, 0.5f) << "it does not follow the camera";
    EXPECT_EQ(m_toys->pickOrThrow(camera), Toys::Grabbed::thrown);
    run(0.5f, 6.0f, &player);
    EXPECT_GT(drawn(0, 6.0f).centre().x, 2.0f) << "it was not thrown";
    EXPECT_NEAR(drawn(0, 6.0f).min.y, 0.0f, 0.05f);
    m_toys->removeLast();
    EXPECT_EQ(m_world.instances().size(), 1u);
}

}  // namespace
}  // namespace obscura::game
