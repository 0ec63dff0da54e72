// The world reference against closed forms; threads, ray packets, masks, error estimates.
#include <algorithm>
#include <atomic>
#include <limits>

#include <gtest/gtest.h>

#include "scratch.h"
#include "shapes.h"

namespace {

using namespace obscura;
using namespace obscura::truth;
using test::Shapes;
using Receiver = WorldReference::Receiver;

WorldOptions rays(uint32_t count) {
    WorldOptions options;
    options.minRays = options.maxRays = count;
    options.targetError = 0.0f;
    return options;
}

struct Falloff {
    RayFalloff falloff;
    double expected[3];  // at 0.1, 0.5 and 1 m from the wall
};
std::vector<Falloff> wallFalloffs() {
    return {{{"exp(-d)", [](float d) { return std::exp(-d); }, 60.0f}, {0.34128, 0.13836, 0.05758}},
        {{"1/(1+d^2)", [](float d) { return 1.0f / (1.0f + d * d); }, std::numeric_limits<float>::infinity()},
            {0.40950, 0.19098, 0.08579}}};
}

void expectWithin(const Reference& reference, size_t channel, size_t i, double expected, double slack = 0.0) {
    const float value = reference.channels[channel].obscurance.values[i], error = reference.channels[channel].error.values[i];
    EXPECT_NEAR(value, expected, 3.0 * double(error) + slack)
        << reference.channels[channel].name << ", receiver " << i << ", error " << error;
    EXPECT_LE(error, 0.005f);
}

TEST(WorldReference, openPlaneIsOpen) {
    Shapes shapes;
    shapes.quad({0, 0, 0}, {100, 0, 0}, {0, 100, 0});
    const WorldReference world(shapes.posed());
    std::vector<Receiver> receivers(100);
    for (int i = 0; i < 100; ++i) receivers[size_t(i)] = {{0.37f * float(i) - 18.0f, 0.11f * float(i), 0.0f}, {0, 0, 1}};
    const std::vector falloffs{rayFalloff("constant:10")};
    const Reference reference = world.trace(receivers, falloffs, rays(256));
    for (const float value : reference.channels[0].obscurance.values) EXPECT_EQ(value, 0.0f);
    EXPECT_EQ(reference.totalRays, 25600u);
}

TEST(WorldReference, rightAngledWallMatchesTheClosedForm) {
    Shapes shapes;
    shapes.quad({0, 0, 0}, {1e4f, 0, 0}, {0, 1e4f, 0});
    shapes.quad({0, 0, 0}, {0, 1e4f, 0}, {0, 0, 1e4f});
    const WorldReference world(shapes.posed());
    const std::vector<Receiver> receivers = {{{-0.1f, 0, 0}, {0, 0, 1}}, {{-0.5f, 0, 0}, {0, 0, 1}}, {{-1.0f, 0, 0}, {0, 0, 1}}};
    std::vector<RayFalloff> falloffs;
    for (const Falloff& f : wallFalloffs()) falloffs.push_back(f.falloff);
    const Reference reference = world.trace(receivers, falloffs, rays(16384));
    const double distances[] = {0.1, 0.5, 1.0};
    for (size_t f = 0; f < falloffs.size(); ++f)
        for (size_t i = 0; i < 3; ++i) {
            const double expected = wallFalloffs()[f].expected[i];
            EXPECT_NEAR(test::wall(distances[i], [&](double d) { return double(falloffs[f].rho(float(d))); }), expected, 2e-5);
            expectWithin(reference, f, i, expected);
            RecordProperty(
                falloffs[f].name + " at " + std::to_string(distances[i]), std::to_string(reference.channels[f].obscurance.values[i]));
        }
}

// At an endless wall a floor sees a quarter sphere, whose cosine-weighted mean direction is (2 / (3 pi), 0, 1/3); a wall sees it too.
TEST(WorldReference, bentNormalsAtAWallAreAQuarterSphere) {
    Shapes shapes;
    shapes.quad({0, 0, 0}, {1e4f, 0, 0}, {0, 0, 1e4f});
    shapes.quad({0, 0, 0}, {0, 1e4f, 0}, {0, 0, 1e4f});
    const WorldReference world(shapes.posed());
    const std::vector<Receiver> receivers = {{{-0.01f, 0, 0}, {0, 1, 0}}, {{0, 0.01f, 0}, {-1, 0, 0}}};
    const std::vector falloffs{rayFalloff("constant:1000"), rayFalloff("constant:0.001")};
    WorldOptions options = rays(8192);
    const Reference plain = world.trace(receivers, falloffs, options);
    options.bentNormals = true;
    const Reference reference = world.trace(receivers, falloffs, options);
    EXPECT_FALSE(bool(plain.channels[0].bent));
    ASSERT_TRUE(bool(reference.channels[0].bent));
    for (size_t f = 0; f < 2; ++f) EXPECT_EQ(reference.channels[f].obscurance.values, plain.channels[f].obscurance.values);
    const float across = float(2.0 / (3.0 * test::kPi)), third = 1.0f / 3.0f;
    const auto expectMean = [&](size_t f, size_t i, const glm::vec3& mean, float above) {
        const BentReference& bent = reference.channels[f].bent;
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(bent.mean[axis].values[i], mean[axis], 0.003f) << "falloff " << f << ", receiver " << i << ", axis " << axis;
        EXPECT_NEAR(bent.above.values[i], above, 0.003f) << "falloff " << f << ", receiver " << i;
    };
    expectMean(0, 0, {-across, third, 0}, 0.5f);
    expectMean(0, 1, {-third, across, 0}, 0.5f);  // what a wall sees of the upper half
    expectMean(1, 0, {0, 2.0f / 3.0f, 0}, 1.0f);
    expectMean(1, 1, {-2.0f / 3.0f, 0, 0}, 0.5f);  // half of an open wall's light comes from below
}

TEST(WorldReference, sphereOverPlaneCoversItsSolidAngle) {
    Shapes shapes;
    shapes.quad({0, 0, 0}, {50, 0, 0}, {0, 50, 0});
    const glm::vec3 centre(0, 0, 2.0f);
    const float radius = 1.0f;
    shapes.sphere(centre, radius);
    const WorldReference world(shapes.posed());
    std::vector<Receiver> receivers;
    for (const float x : {0.0f, 0.5f, 1.0f, 2.0f, 3.0f}) receivers.push_back({{x, 0.3f * x, 0}, {0, 0, 1}});
    const std::vector falloffs{rayFalloff("constant:20")};
    const Reference reference = world.trace(receivers, falloffs, rays(8192));
    for (size_t i = 0; i < receivers.size(); ++i) {
        const double d = glm::length(centre - receivers[i].position);
        expectWithin(reference, 0, i, radius * radius / (d * d) * (2.0 / d), 1e-4);
    }
}

TEST(WorldReference, fullEnclosureIsOne) {
    Shapes shapes;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 c(0), a(0), b(0);
            c[axis] = side;
            a[(axis + 1) % 3] = b[(axis + 2) % 3] = 1.0f;
            shapes.quad(c, a, b);
        }
    const WorldReference world(shapes.posed());
    const std::vector<Receiver> receivers = {
        {{0, 0, 0}, {0, 0, 1}}, {{0.9f, -0.3f, -1.0f}, {0, 0, 1}}, {{-1.0f, 0.999f, 0.999f}, {1, 0, 0}}};
    const std::vector falloffs{rayFalloff("constant:10")};
    const Reference reference = world.trace(receivers, falloffs, rays(4096));
    for (const float value : reference.channels[0].obscurance.values) EXPECT_EQ(value, 1.0f);
    for (const float error : reference.channels[0].error.values) EXPECT_EQ(error, 0.0f);
}

// A scene of random lumps, different around every receiver.
struct Lumps {
    Shapes shapes;
    std::vector<Receiver> receivers;
    Lumps() {
        shapes.quad({0, 0, 0}, {20, 0, 0}, {0, 20, 0});
        for (int i = 0; i < 12; ++i) shapes.sphere({float(i % 4) * 1.5f, float(i / 4) * 1.5f, 0.4f}, 0.5f, 16);
        for (int i = 0; i < 400; ++i) receivers.push_back({{0.013f * float(i), 0.011f * float(i * 7 % 400), 0.0f}, {0, 0, 1}});
        for (int i = 0; i < 400; i += 13) receivers[size_t(i)].normal = glm::vec3(0.0f);
    }
};

TEST(WorldReference, isBitIdenticalForAnyThreadCount) {
    const Lumps lumps;
    const WorldReference world(lumps.shapes.posed());
    const std::vector falloffs{rayFalloff("quadratic:2"), rayFalloff("exponential:0.5")};
    WorldOptions options;
    options.targetError = 0.01f;
    options.threads = 1;
    const Reference one = world.trace(lumps.receivers, falloffs, options);
    options.threads = 5;
    const Reference five = world.trace(lumps.receivers, falloffs, options);
    for (size_t f = 0; f < 2; ++f) {
        EXPECT_EQ(one.channels[f].obscurance.values, five.channels[f].obscurance.values);
        EXPECT_EQ(one.channels[f].error.values, five.channels[f].error.values);
    }
    EXPECT_EQ(one.rays.values, five.rays.values);
    options.seed = 2;
    EXPECT_NE(world.trace(lumps.receivers, falloffs, options).channels[0].obscurance.values, one.channels[0].obscurance.values);
}

TEST(WorldReference, packetsAndSingleRaysAgree) {
    const Lumps lumps;
    const WorldReference world(lumps.shapes.posed());
    for (const char* name : {"quadratic:2", "constant:2"}) {
        const std::vector falloffs{rayFalloff(name)};
        WorldOptions options = rays(128);
        const Reference packets = world.trace(lumps.receivers, falloffs, options);
        options.packets = false;
        const Reference single = world.trace(lumps.receivers, falloffs, options);
        for (size_t i = 0; i < lumps.receivers.size(); ++i)
            EXPECT_NEAR(packets.channels[0].obscurance.values[i], single.channels[0].obscurance.values[i], 1.01f / 128.0f);
    }
}

TEST(WorldReference, standardErrorMatchesRepeatedRuns) {
    const Lumps lumps;
    const WorldReference world(lumps.shapes.posed());
    const std::vector falloffs{rayFalloff("quadratic:2")};
    const Reference truth = world.trace(lumps.receivers, falloffs, rays(16384));
    double square = 0.0, claimed = 0.0;
    size_t outside = 0, count = 0;
    for (uint32_t seed = 10; seed < 16; ++seed) {
        WorldOptions options = rays(256);
        options.seed = seed;
        const Reference reference = world.trace(lumps.receivers, falloffs, options);
        for (size_t i = 0; i < lumps.receivers.size(); ++i) {
            const double error = reference.channels[0].error.values[i];
            if (error == 0.0) continue;
            const double off = reference.channels[0].obscurance.values[i] - truth.channels[0].obscurance.values[i];
            square += off * off;
            claimed += error * error;
            outside += std::fabs(off) > 3.0 * error;
            ++count;
        }
    }
    ASSERT_GT(count, 1000u);
    EXPECT_NEAR(std::sqrt(square / claimed), 1.0, 0.15);
    EXPECT_LT(double(outside) / double(count), 0.02);
}

TEST(WorldReference, adaptiveSamplingFollowsTheVariance) {
    const Lumps lumps;
    const WorldReference world(lumps.shapes.posed());
    const std::vector falloffs{rayFalloff("quadratic:2")};
    WorldOptions options;
    options.maxRays = 1 << 16;
    const Reference reference = world.trace(lumps.receivers, falloffs, options);
    float least = 1e9f, most = 0.0f;
    for (size_t i = 0; i < lumps.receivers.size(); ++i) {
        EXPECT_LE(reference.channels[0].error.values[i], options.targetError);
        if (lumps.receivers[i].normal == glm::vec3(0.0f)) {
            EXPECT_EQ(reference.rays.values[i], 0.0f);
            continue;
        }
        least = std::min(least, reference.rays.values[i]);
        most = std::max(most, reference.rays.values[i]);
    }
    EXPECT_EQ(reference.overTarget(options.targetError), 0u);
    EXPECT_EQ(least, float(options.minRays));
    EXPECT_GT(most, 2.0f * least);
    options.maxRays = 160;  // the limit is kept
    options.targetError = 1e-5f;
    const Reference limited = world.trace(lumps.receivers, falloffs, options);
    for (const float count : limited.rays.values) EXPECT_LE(count, 160.0f);
    EXPECT_GT(limited.overTarget(options.targetError), 100u);
}

TEST(WorldReference, maskedTexelsLetRaysThrough) {
    Shapes shapes;
    scene::Model& model = shapes.model();
    model.images.resize(1);
    model.images[0].width = 2;
    model.images[0].height = 1;
    model.images[0].rgba = {255, 255, 255, 255, 255, 255, 255, 100};  // left half opaque, right half a hole
    model.textures.resize(1);
    model.textures[0].image = 0;
    model.textures[0].sampler.linearMag = false;
    model.textures[0].sampler.wrapU = scene::Wrap::clamp;
    model.materials[0].alphaMode = scene::AlphaMode::mask;
    model.materials[0].baseColorTexture.texture = 0;
    shapes.quad({0, 0, 1}, {1e3f, 0, 0}, {0, 1e3f, 0});
    const std::vector<Receiver> receivers = {{{-5, 0, 0}, {0, 0, 1}}, {{5, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {0, 0, 1}}};
    for (const char* name : {"constant:2", "linear:4"}) {  // any hit and first hit
        const std::vector falloffs{rayFalloff(name)};
        const auto values = [&](const WorldGeometry& geometry, bool packets) {
            WorldOptions options = rays(1024);
            options.packets = packets;
            return WorldReference(shapes.posed(), geometry).trace(receivers, falloffs, options).channels[0].obscurance.values;
        };
        for (const bool packets : {true, false}) {
            const std::vector<float> masked = values({}, packets), none = values({.skipMasked = true}, packets);
            EXPECT_GT(masked[0], 0.4f);
            EXPECT_EQ(masked[1], 0.0f);
            EXPECT_NEAR(masked[2], 0.5f * masked[0], 0.01f);
            EXPECT_EQ(none[0], 0.0f);
        }
        // The material factor and vertex alpha count as well.
        model.materials[0].baseColor.a = 2.0f;
        EXPECT_GT(values({}, true)[1], 0.4f);
        model.materials[0].baseColor.a = 1.0f;
    }
    model.materials[0].alphaMode = scene::AlphaMode::blend;
    const std::vector falloffs{rayFalloff("constant:2")};
    EXPECT_EQ(WorldReference(shapes.posed()).trace(receivers, falloffs, rays(64)).channels[0].obscurance.values[0], 0.0f);
    EXPECT_GT(
        WorldReference(shapes.posed(), {.skipBlended = false}).trace(receivers, falloffs, rays(64)).channels[0].obscurance.values[0], 0.4f);
}

TEST(WorldReference, progressIsReportedAndCanStop) {
    const Lumps lumps;
    const WorldReference world(lumps.shapes.posed());
    const std::vector falloffs{rayFalloff("quadratic:2")};
    WorldOptions options = rays(256);
    options.threads = 2;
    float last = 0.0f;
    options.progress = [&](float share) {
        EXPECT_GE(share, last);
        last = share;
        return true;
    };
    world.trace(lumps.receivers, falloffs, options);
    EXPECT_EQ(last, 1.0f);
    last = 0.0f;
    world.trace(std::span<const Receiver>(), falloffs, options);  // no receivers: progress still ends at 1
    EXPECT_EQ(last, 1.0f);
    options.progress = [](float) { return false; };
    test::expectError([&] { world.trace(lumps.receivers, falloffs, options); }, "cancelled");
    options.progress = [](float) -> bool { throw scene::Error("from the callback"); };
    test::expectError([&] { world.trace(lumps.receivers, falloffs, options); }, "from the callback");
}

TEST(WorldReference, invalidInputIsRefused) {
    Shapes shapes;
    shapes.model().name = "broken";
    shapes.quad({0, 0, std::nanf("")}, {1, 0, 0}, {0, 1, 0});
    test::expectError([&] { WorldReference world(shapes.posed()); }, "broken: node 0");
    const WorldReference empty(std::vector<scene::PosedPrimitive>{});
    CapturedFrame frame = emptyFrame({8, 8}, {0, 0}, 1.0f, 0.1f);
    frame.normals.clear();
    const std::vector falloffs{rayFalloff("quadratic:2")};
    test::expectError([&] { empty.trace(frame, falloffs); }, "no normals");
    test::expectError([] { rayFalloff("cubic:2"); }, "falloff \"cubic:2\"");
    frame = emptyFrame({8, 8}, {0, 0}, 1.0f, 0.1f);  // all sky
    EXPECT_EQ(empty.trace(frame, falloffs).totalRays, 0u);
}

}  // namespace
