// Rigid bodies of the toasters: walls, each other, the player, throwing.
#include "physics.h"

#include <gtest/gtest.h>

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace obscura::game {
namespace {

constexpr glm::vec3 kHalf{0.1f, 0.15f, 0.1f};

glm::mat4 at(float x, float z, float turn = 0.0f, float y = 0.0f) {
    return glm::rotate(glm::translate(glm::mat4(1.0f), glm::vec3(x, y, z)), turn, glm::vec3(0, 1, 0));
}
glm::vec3 place(const Physics& physics, uint32_t body) { return glm::vec3(physics.feet(body)[3]); }
float lean(const Physics& physics, uint32_t body) { return std::acos(std::clamp(physics.feet(body)[1].y, -1.0f, 1.0f)); }
void run(Physics& physics, float seconds) {
    for (int i = 0; i < int(seconds * 60.0f); ++i) physics.step(1.0f / 60.0f);
}
// A wall across x at this z, 2 m high, 4 m wide.
std::vector<glm::vec3> wallAt(float z) { return {{-2, 0, z}, {2, 0, z}, {2, 2, z}, {-2, 0, z}, {2, 2, z}, {-2, 2, z}}; }

TEST(Physics, walksAsAsked) {
    Physics physics(0.5f);
    const uint32_t body = physics.add(kHalf, at(1, 2, 0.0f, 0.5f));
    physics.walk(body, {0.0f, -0.4f}, 0.0f);
    run(physics, 1.0f);
    EXPECT_NEAR(place(physics, body).z, 1.6f, 0.01f);
    EXPECT_NEAR(place(physics, body).x, 1.0f, 1e-3f);
    EXPECT_NEAR(place(physics, body).y, 0.5f, 0.01f);
    physics.walk(body, {0.0f, 0.0f}, 1.0f);
    run(physics, 1.0f);
    EXPECT_NEAR(std::atan2(physics.feet(body)[2].x, physics.feet(body)[2].z), 1.0f, 0.02f);
    // Along its own axes, which have turned.
    const glm::vec3 before = place(physics, body);
    physics.walk(body, {0.0f, -0.4f}, 0.0f);
    run(physics, 1.0f);
    EXPECT_NEAR(place(physics, body).x - before.x, -0.4f * std::sin(1.0f), 0.02f);
    EXPECT_NEAR(place(physics, body).z - before.z, -0.4f * std::cos(1.0f), 0.02f);
}

TEST(Physics, aWallStopsAWalkerWhichTurnsAway) {
    Physics physics(0.0f);
    physics.use(Physics::makeWalls(wallAt(-0.5f), 0.0f));
    const uint32_t body = physics.add(kHalf, at(0, 0));
    physics.walk(body, {0.0f, -0.5f}, 0.0f);
    float nearest = 0.0f;
    for (int i = 0; i < 360; ++i) {
        physics.step(1.0f / 60.0f);
        nearest = std::min(nearest, place(physics, body).z);
    }
    EXPECT_LT(nearest, -0.35f) << "it never came to the wall";
    EXPECT_GT(nearest, -0.42f) << "it went into the wall";
    EXPECT_GT(place(physics, body).z, -0.2f) << "it kept walking against the wall";
}

TEST(Physics, trianglesOfTheFloorAreNoWalls) {
    Physics physics(0.0f);
    physics.use(Physics::makeWalls({{-5, 0.01f, -5}, {5, 0.01f, -5}, {5, 0.01f, 5}}, 0.0f));
    const uint32_t body = physics.add(kHalf, at(0, 0));
    run(physics, 0.5f);
    EXPECT_NEAR(place(physics, body).y, 0.0f, 0.005f);
}

TEST(Physics, walkersDoNotPassThroughEachOther) {
    Physics physics(0.0f);
    const uint32_t a = physics.add(kHalf, at(-0.5f, 0)), b = physics.add(kHalf, at(0.5f, 0));
    physics.walk(a, {0.3f, 0.0f}, 0.0f);
    physics.walk(b, {-0.3f, 0.0f}, 0.0f);
    for (int i = 0; i < 300; ++i) {
        physics.step(1.0f / 60.0f);
        ASSERT_GT(glm::distance(place(physics, a), place(physics, b)), 0.18f) << "frame " << i;
        EXPECT_TRUE(physics.walks(a) && physics.walks(b));
    }
}

TEST(Physics, aWalkerIsPushedByThePlayerAndNotByAFollowedCamera) {
    Physics physics(0.0f);
    const uint32_t body = physics.add(kHalf, at(0, 0));
    const auto pass = [&](bool pushes) {
        for (int i = 0; i <= 60; ++i) {
            const glm::vec3 eye(-1.0f + float(i) / 60.0f, 1.7f, 0.0f);
            if (pushes) physics.player(eye, true);
            else physics.noPlayer();
            physics.step(1.0f / 60.0f);
        }
    };
    pass(false);
    EXPECT_NEAR(place(physics, body).x, 0.0f, 1e-3f);
    pass(true);
    EXPECT_GT(place(physics, body).x, 0.3f);
    EXPECT_NEAR(place(physics, body).y, 0.0f, 0.02f);
}

TEST(Physics, aThrownOneTumblesComesToRestAndGetsUp) {
    Physics physics(0.0f);
    const uint32_t body = physics.add(kHalf, at(0, 0));
    physics.hold(body);
    physics.place(body, at(0, 0, 0.0f, 1.2f));
    run(physics, 0.5f);
    EXPECT_NEAR(place(physics, body).y, 1.2f, 1e-3f) << "a held one falls";
    physics.throwAway(body, {0, 1, -4}, {-5, 0, 0});
    EXPECT_FALSE(physics.walks(body));
    float most = 0.0f;
    int up = 0;
    while (!physics.walks(body) && up < 1200) {
        physics.step(1.0f / 60.0f);
        most = std::max(most, lean(physics, body));
        ++up;
    }
    EXPECT_GT(most, 1.0f) << "it never tumbled";
    EXPECT_LT(place(physics, body).z, -1.0f);
    ASSERT_TRUE(physics.walks(body)) << "it lies there after 20 s";
    run(physics, 0.5f);
    EXPECT_LT(lean(physics, body), 0.01f);
    EXPECT_NEAR(place(physics, body).y, 0.0f, 0.01f);
}

TEST(Physics, aThrownOneKnocksAWalkerOver) {
    Physics physics(0.0f);
    const uint32_t victim = physics.add(kHalf, at(0, -1)), thrown = physics.add(kHalf, at(0, 0.5f));
    physics.hold(thrown);
    physics.place(thrown, at(0, 0, 0.0f, 0.15f));
    physics.throwAway(thrown, {0, 0.5f, -6}, {0, 0, 0});
    bool fell = false;
    for (int i = 0; i < 60; ++i) {
        physics.step(1.0f / 60.0f);
        fell |= !physics.walks(victim);
    }
    EXPECT_TRUE(fell);
}

TEST(Physics, theFirstAlongARayIsFoundUnlessAWallStandsBefore) {
    Physics physics(0.0f);
    const uint32_t nearer = physics.add(kHalf, at(0, -1));
    physics.add(kHalf, at(0, -2));
    const glm::vec3 eye(0.0f, 0.15f, 0.0f), ahead(0, 0, -1);
    EXPECT_EQ(physics.firstAlong(eye, ahead, 3.0f), nearer);
    EXPECT_EQ(physics.firstAlong(eye, -ahead, 3.0f), 0u);
    EXPECT_EQ(physics.firstAlong(eye, ahead, 0.5f), 0u) << "out of reach";
    physics.use(Physics::makeWalls(wallAt(-0.5f), 0.0f));
    EXPECT_EQ(physics.firstAlong(eye, ahead, 3.0f), 0u) << "through a wall";
}

TEST(Physics, aPlayerSlidesAlongWalls) {
    Physics physics(0.0f);
    physics.use(Physics::makeWalls(wallAt(-1.0f), 0.0f));
    const glm::vec3 stopped = physics.slide({0, 1.7f, 0}, {0, 1.7f, -2});
    EXPECT_GT(stopped.z, -0.80f);
    EXPECT_LT(stopped.z, -0.65f);
    const glm::vec3 slid = physics.slide({0, 1.7f, -0.7f}, {0.5f, 1.7f, -1.2f});
    EXPECT_GT(slid.z, -0.80f);
    EXPECT_NEAR(slid.x, 0.5f, 0.02f);
    const glm::vec3 free = physics.slide({0, 1.7f, 0}, {1, 1.6f, 1});
    EXPECT_EQ(free, glm::vec3(1, 1.6f, 1));
}

TEST(Physics, sameCallsGiveTheSamePlaces) {
    const auto play = [] {
        Physics physics(0.0f);
        physics.use(Physics::makeWalls(wallAt(-1.0f), 0.0f));
        std::vector<uint32_t> bodies;
        for (int i = 0; i < 16; ++i) {
            bodies.push_back(physics.add(kHalf, at(0.25f * float(i % 4), 0.25f * float(i / 4), float(i))));
            physics.walk(bodies.back(), {0.1f, -0.4f}, 0.3f);
        }
        physics.hold(bodies[3]);
        physics.throwAway(bodies[3], {0, 2, -3}, {1, 2, 3});
        run(physics, 4.0f);
        std::vector<glm::mat4> places;
        for (const uint32_t body : bodies) places.push_back(physics.feet(body));
        return places;
    };
    EXPECT_EQ(play(), play());
}

}  // namespace
}  // namespace obscura::game
