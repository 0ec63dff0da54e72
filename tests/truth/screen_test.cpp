// The screen-space reference against closed forms for the solids that a depth buffer describes, under validation.
#include <algorithm>

#include <gtest/gtest.h>

#include "gpu/test_device.h"
#include "scratch.h"
#include "shapes.h"
#include "truth/screen_reference.h"

namespace {

using namespace obscura;
using namespace obscura::truth;

class ScreenReferenceTest : public test::GpuTest {
protected:
    void SetUp() override {
        GpuTest::SetUp();
        m_shaders.add(truth::shaders());
    }
    Reference trace(const CapturedFrame& frame, const std::vector<RayFalloff>& falloffs, const ScreenOptions& options) {
        return ScreenReference(test::device(), m_shaders).trace(frame, falloffs, options);
    }
    gpu::ShaderLibrary m_shaders;
};

ScreenOptions rays(uint32_t count) {
    ScreenOptions options;
    options.minRays = options.maxRays = count;
    options.targetError = 0.0f;
    return options;
}

// An orthographic frame: depth and normal as functions of eye-space x and y.
CapturedFrame orthographic(glm::uvec2 visible, glm::uvec2 guard, float pixel, const std::function<float(float, float)>& depth,
    const std::function<glm::vec3(float, float)>& normal) {
    scene::Camera camera;
    camera.orthoHalfHeight = 0.5f * float(visible.y) * pixel;
    CapturedFrame frame = emptyFrame(visible, guard, 1.0f, 0.1f, camera);
    for (uint32_t y = 0; y < frame.size.y; ++y)
        for (uint32_t x = 0; x < frame.size.x; ++x) {
            const float ex = (float(x) + 0.5f - 0.5f * float(frame.size.x)) * pixel,
                        ey = (0.5f * float(frame.size.y) - float(y) - 0.5f) * pixel;
            frame.depth[frame.index(x, y)] = depth(ex, ey);
            frame.normals[frame.index(x, y)] = normal(ex, ey);
        }
    return frame;
}

// Number of receivers outside three standard errors, and the mean difference.
struct Verdict {
    size_t receivers = 0, outside = 0;
    double bias = 0.0, worst = 0.0;
};
Verdict judge(
    const CapturedFrame& frame, const Reference& reference, size_t channel, const std::function<double(glm::vec3 eye)>& expected) {
    Verdict verdict;
    const glm::uvec2 part = frame.visible();
    for (uint32_t y = 0; y < part.y; ++y)
        for (uint32_t x = 0; x < part.x; ++x) {
            if (reference.rays.at(x, y) == 0.0f) continue;
            const double exact = expected(frame.eyePosition(x + frame.guard.x, y + frame.guard.y));
            if (exact < 0.0) continue;
            const double off = reference.channels[channel].obscurance.at(x, y) - exact, error = reference.channels[channel].error.at(x, y);
            verdict.outside += std::fabs(off) > 3.0 * error;
            verdict.bias += off;
            verdict.worst = std::max(verdict.worst, std::fabs(off));
            ++verdict.receivers;
        }
    verdict.bias /= double(std::max<size_t>(verdict.receivers, 1));
    return verdict;
}

// Tilted planes in perspective must not block their own rays at the steps between texels.
TEST_F(ScreenReferenceTest, openPlaneIsOpen) {
    const std::vector falloffs{rayFalloff("constant:2"), rayFalloff("exponential:1")};
    for (const glm::vec3 normal :
        {glm::vec3(0, 0, 1), glm::vec3(0, 1, 0.02f), glm::vec3(0.7f, 0.7f, 0.05f), glm::vec3(-0.9f, 0.3f, 0.3f)}) {
        const glm::vec3 n = glm::normalize(normal);
        CapturedFrame frame = emptyFrame({160, 90}, {16, 9}, 1.0471976f, 0.1f);
        const shared::View view = frame.view();
        for (uint32_t y = 0; y < frame.size.y; ++y)
            for (uint32_t x = 0; x < frame.size.x; ++x) {
                const glm::vec3 ray((float(x) + 0.5f) * view.unproject.x + view.unproject.z,
                    (float(y) + 0.5f) * view.unproject.y + view.unproject.w, -1.0f);
                const float depth = -1.6f / glm::dot(n, ray);
                if (!(depth > 0.0f && depth < 50.0f)) continue;
                frame.depth[frame.index(x, y)] = depth;
                frame.normals[frame.index(x, y)] = n;
            }
        ScreenOptions options = rays(128);
        options.stride = 3;
        const Reference reference = trace(frame, falloffs, options);
        EXPECT_GT(reference.totalRays, 30000u);
        for (const auto& channel : reference.channels) {
            double sum = 0.0;
            for (size_t i = 0; i < channel.obscurance.pixels(); ++i) {
                ASSERT_LE(channel.obscurance.values[i], 3.0f * channel.error.values[i])
                    << "normal " << normal.x << " " << normal.y << " " << normal.z << ", pixel " << i % 160 << ", " << i / 160;
                sum += channel.obscurance.values[i];
            }
            EXPECT_LT(sum * double(kBatch) * 8.0, 1e-5 * double(reference.totalRays));  // 128 rays per pixel
        }
    }
}

// A wall seen at a grazing angle beside a thin pole nearer to the camera: the offset along the wall's normal ends in the pole's texel,
// behind the pole. Its rays still start before the pole, so those that pass above or below its texel are free.
TEST_F(ScreenReferenceTest, rayStartsInItsOwnTexel) {
    for (const float side : {1.0f, -1.0f}) {
        const auto at = [&](float x, float y, float px, float py) {  // whether eye-space (x, y) is in that texel, 0.1 m wide
            return std::fabs(x - px) < 0.05f && std::fabs(y - py) < 0.05f;
        };
        const CapturedFrame frame = orthographic(
            {32, 32}, {4, 4}, 0.1f, [&](float x, float y) { return at(x, y, side * 0.15f, 0.05f) ? 1.0f : 5.0f; },
            [&](float x, float y) { return at(x, y, side * 0.05f, 0.05f) ? glm::vec3(side * 0.9f, 0.0f, 0.43589f) : glm::vec3(0, 0, 1); });
        const Reference reference = trace(frame, {{rayFalloff("constant:3")}}, rays(2048));
        const float beside = reference.channels[0].obscurance.at(side > 0 ? 16 : 15, 15);
        printf("beside the pole: obscurance %.3f\n", double(beside));
        EXPECT_LT(beside, 0.95f) << side;
        EXPECT_GT(beside, 0.5f) << side;
    }
}

// A valley of two walls, each 45 degrees from the view axis, 12 mm per pixel.
TEST_F(ScreenReferenceTest, rightAngledWallMatchesTheClosedForm) {
    const float s = std::sqrt(0.5f), reach = 10.0f;
    const CapturedFrame frame = orthographic(
        {64, 126}, {868, 837}, 0.012f, [](float, float y) { return 20.0f - std::fabs(y); },
        [=](float, float y) { return glm::vec3(0.0f, y < 0.0f ? s : -s, s); });
    const std::vector<RayFalloff> falloffs = {
        {"exp(-d)", [](float d) { return std::exp(-d); }, reach}, {"1/(1+d^2)", [](float d) { return 1.0f / (1.0f + d * d); }, reach}};
    ScreenOptions options = rays(1024);
    options.stride = 7;
    const Reference reference = trace(frame, falloffs, options);
    for (size_t f = 0; f < falloffs.size(); ++f) {
        std::map<float, double> known;
        const Verdict verdict = judge(frame, reference, f, [&](glm::vec3 eye) {
            const float distance = std::fabs(eye.y) / s;
            if (distance < 0.09f) return -1.0;  // fewer than six texels to the wall
            if (!known.count(distance))
                known[distance] = test::wall(distance, [&](double d) { return d < reach ? double(falloffs[f].rho(float(d))) : 0.0; }, 512);
            return known[distance];
        });
        printf("screen wall %s: %zu receivers, %zu outside 3 standard errors, bias %+.5f, worst %.4f, mean error %.5f\n",
            falloffs[f].name.c_str(), verdict.receivers, verdict.outside, verdict.bias, verdict.worst, double(reference.meanError(f)));
        EXPECT_GT(verdict.receivers, 100u);
        EXPECT_LE(verdict.outside, verdict.receivers / 25);
        EXPECT_LE(std::fabs(verdict.bias), 0.0005);
    }
}

// From above, a depth buffer describes a sphere as a sphere on a column.
TEST_F(ScreenReferenceTest, sphereOverPlaneMatchesASphereOnAColumn) {
    const float radius = 0.5f, height = 1.0f, floor = 10.0f, pixel = 0.0025f;
    const CapturedFrame frame = orthographic(
        {900, 64}, {500, 700}, pixel,
        [=](float x, float y) {
            const float r2 = x * x + y * y;
            return r2 < radius * radius ? floor - height - std::sqrt(radius * radius - r2) : floor;
        },
        [](float, float) { return glm::vec3(0, 0, 1); });
    ScreenOptions options = rays(1024);
    options.stride = 20;
    const auto column = [=](glm::vec3 from, double x, double y, double z) {
        // Enters the infinite column below the sphere's centre, or hits the sphere.
        const double b = from.x * x + from.y * y, a = x * x + y * y,
                     c = double(from.x) * from.x + double(from.y) * from.y - radius * radius;
        const double inside = b * b - a * c;
        if (inside > 0.0 && a > 0.0) {
            const double t = (-b - std::sqrt(inside)) / a;
            if (t > 0.0 && t * z < height) return t;
        }
        const double sb = b - height * z, sc = c + double(height) * height;
        const double s = sb * sb - sc;
        return s > 0.0 && -sb > 0.0 ? -sb - std::sqrt(s) : -1.0;
    };
    const std::vector falloffs{rayFalloff("constant:1.6")};
    const Reference reference = trace(frame, falloffs, options);
    const Verdict verdict = judge(frame, reference, 0, [&](glm::vec3 eye) {
        const double r = std::hypot(eye.x, eye.y);
        if (r < radius + 0.02f) return -1.0;
        return test::quadrature([&](double x, double y, double z) { return column(glm::vec3(eye.x, eye.y, 0), x, y, z); },
            [](double d) { return d < 1.6 ? 1.0 : 0.0; }, 256);
    });
    printf("screen sphere: %zu receivers, %zu outside 3 standard errors, bias %+.5f, worst %.4f, mean error %.5f\n", verdict.receivers,
        verdict.outside, verdict.bias, verdict.worst, double(reference.meanError()));
    EXPECT_GT(verdict.receivers, 20u);
    EXPECT_LE(verdict.outside, verdict.receivers / 20);
}

// A well 20 m deep, of radius r: obscurance 1 - r^2 / (r^2 + depth^2).
TEST_F(ScreenReferenceTest, wellMatchesTheClosedForm) {
    for (const float radius : {4.0f, 0.1f}) {
        const float deep = 20.0f, top = 1.0f, pixel = radius / 64.0f;
        const CapturedFrame frame = orthographic(
            {4, 4}, {80, 80}, pixel, [=](float x, float y) { return x * x + y * y < radius * radius ? top + deep : top; },
            [](float, float) { return glm::vec3(0, 0, 1); });
        const std::vector falloffs{rayFalloff("constant:100")};
        const Reference reference = trace(frame, falloffs, rays(4096));
        const double expected = 1.0 - radius * radius / (radius * radius + deep * deep);
        for (size_t i = 0; i < 16; ++i)
            EXPECT_NEAR(reference.channels[0].obscurance.values[i], expected, 3.0 * double(reference.channels[0].error.values[i]) + 1e-3)
                << radius;
    }
}

// A plate 1 m above a floor: with infinite thickness a column, with its thickness a plate.
TEST_F(ScreenReferenceTest, thicknessLetsRaysPassBelow) {
    const float radius = 0.5f, height = 1.0f, thick = 0.1f, pixel = 0.0025f;
    const CapturedFrame frame = orthographic(
        {800, 4}, {500, 900}, pixel, [=](float x, float y) { return x * x + y * y < radius * radius ? 9.0f - thick : 10.0f; },
        [](float, float) { return glm::vec3(0, 0, 1); });
    const auto slab = [=](glm::vec3 from, double low, double x, double y, double z) {
        const double b = from.x * x + from.y * y, a = x * x + y * y,
                     c = double(from.x) * from.x + double(from.y) * from.y - radius * radius;
        const double inside = b * b - a * c;
        if (inside <= 0.0 || a <= 0.0) return -1.0;
        const double enter = std::max((-b - std::sqrt(inside)) / a, low / z),
                     leave = std::min((-b + std::sqrt(inside)) / a, (height + thick) / z);
        return enter < leave && leave > 0.0 ? enter : -1.0;
    };
    const std::vector falloffs{rayFalloff("constant:2")};
    for (const bool infinite : {true, false}) {
        ScreenOptions options = rays(1024);
        options.stride = 8;
        if (!infinite) options.thickness = thick;
        const Reference reference = trace(frame, falloffs, options);
        const Verdict verdict = judge(frame, reference, 0, [&](glm::vec3 eye) {
            if (std::hypot(eye.x, eye.y) < radius + 3.0f * pixel) return -1.0;
            return test::quadrature(
                [&](double x, double y, double z) { return slab(glm::vec3(eye.x, eye.y, 0), infinite ? 0.0 : height, x, y, z); },
                [](double d) { return d < 2.0 ? 1.0 : 0.0; }, 256);
        });
        printf("screen plate, %s: %zu receivers, %zu outside 3 standard errors, bias %+.5f, worst %.4f, mean error %.5f\n",
            infinite ? "infinite" : "0.1 m", verdict.receivers, verdict.outside, verdict.bias, verdict.worst,
            double(reference.meanError()));
        EXPECT_GT(verdict.receivers, 10u);
        EXPECT_LE(verdict.outside, verdict.receivers / 20);
    }
}

TEST_F(ScreenReferenceTest, isDeterministicAndAddsRaysWhereNeeded) {
    const float s = std::sqrt(0.5f);
    const CapturedFrame frame = orthographic(
        {48, 48}, {60, 60}, 0.05f, [](float, float y) { return 20.0f - std::fabs(y); },
        [=](float, float y) { return glm::vec3(0.0f, y < 0.0f ? s : -s, s); });
    const std::vector falloffs{rayFalloff("quadratic:1"), rayFalloff("linear:0.5")};
    ScreenOptions options;
    options.targetError = 0.004f;
    float last = 0.0f;
    options.progress = [&](float share) {
        EXPECT_GE(share, last);
        last = share;
        return true;
    };
    const Reference a = trace(frame, falloffs, options);
    EXPECT_EQ(last, 1.0f);
    options.progress = {};
    const Reference b = trace(frame, falloffs, options);
    EXPECT_EQ(a.channels[0].obscurance.values, b.channels[0].obscurance.values);
    EXPECT_EQ(a.channels[1].error.values, b.channels[1].error.values);
    EXPECT_EQ(a.overTarget(0.004f), 0u);
    EXPECT_EQ(*std::min_element(a.rays.values.begin(), a.rays.values.end()), 128.0f);
    EXPECT_GT(*std::max_element(a.rays.values.begin(), a.rays.values.end()), 128.0f);
    options.progress = [](float) { return false; };
    test::expectError([&] { trace(frame, falloffs, options); }, "cancelled");
}

TEST_F(ScreenReferenceTest, invalidInputIsRefused) {
    CapturedFrame frame = emptyFrame({8, 8}, {0, 0}, 1.0f, 0.1f);
    EXPECT_EQ(trace(frame, {rayFalloff("quadratic:2")}, {}).totalRays, 0u);  // all sky
    test::expectError([&] { trace(frame, {}, {}); }, "0 falloffs");
    test::expectError(
        [&] { trace(frame, {{"far", [](float) { return 1.0f; }, std::numeric_limits<float>::infinity()}}, {}); }, "finite reach");
    ScreenOptions thin;
    thin.thickness = 0.0f;
    test::expectError([&] { trace(frame, {rayFalloff("quadratic:2")}, thin); }, "thickness");
    frame.normals.clear();
    test::expectError([&] { trace(frame, {rayFalloff("quadratic:2")}, {}); }, "no normals");
}

}  // namespace
