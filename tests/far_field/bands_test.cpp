// Banding: the error around a tall box must have no peak at the frequency of the azimuth directions.
#include <complex>

#include "far_field/fixture.h"

namespace obscura::test {
namespace {

constexpr uint32_t kSize = 256, kGuard = 24, kSide = kSize - 2 * kGuard;
constexpr double kTurn = 6.283185307179586, kPlane = 6.0, kTop = 2.0;

// A plane 6 m away with a box 4 m high, rotated and off the middle of the image, so that it has no symmetry with the directions. Around a
// symmetric occluder the error would repeat after half a turn and every second frequency would be 0.
struct Box {
    double u, v, turn, halfLength, halfWidth;
};  // px from the middle of the image; radians
Room tallBox(const Box& box) {
    Room room;
    room.width = room.height = kSize;
    room.guard = kGuard;
    room.build();
    for (uint32_t y = 0; y < kSize; ++y) {
        for (uint32_t x = 0; x < kSize; ++x) {
            const size_t i = size_t(y) * kSize + x;
            const double u = double(x) - 127.5 - box.u, v = double(y) - 127.5 - box.v, c = std::cos(box.turn), s = std::sin(box.turn);
            const bool onBox = std::abs(c * u + s * v) < box.halfLength && std::abs(c * v - s * u) < box.halfWidth;
            room.depth[i] = float(onBox ? kTop : kPlane);
            room.normals[4 * i + 1] = 0.0f;
            room.normals[4 * i + 2] = 1.0f;
        }
    }
    return room;
}

// Reference: obscurance at pixel (x, y) of the plane, by rays marched through the same depth buffer. The box has the same pixel outline as
// for the method, and infinite thickness. A ray projects to a line, so it suffices to know where lines of each angle enter the box.
double obscuranceOfRays(const Room& room, const Box& box, int x, int y, double length) {
    constexpr int kAngles = 1440, kAround = 720, kUp = 32;
    const double focal = 0.5 * kSize * double(room.projection[0]),
                 depth = kPlane - kPlane / focal;  // one pixel footprint above the plane, like the methods
    const double p[2] = {(x + 0.5 - 128.0) / focal * kPlane, (y + 0.5 - 128.0) / focal * kPlane};
    const double seen[2] = {p[0] / depth * focal + 128.0, p[1] / depth * focal + 128.0};
    const double aside[2] = {128.0 + box.u - seen[0], 128.0 + box.v - seen[1]}, distance = std::hypot(aside[0], aside[1]);
    std::vector<double> enters(kAngles, -1.0);
    for (int i = 0; i < kAngles; ++i) {
        const double d[2] = {std::cos(kTurn * (i + 0.5) / kAngles), std::sin(kTurn * (i + 0.5) / kAngles)},
                     reach = box.halfLength + box.halfWidth;
        if (d[0] * aside[0] + d[1] * aside[1] < 0.0 || std::abs(d[1] * aside[0] - d[0] * aside[1]) > reach) continue;
        const auto inside = [&](double t) {
            return room.depth[size_t(seen[1] + t * d[1]) * kSize + size_t(seen[0] + t * d[0])] < float(kPlane);
        };
        double t = std::max(distance - reach, 0.0);
        while (t < distance + reach && !inside(t)) t += 0.4;
        if (t < distance + reach) enters[i] = t;
        for (int back = 0; back < 8 && enters[i] >= 0.0 && inside(t -= 0.05); ++back) enters[i] = t;
    }
    double blocked = 0.0;
    const double passing =
        box.halfLength + box.halfWidth + distance * kTurn / kAngles;  // px from the middle of the box: lines farther away miss it
    for (int i = 0; i < kAround; ++i) {
        const double azimuth = kTurn * (i + 0.5) / kAround, c = std::cos(azimuth), s = std::sin(azimuth);
        if (c * aside[0] + s * aside[1] < 0.0) continue;
        for (int k = 0; k < kUp; ++k) {
            const double square = (k + 0.5) / kUp, sine = std::sqrt(square), up = std::sqrt(1.0 - square);
            const double g[2] = {focal * (sine * c + p[0] / depth * up), focal * (sine * s + p[1] / depth * up)};
            const double cross = g[1] * aside[0] - g[0] * aside[1];
            if (cross * cross > passing * passing * (g[0] * g[0] + g[1] * g[1])) continue;
            const double angle = std::atan2(g[1], g[0]) / kTurn, t = enters[int((angle < 0.0 ? angle + 1.0 : angle) * kAngles) % kAngles];
            const double hit = t * depth / (std::hypot(g[0], g[1]) + t * up);  // metres along the ray
            if (t >= 0.0 && depth - hit * up > kTop) blocked += std::exp(-hit / length);
        }
    }
    return blocked / (kAround * kUp);
}

// The error is sampled on circles around the box.
constexpr int kAzimuths = 256, kRings = 13, kMaxFrequency = 40;
struct RingPoint {
    int x, y;  // of the visible part; the error is interpolated between this pixel and the three after it
    double fx, fy;
};
RingPoint onRing(const Box& box, int ring, int i) {
    const double a = kTurn * i / kAzimuths, radius = 30.0 + 5.0 * ring, middle = 0.5 * kSide - 0.5;
    const double x = middle + box.u + radius * std::cos(a), y = middle + box.v + radius * std::sin(a);
    return {int(x), int(y), x - int(x), y - int(y)};
}

// Reference obscurance at the pixels of the rings, -1 elsewhere.
Picture referenceOf(const Room& room, const Box& box, double length) {
    Picture result(size_t(kSide) * kSide, -1.0f);
    for (int i = 0; i < kRings * kAzimuths; ++i) {
        const RingPoint spot = onRing(box, i / kAzimuths, i % kAzimuths);
        for (int corner = 0; corner < 4; ++corner) {
            const int x = spot.x + corner % 2, y = spot.y + corner / 2;
            float& value = result[size_t(y) * kSide + x];
            if (value < 0.0f) value = float(obscuranceOfRays(room, box, x + int(kGuard), y + int(kGuard), length));
        }
    }
    return result;
}

// Fourier transform of the error along each ring around one box, frequencies 0 ... kMaxFrequency per turn, ring by ring.
using Spectrum = std::vector<std::complex<double>>;
Spectrum spectrumOf(const Picture& picture, const Picture& reference, const Box& box) {
    Spectrum spectrum(kRings * (kMaxFrequency + 1));
    for (int ring = 0; ring < kRings; ++ring) {
        std::vector<double> error(kAzimuths);
        for (int i = 0; i < kAzimuths; ++i) {
            const RingPoint s = onRing(box, ring, i);
            const auto at = [&](int u, int v) {
                const size_t p = size_t(s.y + v) * kSide + size_t(s.x + u);
                return double(picture[p]) - double(reference[p]);
            };
            error[i] = (at(0, 0) * (1 - s.fx) + at(1, 0) * s.fx) * (1 - s.fy) + (at(0, 1) * (1 - s.fx) + at(1, 1) * s.fx) * s.fy;
        }
        for (int f = 0; f <= kMaxFrequency; ++f)
            for (int i = 0; i < kAzimuths; ++i)
                spectrum[ring * (kMaxFrequency + 1) + f] += error[i] * std::polar(1.0 / kAzimuths, -kTurn * double(f) * i / kAzimuths);
    }
    return spectrum;
}

// Power by frequency, mean over the rings.
std::vector<double> powerOf(const Spectrum& spectrum) {
    std::vector<double> power(kMaxFrequency + 1, 0.0);
    for (size_t i = 0; i < spectrum.size(); ++i) power[i % (kMaxFrequency + 1)] += std::norm(spectrum[i]) / kRings;
    return power;
}

// The strongest frequency in 1 ... kMaxFrequency: its amplitude, and its power as a multiple of the median power.
struct Peak {
    double amplitude;
    int frequency;
    double medians;
};
Peak peakOf(const std::vector<double>& power) {
    const auto highest = std::max_element(power.begin() + 1, power.end());
    std::vector<double> sorted(power.begin() + 1, power.end());
    std::sort(sorted.begin(), sorted.end());
    return {2.0 * std::sqrt(*highest), int(highest - power.begin()), *highest / sorted[sorted.size() / 2]};
}

class FarFieldBands : public FarFieldTest {};

// The shape of a single box causes frequencies of its own. Those rotate with the box, while bands of the directions do not, so the mean
// error of eight rotated boxes shows only the bands.
TEST_F(FarFieldBands, noFrequencyExceedsThreeTimesTheMedian) {
    constexpr int kBoxes = 8;
    std::vector<Box> boxes;
    std::vector<Room> rooms;
    std::vector<Picture> references;
    for (int i = 0; i < kBoxes; ++i) {
        boxes.push_back({9.0 * std::cos(2.4 * i), 9.0 * std::sin(2.4 * i), 0.5 * kTurn * (i + 0.3) / kBoxes, 13.4, 8.7});
        rooms.push_back(tallBox(boxes[i]));
        references.push_back(referenceOf(rooms[i], boxes[i], 3.0));
    }
    struct Bands {
        Peak each, together;
    };
    const auto bands = [&](const char* name, const char* preset, const Changes& changes) {
        std::vector<double> power(kMaxFrequency + 1, 0.0);
        Spectrum mean(kRings * (kMaxFrequency + 1));
        for (int i = 0; i < kBoxes; ++i) {
            const Spectrum spectrum = spectrumOf(run(rooms[i], values(changes, preset), "exponential:3"), references[i], boxes[i]);
            const std::vector<double> one = powerOf(spectrum);
            for (int f = 0; f <= kMaxFrequency; ++f) power[f] += one[f] / kBoxes;
            for (size_t w = 0; w < spectrum.size(); ++w) mean[w] += spectrum[w] / double(kBoxes);
        }
        const Bands result{peakOf(power), peakOf(powerOf(mean))};
        printf("%-16s highest peak at %2d per turn, %.4f, %5.1f medians; in the mean error at %2d per turn, %.4f\n", name,
            result.each.frequency, result.each.amplitude, result.each.medians, result.together.frequency, result.together.amplitude);
        return result;
    };
    const Bands improved = bands("default", "default", {});
    EXPECT_LE(improved.each.medians, 3.0);
    EXPECT_LE(improved.together.amplitude, 0.2 / 255.0);
    // The test detects bands: those of the paper's preset, those without alternating directions, those of fewer directions.
    const Bands paper = bands("paper_8x2", "paper_8x2", {}), straight = bands("not alternating", "default", {{"alternate", 0}});
    const Bands fewer = bands("8x3", "default", {{"directions", 8}, {"segments", 3}});
    EXPECT_GT(paper.each.medians, 10.0);
    EXPECT_EQ(paper.together.frequency, 16);
    EXPECT_GT(straight.each.medians, 10.0);
    EXPECT_EQ(straight.together.frequency, 24);
    EXPECT_GT(fewer.each.medians, 4.0);
    EXPECT_EQ(fewer.together.frequency, 8);
    EXPECT_GT(bands("longest 1", "default", {{"longest", 1}}).each.medians, 4.0);
}

}  // namespace
}  // namespace obscura::test
