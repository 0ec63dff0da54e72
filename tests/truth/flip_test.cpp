// FLIP against closed forms, and against its definition: 2D kernels, one pixel at a time, double precision.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "truth/flip.h"

namespace {

using namespace obscura::truth;
using Vec = std::array<double, 3>;
constexpr double kPi = 3.14159265358979323846;

double lightness(double y) { return y > 216.0 / 24389.0 ? 116.0 * std::cbrt(y) - 16.0 : 24389.0 / 27.0 * y; }

// sRGB's green is CIELAB (87.74, -86.18, 83.18), its blue (32.30, 79.19, -107.86); chroma times lightness / 100.
const double kGreenToBlue = 87.74 - 32.30 + std::hypot(0.8774 * -86.18 - 0.3230 * 79.19, 0.8774 * 83.18 + 0.3230 * 107.86);

// FLIP of two uniform greys: no features, only lightness differs.
double flatFlip(double a, double b) {
    const double largest = std::pow(kGreenToBlue, 0.7);
    const double d = std::pow(std::fabs(lightness(a) - lightness(b)), 0.7);
    return d < 0.4 * largest ? 0.95 / (0.4 * largest) * d : 0.95 + (d - 0.4 * largest) / (0.6 * largest) * 0.05;
}

TEST(Flip, equalIsZero) {
    Plane a(30, 20, 0.3f);
    a.at(10, 10) = 0.9f;
    for (const float v : flip(a, a).values) EXPECT_EQ(v, 0.0f);
}

TEST(Flip, flatGreysHaveAClosedForm) {
    const double greys[][2] = {{0.0, 1.0}, {0.2, 0.3}, {0.5, 0.501}, {0.0, 0.005}, {0.9, 0.1}};
    for (const auto& [a, b] : greys) {
        const Plane map = flip(Plane(24, 24, float(a)), Plane(24, 24, float(b)));
        for (const float v : map.values) EXPECT_NEAR(v, flatFlip(a, b), 1e-3) << a << " " << b;
    }
}

TEST(Flip, isSymmetricAndGrowsWithTheDifference) {
    Plane a(40, 40, 0.5f), b = a, c = a;
    for (uint32_t i = 10; i < 30; ++i) b.at(i, i) = 0.6f, c.at(i, i) = 0.9f;
    const Plane ab = flip(a, b), ba = flip(b, a), ac = flip(a, c);
    double smaller = 0, larger = 0;
    for (size_t i = 0; i < ab.pixels(); ++i) {
        EXPECT_FLOAT_EQ(ab.values[i], ba.values[i]);
        EXPECT_GE(ab.values[i], 0.0f);
        EXPECT_LE(ac.values[i], 1.0f);
        smaller += ab.values[i];
        larger += ac.values[i];
    }
    EXPECT_GT(smaller, 0.0);
    EXPECT_GT(larger, 1.5 * smaller);
}

// ---- The definition, by pixel ---------------------------------------------------------------------------------------

struct Plain {
    int width, height;
    std::vector<Vec> pixels;
    const Vec& at(int x, int y) const { return pixels[size_t(std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1))]; }
};

constexpr double kX[3] = {0.950428545, 1.0, 1.088900371};  // D65

Vec xyz(const Vec& c) {
    return {0.4123907993 * c[0] + 0.3575843394 * c[1] + 0.1804807884 * c[2],
        0.2126390059 * c[0] + 0.7151686788 * c[1] + 0.0721923154 * c[2], 0.0193308187 * c[0] + 0.1191947798 * c[1] + 0.9505321522 * c[2]};
}

Vec opponent(const Vec& rgb) {
    const Vec c = xyz(rgb);
    const double x = c[0] / kX[0], y = c[1] / kX[1], z = c[2] / kX[2];
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Vec labOfOpponent(const Vec& o) {
    const double y = (o[0] + 16) / 116;
    const double x[3] = {(y + o[1] / 500) * kX[0], y, (y - o[2] / 200) * kX[2]};
    Vec rgb = {3.2409699419 * x[0] - 1.5373831776 * x[1] - 0.4986107603 * x[2],
        -0.9692436363 * x[0] + 1.8759675015 * x[1] + 0.0415550574 * x[2], 0.0556300797 * x[0] - 0.2039769589 * x[1] + 1.0569715142 * x[2]};
    for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
    const Vec c = xyz(rgb);
    double f[3];
    for (size_t i = 0; i < 3; ++i) {
        const double t = c[i] / kX[i];
        f[i] = t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
    }
    const double l = 116 * f[1] - 16;
    return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

Vec perceivedLab(const Plain& opponents, int px, int py, double ppd) {
    const double a1[3] = {1, 1, 34.1}, b1[3] = {0.0047, 0.0053, 0.04}, a2[3] = {0, 0, 13.5}, b2[3] = {1e-5, 1e-5, 0.025};
    const int r = int(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * ppd));
    Vec sum{}, total{};
    for (int dy = -r; dy <= r; ++dy)
        for (int dx = -r; dx <= r; ++dx)
            for (size_t c = 0; c < 3; ++c) {
                const double z = (dx * dx + dy * dy) / (ppd * ppd);
                const double w = a1[c] * std::sqrt(kPi / b1[c]) * std::exp(-kPi * kPi * z / b1[c]) +
                                 a2[c] * std::sqrt(kPi / b2[c]) * std::exp(-kPi * kPi * z / b2[c]);
                sum[c] += w * opponents.at(px + dx, py + dy)[c];
                total[c] += w;
            }
    return labOfOpponent({sum[0] / total[0], sum[1] / total[1], sum[2] / total[2]});
}

double feature(const Plain& opponents, int px, int py, double ppd, bool edge) {
    const double sd = 0.5 * 0.082 * ppd;
    const int r = int(std::ceil(3 * sd));
    const auto weight = [&](int u, int v) {
        const double g = std::exp(-(u * u + v * v) / (2 * sd * sd));
        return edge ? -u * g : (u * u / (sd * sd) - 1) * g;
    };
    double positive = 0, negative = 0;
    for (int dy = -r; dy <= r; ++dy)
        for (int dx = -r; dx <= r; ++dx) (weight(dx, dy) > 0 ? positive : negative) += std::fabs(weight(dx, dy));
    double gx = 0, gy = 0;
    for (int dy = -r; dy <= r; ++dy)
        for (int dx = -r; dx <= r; ++dx) {
            const double y = (opponents.at(px + dx, py + dy)[0] + 16) / 116;
            const double wx = weight(dx, dy), wy = weight(dy, dx);
            gx += y * wx / (wx > 0 ? positive : negative);
            gy += y * wy / (wy > 0 ? positive : negative);
        }
    return std::sqrt(gx * gx + gy * gy);
}

double hyab(const Vec& a, const Vec& b) { return std::fabs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }

TEST(Flip, matchesItsDefinitionInColour) {
    const int width = 36, height = 28;
    const double ppd = 67.020643;
    std::array<Plane, 3> reference, test;
    Plain a{width, height, {}}, b{width, height, {}};
    for (size_t c = 0; c < 3; ++c) reference[c] = test[c] = Plane(uint32_t(width), uint32_t(height));
    for (int i = 0; i < width * height; ++i) {
        const int x = i % width, y = i / width;
        Vec p, q;
        for (int c = 0; c < 3; ++c) {
            const bool inside = x > 8 + c && x < 25 && y > 7 && y < 18 - c;
            reference[size_t(c)].values[size_t(i)] = float(p[size_t(c)] = inside ? 0.9 - 0.2 * c : 0.15 + 0.01 * x);
            test[size_t(c)].values[size_t(i)] = float(q[size_t(c)] = (x + y + c) % 7 == 0 ? 0.5 : p[size_t(c)] * (0.8 + 0.1 * c));
        }
        a.pixels.push_back(opponent(p));
        b.pixels.push_back(opponent(q));
    }
    const Plane map = flip(reference, test);
    const double largest = std::pow(hyab(labOfOpponent(opponent({0, 1, 0})), labOfOpponent(opponent({0, 0, 1}))), 0.7);
    EXPECT_NEAR(std::pow(largest, 1 / 0.7), kGreenToBlue, 0.05);
    for (int y = 0; y < height; y += 3)
        for (int x = 0; x < width; x += 3) {
            const double d = std::pow(hyab(perceivedLab(a, x, y, ppd), perceivedLab(b, x, y, ppd)), 0.7);
            const double color = d < 0.4 * largest ? 0.95 / (0.4 * largest) * d : 0.95 + (d - 0.4 * largest) / (0.6 * largest) * 0.05;
            const double edges = std::fabs(feature(a, x, y, ppd, true) - feature(b, x, y, ppd, true));
            const double points = std::fabs(feature(a, x, y, ppd, false) - feature(b, x, y, ppd, false));
            EXPECT_NEAR(map.at(uint32_t(x), uint32_t(y)), std::pow(color, 1 - std::sqrt(std::max(edges, points) / std::sqrt(2.0))), 2e-3)
                << x << ", " << y;
        }
}

}  // namespace
