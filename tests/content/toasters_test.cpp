// Animation of the toys: feet touch the ground, the loop is continuous, toys do not intersect.
#include "content_helpers.h"
#include "meshkit/pose.h"
#include "toasters/toaster_scene.h"
#include "toasters/toaster_script.h"
#include "toasters/tray.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

namespace obscura::content {

using namespace kit;

namespace {

constexpr int kToys = 5;
constexpr float kFrame = 1.0f / 30.0f;

int toyNode(const std::string& part, int toy) { return toasters().findNode(part + "_" + std::to_string(toy)); }

const Channel& channelOf(int node, Path path) {
    const auto& channels = toasters().channels;
    return *std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.node == node && c.path == path; });
}

float lowest(const std::vector<glm::vec3>& points) {
    float y = points.front().y;
    for (glm::vec3 p : points) y = std::min(y, p.y);
    return y;
}

}  // namespace

TEST(Toasters, EachToyIsARootWithSkinMorphAndNodeAnimation) {
    for (int toy = 0; toy < kToys; ++toy) {
        const int root = toyNode("toaster", toy);
        ASSERT_NE(root, kNone);
        EXPECT_EQ(toasters().nodes[root].parent, kNone);
        EXPECT_NE(toasters().nodes[root].skin, kNone);
        for (const char* part : {"walk", "body", "head", "key", "toast", "hip_left", "ankle_right"}) {
            int node = toyNode(part, toy);
            ASSERT_NE(node, kNone) << part;
            while (toasters().nodes[node].parent != kNone) node = toasters().nodes[node].parent;
            EXPECT_EQ(node, root) << part;
        }
        EXPECT_EQ(toasters().channelWidth(channelOf(toyNode("toast", toy), Path::Weights)), 1u);
        EXPECT_EQ(channelOf(toyNode("key", toy), Path::Rotation).interpolation, Interpolation::CubicSpline);
        EXPECT_EQ(channelOf(toyNode("eye_left", toy), Path::Rotation).interpolation, Interpolation::Step);
    }
    EXPECT_NE(toasters().findNode("tray"), kNone);
}

TEST(Toasters, WeightsOfEachSkinVertexSumToOne) {
    for (const Geometry& geometry : toasters().geometries)
        for (const SkinInfluence& influence : geometry.skin) {
            const glm::vec4 w = influence.weights;
            EXPECT_NEAR(w.x + w.y + w.z + w.w, 1.0f, 1e-5f);
        }
}

TEST(Toasters, LoopIsContinuousInPositionAndSpeed) {
    for (int toy = 0; toy < kToys; ++toy) {
        const Channel& walk = channelOf(toyNode("walk", toy), Path::Translation);
        const auto at = [&](std::size_t key) {
            return glm::vec3(walk.values[3 * key], walk.values[3 * key + 1], walk.values[3 * key + 2]);
        };
        const std::size_t last = walk.times.size() - 1;
        EXPECT_EQ(at(0), at(last));
        const glm::vec3 leaving = (at(1) - at(0)) / kFrame;
        const glm::vec3 arriving = (at(last) - at(last - 1)) / kFrame;
        EXPECT_LT(glm::distance(leaving, arriving), 0.1f) << "toy " << toy;
        for (std::size_t key = 0; key < last; ++key)
            EXPECT_LT(glm::distance(at(key), at(key + 1)) / kFrame, 5.0f) << "toy " << toy << " key " << key;
    }
}

TEST(Toasters, FeetTouchTheGroundAndDoNotSink) {
    const auto scripts = obscura::toasters::makeScripts();
    for (float time = 0.0f; time < 10.0f; time += 0.5f * kFrame) {
        const Pose pose = poseAt(toasters(), time);
        for (int toy = 0; toy < kToys; ++toy) {
            const std::vector<glm::vec3> legs = posedPositions(toasters(), pose, toyNode("toaster", toy));
            const float gap = lowest(legs) - obscura::toasters::kTrayFloor;
            EXPECT_GT(gap, -0.005f) << "toy " << toy << " at " << time;
            const auto& hops = scripts[static_cast<std::size_t>(toy)].hops;
            const bool isHopping = std::any_of(hops.begin(), hops.end(),
                [&](const auto& hop) { return time > hop.start - 2.0f * kFrame && time < hop.start + hop.duration() + 2.0f * kFrame; });
            if (!isHopping) {
                EXPECT_LT(gap, 0.006f) << "toy " << toy << " at " << time;
            }
        }
    }
}

TEST(Toasters, KneesNeverOverstretch) {
    for (int toy = 0; toy < kToys; ++toy)
        for (const char* side : {"knee_left", "knee_right"}) {
            const Channel& knee = channelOf(toyNode(side, toy), Path::Rotation);
            for (std::size_t key = 0; key < knee.times.size(); ++key)
                EXPECT_GE(knee.values[4 * key] * (knee.values[4 * key + 3] < 0.0f ? -1.0f : 1.0f), 0.0f);
        }
}

TEST(Toasters, ToysDoNotIntersect) {
    // Upright capsules around the bodies; colliding rivals may overlap slightly.
    constexpr float kRadius = 0.16f;
    constexpr float kHeight = 0.46f;
    for (float time = 0.0f; time < 10.0f; time += kFrame) {
        const Pose pose = poseAt(toasters(), time);
        for (int a = 0; a < kToys; ++a)
            for (int b = a + 1; b < kToys; ++b) {
                const glm::vec3 gap(pose.world[toyNode("walk", a)][3] - pose.world[toyNode("walk", b)][3]);
                const float rise = std::max(0.0f, std::abs(gap.y) - kHeight + 2.0f * kRadius);
                const float distance = glm::length(glm::vec3(gap.x, rise, gap.z));
                EXPECT_GT(distance, 2.0f * kRadius) << a << " and " << b << " at " << time;
            }
    }
}

TEST(Toasters, ToysStayOnTheTray) {
    for (float time = 0.0f; time < 10.0f; time += 0.1f) {
        const Pose pose = poseAt(toasters(), time);
        for (int toy = 0; toy < kToys; ++toy) {
            const glm::vec3 place(pose.world[toyNode("walk", toy)][3]);
            EXPECT_LT(std::abs(place.x), 2.05f);
            EXPECT_LT(std::abs(place.z), 1.2f);
        }
    }
}

TEST(Toasters, ToastFliesAndReturns) {
    for (int toy = 0; toy < kToys; ++toy) {
        float highest = 0.0f;
        float bend = 0.0f;
        for (float time = 0.0f; time < 10.0f; time += kFrame) {
            const Pose pose = poseAt(toasters(), time);
            const int toast = toyNode("toast", toy);
            const glm::vec3 place(pose.world[toast][3]);
            const glm::vec3 hinge(pose.world[toyNode("head", toy)][3]);
            highest = std::max(highest, glm::distance(place, hinge));
            bend = std::max(bend, std::abs(pose.weights[toast].front()));
        }
        EXPECT_GT(highest, 0.4f) << "toy " << toy;
        EXPECT_GT(bend, 0.3f) << "toy " << toy;
    }
}

}  // namespace obscura::content
