// Bands: what a tall box casts on the plane beside it must not show in how many directions the picture was cut. And what a frame costs must not
// show in the falloff.
#include <complex>
#include <iterator>

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

// Power of the error over azimuth around the box, frequencies 1 ... 40 a turn, mean over rings.
std::vector<double> spectrum(const Picture& picture, const Picture& reference) {
    const uint32_t side = kSize - 2 * kGuard;
    const int count = 256;
    std::vector<double> power(41, 0.0);
    const int rings = 65;
    for (int ring = 0; ring < rings; ++ring) {
        const double radius = 30.0 + ring;
        std::vector<double> error(count);
        for (int i = 0; i < count; ++i) {
            const double a = 6.283185307179586 * i / count, x = side / 2.0 + radius * std::cos(a) - 0.5, y = side / 2.0 + radius * std::sin(a) - 0.5;
            const int ix = int(x), iy = int(y);
            const auto at = [&](int u, int v) { const size_t k = size_t(v) * side + u; return double(picture[k]) - double(reference[k]); };
            const double fx = x - ix, fy = y - iy;
            error[i] = (at(ix, iy) * (1 - fx) + at(ix + 1, iy) * fx) * (1 - fy) + (at(ix, iy + 1) * (1 - fx) + at(ix + 1, iy + 1) * fx) * fy;
        }
        for (size_t f = 1; f < power.size(); ++f) {
            std::complex<double> sum = 0.0;
            for (int i = 0; i < count; ++i) sum += error[i] * std::polar(1.0, -6.283185307179586 * double(f) * i / count);
            power[f] += std::norm(sum) / count / count / rings;
        }
    }
    return {power.begin() + 1, power.end()};
}

class FarFieldBands : public FarFieldTest {};

TEST_F(FarFieldBands, bandsStayBelowOneStepOfEightBits) {
    const Room room = tallBox();
    const char* falloff = "exponential:3";
    const Picture reference = run(room, values({{"directions", 32}, {"segments", 8}, {"interval", 3}}), falloff);
    for (const char* preset : {"default", "paper_8x2"}) {
        std::vector<double> power = spectrum(run(room, values({}, preset), falloff), reference);
        std::vector<double> sorted = power;
        std::sort(sorted.begin(), sorted.end());
        const size_t peak = size_t(std::max_element(power.begin() + 4, power.end()) - power.begin());
        const double amplitude = 2.0 * std::sqrt(power[peak]);
        printf("%-9s strongest band above frequency 4: %zu a turn, amplitude %.4f, %.1f medians of power\n", preset, peak + 1, amplitude, power[peak] / sorted[sorted.size() / 2]);
        EXPECT_LT(amplitude, 1.0 / 255.0) << preset;
    }
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
