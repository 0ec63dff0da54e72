// Bands: what a tall box casts on the plane beside it must not show in how many directions the picture was cut. And what a frame costs must not
// show in the falloff.
#include <complex>
#include <iterator>

#include <fmt/format.h>

#include "far_field/bench.h"

namespace obscura::test {
namespace {

constexpr uint32_t kSize = 256, kGuard = 24;

// A plane 6 m away with a box 4 m high in the middle, turned so that its symmetries are not those of the directions.
Room tallBox() {
    Room room;
    room.width = room.height = kSize;
    room.guard = kGuard;
    room.build();
    for (uint32_t y = 0; y < kSize; ++y) {
        for (uint32_t x = 0; x < kSize; ++x) {
            const size_t i = size_t(y) * kSize + x;
            const float u = float(x) - 127.5f, v = float(y) - 127.5f;
            const bool onBox = std::abs(0.9511f * u + 0.3090f * v) < 15.0f && std::abs(0.9511f * v - 0.3090f * u) < 8.0f;
            room.depth[i] = onBox ? 2.0f : 6.0f;
            room.normals[4 * i + 1] = 0.0f;
            room.normals[4 * i + 2] = 1.0f;
        }
    }
    return room;
}

// What the box hides from a point of the plane, seen at (u, v) pixels from the picture's middle: rays against the solid behind the box's top, which
// five planes bound. No directions but those of the rays: dense, and as many in every picture.
double exactVisibility(const Room& room, double u, double v) {
    const double focal = 0.5 * kSize * double(room.projection[0]);
    const double p[3] = {6.0 * u / focal, 6.0 * v / focal, 6.0 - 6.0 / focal};  // a footprint above the plane, as methods have it
    constexpr double a[2] = {0.9511, 0.3090};
    const double wide = 15.0 / focal, high = 8.0 / focal;
    const double planes[5][4] = {{a[0], a[1], -wide, 0}, {-a[0], -a[1], -wide, 0}, {-a[1], a[0], -high, 0}, {a[1], -a[0], -high, 0}, {0, 0, -1, 2}};
    constexpr int kAround = 360, kUp = 64;
    double blocked = 0.0;
    for (int i = 0; i < kAround; ++i) {
        const double azimuth = 6.283185307179586 * (i + 0.5) / kAround;
        for (int k = 0; k < kUp; ++k) {
            const double square = (k + 0.5) / kUp, sine = std::sqrt(square);
            const double d[3] = {sine * std::cos(azimuth), sine * std::sin(azimuth), -std::sqrt(1.0 - square)};
            double enters = 0.0, leaves = 1e9;
            for (const auto& plane : planes) {
                const double at = plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3], grows = plane[0] * d[0] + plane[1] * d[1] + plane[2] * d[2];
                if (grows > 0.0) leaves = std::min(leaves, -at / grows);
                else if (grows < 0.0) enters = std::max(enters, -at / grows);
                else if (at > 0.0) leaves = -1.0;
            }
            if (enters < leaves) blocked += std::exp(-enters / 3.0);
        }
    }
    return 1.0 - blocked / (kAround * kUp);
}

constexpr int kAzimuths = 256, kRings = 13;
// Where the error is looked at: circles around the box, u and v in pixels from the picture's middle.
std::array<double, 2> onRing(int ring, int i) {
    const double a = 6.283185307179586 * i / kAzimuths, radius = 30.0 + 5.0 * ring;
    return {radius * std::cos(a), radius * std::sin(a)};
}

// Power of the error over azimuth around the box, frequencies 1 ... 40 a turn, mean over rings.
std::vector<double> spectrum(const Picture& picture, const std::vector<double>& exact) {
    const uint32_t side = kSize - 2 * kGuard;
    std::vector<double> power(41, 0.0);
    for (int ring = 0; ring < kRings; ++ring) {
        std::vector<double> error(kAzimuths);
        for (int i = 0; i < kAzimuths; ++i) {
            const double x = onRing(ring, i)[0] + 0.5 * side - 0.5, y = onRing(ring, i)[1] + 0.5 * side - 0.5;
            const int ix = int(x), iy = int(y);
            const auto at = [&](int u, int v) { return double(picture[size_t(v) * side + u]); };
            const double fx = x - ix, fy = y - iy;
            error[i] = (at(ix, iy) * (1 - fx) + at(ix + 1, iy) * fx) * (1 - fy) + (at(ix, iy + 1) * (1 - fx) + at(ix + 1, iy + 1) * fx) * fy - exact[ring * kAzimuths + i];
        }
        for (size_t f = 1; f < power.size(); ++f) {
            std::complex<double> sum = 0.0;
            for (int i = 0; i < kAzimuths; ++i) sum += error[i] * std::polar(1.0, -6.283185307179586 * double(f) * i / kAzimuths);
            power[f] += std::norm(sum) / kAzimuths / kAzimuths / kRings;
        }
    }
    return {power.begin() + 1, power.end()};
}

class FarFieldBands : public FarFieldTest {};

TEST_F(FarFieldBands, bandsStayBelowOneStepOfEightBits) {
    const Room room = tallBox();
    const char* falloff = "exponential:3";
    std::vector<double> exact;
    for (int ring = 0; ring < kRings; ++ring)
        for (int i = 0; i < kAzimuths; ++i) exact.push_back(exactVisibility(room, onRing(ring, i)[0], onRing(ring, i)[1]));
    // What a finite number of directions leaves is a line at as many a turn as there are segments. Slower waves stay with 32 x 8
    // segments as well, so more directions do not take them out; whether they come from the box, a staircase of pixels where the exact one has
    // edges, is not known.
    struct Case { const char* preset; std::vector<ao::Setting> settings; size_t segments; };
    double worst[4];
    const Case cases[] = {{"default", {}, 24}, {"default", {{"alternate", 0}}, 24}, {"paper_8x2", {}, 16},
                          {"default", {{"directions", 32}, {"segments", 8}, {"interval", 3}}, 24}};
    const char* const names[] = {"default", "not alternating", "paper_8x2", "32x8"};
    for (size_t i = 0; i < std::size(cases); ++i) {
        const std::vector<double> power = spectrum(run(room, values(cases[i].settings, cases[i].preset), falloff), exact);
        std::vector<double> sorted = power;
        std::sort(sorted.begin(), sorted.end());
        const double median = sorted[sorted.size() / 2];
        const auto say = [&](size_t turn) { return fmt::format("{} a turn {:.4f}, {:.1f} medians", turn, 2.0 * std::sqrt(power[turn - 1]), power[turn - 1] / median); };
        const size_t line = cases[i].segments;
        const size_t peak = size_t(std::max_element(power.begin() + 4, power.end()) - power.begin()) + 1;
        worst[i] = power[line - 1];
        printf("%-15s strongest above 4 a turn: %s; of its segments: %s; a median is %.5f\n", names[i], say(peak).c_str(), say(line).c_str(), 2.0 * std::sqrt(median));
        EXPECT_LT(2.0 * std::sqrt(power[peak - 1]), 1.0 / 255.0) << names[i];
        if (i == 0) EXPECT_LT(power[line - 1], 3.0 * median);
    }
    EXPECT_LT(worst[0], 0.1 * worst[1]) << "alternation takes it out";
}

TEST_F(FarFieldBands, everyFalloffCostsTheSame) {
    const Room room = crease(200, 150, 20);
    const char* const falloffs[] = {"exponential:0.25", "exponential:1", "exponential:100", "wendland:2", "constant:1", "ramp:0.385:1", "exponential:1"};
    constexpr size_t kCount = std::size(falloffs), kOnce = 1, kAgain = kCount - 1;  // one is timed twice, to know what the machine adds
    double best[kCount], ratio = 0.0;
    std::fill_n(best, kCount, 1e9);
    for (int round = 0; round < 40; ++round) {  // the least of many: others may be using the machine
        for (size_t i = 0; i < kCount; ++i) {
            for (int frame = 0; frame < 3; ++frame) run(room, values({}), falloffs[i]);  // times arrive frames later
            for (const graph::PassTime& pass : m_graph->timings().passes)
                if (pass.name == "far_field.obscurance") best[i] = std::min(best[i], pass.milliseconds);
        }
        ratio = *std::max_element(best, best + kCount) / *std::min_element(best, best + kCount);
        if (round >= 2 && ratio <= 1.05) break;
    }
    for (size_t i = 0; i < kCount; ++i) printf("%-16s %.2f ms\n", falloffs[i], best[i]);
    const double noise = std::max(best[kOnce], best[kAgain]) / std::min(best[kOnce], best[kAgain]);
    if (ratio > 1.05 && noise > 1.02) GTEST_SKIP() << "the machine is busy: one falloff's own times differ by " << 100.0 * (noise - 1.0) << " %";
    EXPECT_LE(ratio, 1.05);
}

}  // namespace
}  // namespace obscura::test
