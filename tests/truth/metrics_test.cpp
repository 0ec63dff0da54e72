// Error metrics on images with known errors.
#include <cmath>

#include "scratch.h"
#include "truth/bent_normals.h"
#include "truth/metrics.h"

namespace {

using namespace obscura;
using namespace obscura::truth;

float noise(uint32_t i) {
    i = (i ^ (i >> 15)) * 0x2c1b3c6du;
    i = (i ^ (i >> 12)) * 0x297a2d39u;
    return float((i ^ (i >> 15)) >> 8) / 16777216.0f;
}

Plane textured(uint32_t width, uint32_t height) {
    Plane plane(width, height);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            plane.at(x, y) = 0.5f + 0.3f * std::sin(0.3f * float(x)) * std::cos(0.2f * float(y)) + 0.1f * noise(y * width + x);
    return plane;
}

TEST(Metrics, equalPicturesHaveNoError) {
    const Plane a = textured(64, 48);
    const Metrics m = compare(a, a);
    EXPECT_EQ(m.pixels, 64u * 48u);
    EXPECT_EQ(m.raw.eA, 0.0f);
    EXPECT_EQ(m.raw.rmse, 0.0f);
    EXPECT_EQ(m.raw.e5, 1.0f);
    EXPECT_EQ(m.raw.p99, 0.0f);
    EXPECT_NEAR(m.gamma, 1.0f, 1e-4f);
    EXPECT_NEAR(m.ssim, 1.0f, 1e-5f);
    EXPECT_NEAR(m.flipMean, 0.0f, 1e-6f);
}

TEST(Metrics, constantOffsetIsBiasAndError) {
    Plane r(40, 30, 0.5f), a(40, 30, 0.6f);
    const Metrics m = compare(a, r);
    EXPECT_NEAR(m.raw.bias, 0.1f, 1e-6f);
    EXPECT_NEAR(m.raw.eA, 0.1f, 1e-6f);
    EXPECT_NEAR(m.raw.rmse, 0.1f, 1e-6f);
    EXPECT_NEAR(m.raw.p99, 0.1f, 1e-6f);
    EXPECT_EQ(m.raw.e5, 0.0f);
    // 0.6^g = 0.5
    EXPECT_NEAR(m.gamma, std::log(0.5f) / std::log(0.6f), 1e-3f);
    EXPECT_NEAR(m.adjusted.rmse, 0.0f, 1e-4f);
    // Flat windows: (2ab + C1) / (a^2 + b^2 + C1).
    EXPECT_NEAR(m.ssim, (2 * 0.3 + 1e-4) / (0.25 + 0.36 + 1e-4), 1e-5);
    EXPECT_NEAR(compare(r, a).raw.bias, -0.1f, 1e-6f);
}

TEST(Metrics, percentilesAndFractions) {
    Plane r(100, 100, 0.5f), a = r;
    for (int i = 0; i < 10000; ++i) a.values[size_t(i)] += i < 9900 ? (i % 2 ? 0.04f : -0.04f) : 0.3f;  // exactly 1 % has a large error
    const Metrics m = compare(a, r);
    EXPECT_NEAR(m.raw.p99, 0.04f, 1e-6f);
    EXPECT_NEAR(m.raw.e5, 0.99f, 1e-6f);
    EXPECT_NEAR(m.raw.bias, 0.003f, 1e-5f);
    EXPECT_NEAR(m.raw.eA, 0.99f * 0.04f + 0.01f * 0.3f, 1e-5f);
    EXPECT_NEAR(m.raw.rmse, std::sqrt(0.99 * 0.0016 + 0.01 * 0.09), 1e-5);
    a.values[0] += 0.2f;
    EXPECT_GT(compare(a, r).raw.p99, 0.15f);
}

TEST(Metrics, bestPowerIsFound) {
    const Plane a = textured(64, 48);
    for (const float gamma : {0.3f, 0.8f, 2.2f, 5.0f}) {
        Plane r = a;
        for (float& v : r.values) v = std::pow(v, gamma);
        const Metrics m = compare(a, r);
        EXPECT_NEAR(m.gamma, gamma, 2e-3f * gamma);
        EXPECT_LT(m.adjusted.rmse, 1e-3f);
        EXPECT_GT(m.raw.rmse, 0.03f);
    }
}

// SSIM of one pixel by its definition, far from the border.
TEST(Metrics, ssimMatchesItsDefinition) {
    const Plane a = textured(32, 32);
    Plane b = a;
    for (size_t i = 0; i < b.pixels(); ++i) b.values[i] = 0.7f * b.values[i] + 0.2f * noise(uint32_t(i) + 77u);
    double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0, total = 0;
    for (int dy = -5; dy <= 5; ++dy)
        for (int dx = -5; dx <= 5; ++dx) {
            const double w = std::exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5)), p = a.at(uint32_t(15 + dx), uint32_t(17 + dy)),
                         q = b.at(uint32_t(15 + dx), uint32_t(17 + dy));
            ma += w * p, mb += w * q, aa += w * p * p, bb += w * q * q, ab += w * p * q, total += w;
        }
    ma /= total, mb /= total, aa /= total, bb /= total, ab /= total;
    const double expected =
        (2 * ma * mb + 1e-4) * (2 * (ab - ma * mb) + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (aa - ma * ma + bb - mb * mb + 9e-4));
    EXPECT_NEAR(ssimMap(a, b).at(15, 17), expected, 1e-5);
    EXPECT_LT(expected, 0.95);
}

TEST(Metrics, onlyValidPixelsCount) {
    Plane r = textured(40, 30), a = r;
    Mask valid(r.pixels(), 1);
    for (uint32_t y = 0; y < 30; ++y)
        for (uint32_t x = 25; x < 40; ++x) {
            valid[size_t(y) * 40 + x] = 0;
            a.at(x, y) = std::nanf("");
        }
    const Metrics m = compare(a, r, valid);
    EXPECT_EQ(m.pixels, 25u * 30u);
    EXPECT_EQ(m.raw.eA, 0.0f);
    EXPECT_NEAR(m.ssim, 1.0f, 1e-5f);
    EXPECT_EQ(compare(a, r, Mask(r.pixels(), 0)).pixels, 0u);
}

// Floor at 10 m; a wide block and a pole 2 px wide at 5 m; sky above.
CapturedFrame scene() {
    CapturedFrame frame = emptyFrame({100, 60}, {10, 6}, 1.0f, 0.1f);
    for (uint32_t y = 10; y < 60; ++y)
        for (uint32_t x = 0; x < 100; ++x) {
            const bool block = x >= 20 && x < 40 && y >= 30, pole = x >= 70 && x < 72;
            frame.depth[frame.visibleIndex(x, y)] = block || pole ? 5.0f : 10.0f;
            frame.normals[frame.visibleIndex(x, y)] = {0, 0, 1};
        }
    return frame;
}

TEST(Metrics, regionsCoverTheirPixels) {
    const CapturedFrame frame = scene();
    const Regions regions = regionsOf(frame);
    const auto in = [&](Region region, uint32_t x, uint32_t y) { return regions[region][size_t(y) * 100 + x] != 0; };
    EXPECT_FALSE(in(Region::whole, 50, 5));  // sky
    EXPECT_TRUE(in(Region::whole, 50, 20));
    // Eight pixels beyond the edge of the block, none on the block.
    EXPECT_TRUE(in(Region::halo, 40, 45));
    EXPECT_TRUE(in(Region::halo, 47, 45));
    EXPECT_FALSE(in(Region::halo, 48, 45));
    EXPECT_TRUE(in(Region::halo, 12, 45));
    EXPECT_FALSE(in(Region::halo, 11, 45));
    EXPECT_FALSE(in(Region::halo, 39, 45));
    EXPECT_FALSE(in(Region::halo, 25, 45));
    EXPECT_TRUE(in(Region::halo, 30, 29));
    EXPECT_FALSE(in(Region::halo, 30, 21));
    // The pole is thin, the block is not.
    EXPECT_TRUE(in(Region::thin, 70, 30));
    EXPECT_TRUE(in(Region::thin, 79, 30));
    EXPECT_FALSE(in(Region::thin, 80, 30));
    EXPECT_FALSE(in(Region::thin, 30, 45));
    EXPECT_FALSE(in(Region::thin, 45, 45));
    EXPECT_TRUE(in(Region::border, 9, 30));
    EXPECT_FALSE(in(Region::border, 10, 30));
    EXPECT_TRUE(in(Region::border, 90, 30));
    EXPECT_TRUE(in(Region::border, 50, 54));
    EXPECT_FALSE(in(Region::border, 50, 53));
    EXPECT_FALSE(in(Region::border, 5, 5));
    EXPECT_TRUE(regions[Region::disoccluded].empty());
}

TEST(Metrics, errorsAffectOnlyTheirRegion) {
    const CapturedFrame frame = scene();
    Mask uncovered(6000, 0);
    uncovered[20 * 100 + 60] = uncovered[20 * 100 + 61] = uncovered[0] = 1;  // the last pixel is sky
    const Regions regions = regionsOf(frame, uncovered);
    Plane r(100, 60, 0.5f), a = r;
    for (size_t i = 0; i < r.pixels(); ++i)
        if (regions[Region::halo][i]) a.values[i] = 0.7f;
    const auto all = compare(a, r, regions);
    ASSERT_EQ(all.size(), kRegions);
    for (const RegionMetrics& m : all) {
        if (m.region == Region::whole) {
            EXPECT_EQ(m.metrics.pixels, 5000u);
        }
        if (m.region == Region::halo) {
            EXPECT_NEAR(m.metrics.raw.eA, 0.2f, 1e-6f);
        }
        if (m.region == Region::disoccluded) {
            EXPECT_EQ(m.metrics.pixels, 2u);
            EXPECT_EQ(m.metrics.raw.eA, 0.0f);
        }
        EXPECT_EQ(m.metrics.gamma, all[0].metrics.gamma);
    }
    EXPECT_EQ(compare(a, r, regionsOf(frame)).size(), 4u);
}

TEST(Metrics, invalidInputGivesOneLine) {
    Plane a(10, 10, 0.5f), b(10, 11, 0.5f);
    test::expectError([&] { compare(a, b); }, "the picture is 10 x 10 pixels, its reference 10 x 11");
    Plane c = a;
    c.at(3, 4) = std::nanf("");
    test::expectError([&] { compare(c, a); }, "the picture holds nan at pixel (3, 4)");
    test::expectError([&] { compare(a, c); }, "the reference holds nan at pixel (3, 4)");
    test::expectError([&] { compare(a, a, Mask(99, 1)); }, "a mask of 99 pixels");
}

// A surface that faces aside under a roof: half of its sky is blocked, so light comes from the ground and the lower half of the sky.
TEST(BentErrors, meanAngleAndLight) {
    BentReference reference;
    for (Plane* plane : {&reference.mean[0], &reference.mean[1], &reference.mean[2], &reference.above}) *plane = Plane(3, 1);
    Plane visibility(3, 1), truth(3, 1);
    // Pixel 0: open, up. Pixel 1: blocked above, so that the mean direction is 45 degrees below the normal. Pixel 2: sky.
    reference.mean[1].values = {0.6f, -0.3f, 0.0f};
    reference.mean[0].values = {0.0f, 0.3f, 0.0f};
    reference.above.values = {1.0f, 0.0f, 0.0f};
    truth.values = {1.0f, 0.5f, 1.0f};
    visibility.values = {1.0f, 0.5f, 1.0f};
    const std::vector<glm::vec3> normals = {{0, 1, 0}, {1, 0, 0}, {0, 0, 0}}, exact = {{0, 1, 0}, {1, -1, 0}, {0, 0, 0}};
    const Mask valid = {1, 1, 1};
    const BentErrors plain = compareBent(normals, visibility, normals, reference, truth, 0.4f, valid),
                     bent = compareBent(exact, visibility, normals, reference, truth, 0.4f, valid);
    EXPECT_EQ(plain.pixels, 2u);
    EXPECT_NEAR(plain.degrees, 22.5f, 1e-3f);
    EXPECT_NEAR(bent.degrees, 0.0f, 0.03f);
    EXPECT_NEAR(bent.normalDegrees, 22.5f, 1e-3f);
    // E of the normal is (1 + 0.4) / 2 and of 45 degrees below it 0.4 + 0.6 (1 - sqrt 1/2) / 2; the light is 0.5 x 0.4.
    EXPECT_NEAR(plain.irradiance, 0.5f * (0.5f * 0.7f - 0.2f), 1e-5f);
    EXPECT_NEAR(plain.bentIrradiance, plain.irradiance, 1e-6f);
    EXPECT_NEAR(bent.irradiance, plain.irradiance, 1e-6f);
    EXPECT_NEAR(bent.bentIrradiance, 0.5f * (0.5f * (0.4f + 0.3f * (1.0f - std::sqrt(0.5f))) - 0.2f), 1e-5f);
    EXPECT_EQ(compareBent(exact, visibility, normals, reference, truth, 0.4f, {1, 0, 0}).pixels, 1u);
}

}  // namespace
