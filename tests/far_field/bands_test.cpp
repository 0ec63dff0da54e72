// Bands: what a tall box casts on the plane beside it must not show in how many directions the picture was cut.
#include <complex>

#include "far_field/bench.h"

namespace obscura::test {
namespace {

constexpr uint32_t kSize = 256, kGuard = 24, kSide = kSize - 2 * kGuard;
constexpr double kTurn = 6.283185307179586, kPlane = 6.0, kTop = 2.0;

// A plane 6 m away with a box 4 m high: turned, and beside the picture's middle, so that it has no symmetry with the directions; about a point every
// error would be the same half a turn on, and every other frequency 0.
struct Box { double u, v, turn, halfLength, halfWidth; };  // pixels from the picture's middle; radians
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

// What rays say that are marched through the same depth buffer from the plane at pixel (x, y): obscurance. The box is as ragged for them as for the
// method, and reaches as far behind its top. A ray's picture is a line, so all that is needed is where lines of each angle enter the box.
double obscuranceOfRays(const Room& room, const Box& box, int x, int y, double length) {
    constexpr int kAngles = 1440, kAround = 720, kUp = 32;
    const double focal = 0.5 * kSize * double(room.projection[0]), depth = kPlane - kPlane / focal;  // a footprint above the plane, as methods have it
    const double p[2] = {(x + 0.5 - 128.0) / focal * kPlane, (y + 0.5 - 128.0) / focal * kPlane};
    const double seen[2] = {p[0] / depth * focal + 128.0, p[1] / depth * focal + 128.0};
    const double aside[2] = {128.0 + box.u - seen[0], 128.0 + box.v - seen[1]}, distance = std::hypot(aside[0], aside[1]);
    std::vector<double> enters(kAngles, -1.0);
    for (int i = 0; i < kAngles; ++i) {
        const double d[2] = {std::cos(kTurn * (i + 0.5) / kAngles), std::sin(kTurn * (i + 0.5) / kAngles)}, reach = box.halfLength + box.halfWidth;
        if (d[0] * aside[0] + d[1] * aside[1] < 0.0 || std::abs(d[1] * aside[0] - d[0] * aside[1]) > reach) continue;
        const auto inside = [&](double t) { return room.depth[size_t(seen[1] + t * d[1]) * kSize + size_t(seen[0] + t * d[0])] < float(kPlane); };
        double t = std::max(distance - reach, 0.0);
        while (t < distance + reach && !inside(t)) t += 0.4;
        if (t < distance + reach) enters[i] = t;
        for (int back = 0; back < 8 && enters[i] >= 0.0 && inside(t -= 0.05); ++back) enters[i] = t;
    }
    double blocked = 0.0;
    const double passing = box.halfLength + box.halfWidth + distance * kTurn / kAngles;  // px from the box's middle: such lines miss it
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

// Where the error is looked at: circles around the box.
constexpr int kAzimuths = 256, kRings = 13, kMost = 40;
struct Spot {
    int x, y;      // of the visible part; the error is interpolated between this pixel and the three after it
    double fx, fy;
};
Spot onRing(const Box& box, int ring, int i) {
    const double a = kTurn * i / kAzimuths, radius = 30.0 + 5.0 * ring, middle = 0.5 * kSide - 0.5;
    const double x = middle + box.u + radius * std::cos(a), y = middle + box.v + radius * std::sin(a);
    return {int(x), int(y), x - int(x), y - int(y)};
}

// The rays' obscurance wherever a ring needs it, -1 elsewhere.
Picture referenceOf(const Room& room, const Box& box, double length) {
    Picture result(size_t(kSide) * kSide, -1.0f);
    for (int i = 0; i < kRings * kAzimuths; ++i) {
        const Spot spot = onRing(box, i / kAzimuths, i % kAzimuths);
        for (int corner = 0; corner < 4; ++corner) {
            const int x = spot.x + corner % 2, y = spot.y + corner / 2;
            float& value = result[size_t(y) * kSide + x];
            if (value < 0.0f) value = float(obscuranceOfRays(room, box, x + int(kGuard), y + int(kGuard), length));
        }
    }
    return result;
}

// The error's waves around one box, of one ring after the other: 0 ... kMost a turn.
using Waves = std::vector<std::complex<double>>;
Waves wavesOf(const Picture& picture, const Picture& reference, const Box& box) {
    Waves waves(kRings * (kMost + 1));
    for (int ring = 0; ring < kRings; ++ring) {
        std::vector<double> error(kAzimuths);
        for (int i = 0; i < kAzimuths; ++i) {
            const Spot s = onRing(box, ring, i);
            const auto at = [&](int u, int v) {
                const size_t p = size_t(s.y + v) * kSide + size_t(s.x + u);
                return double(picture[p]) - double(reference[p]);
            };
            error[i] = (at(0, 0) * (1 - s.fx) + at(1, 0) * s.fx) * (1 - s.fy) + (at(0, 1) * (1 - s.fx) + at(1, 1) * s.fx) * s.fy;
        }
        for (int f = 0; f <= kMost; ++f)
            for (int i = 0; i < kAzimuths; ++i) waves[ring * (kMost + 1) + f] += error[i] * std::polar(1.0 / kAzimuths, -kTurn * double(f) * i / kAzimuths);
    }
    return waves;
}

// Mean power over the rings, by waves a turn.
std::vector<double> powerOf(const Waves& waves) {
    std::vector<double> power(kMost + 1, 0.0);
    for (size_t i = 0; i < waves.size(); ++i) power[i % (kMost + 1)] += std::norm(waves[i]) / kRings;
    return power;
}

// Over 1 ... kMost waves a turn: amplitude of the strongest, which that is, its power in medians of all of them.
struct Peak { double amplitude; int frequency; double medians; };
Peak peakOf(const std::vector<double>& power) {
    const auto highest = std::max_element(power.begin() + 1, power.end());
    std::vector<double> sorted(power.begin() + 1, power.end());
    std::sort(sorted.begin(), sorted.end());
    return {2.0 * std::sqrt(*highest), int(highest - power.begin()), *highest / sorted[sorted.size() / 2]};
}

class FarFieldBands : public FarFieldTest {};

// Eight boxes, each turned further, stand for one: a single one's sides and ends are not as far away as each other, nor as wrong, and make waves of
// their own. What directions leave keeps its place when the box turns, so the mean of the eight errors shows it alone, down to what no picture shows.
TEST_F(FarFieldBands, noPeakIsAboveThreeMedians) {
    constexpr int kBoxes = 8;
    std::vector<Box> boxes;
    std::vector<Room> rooms;
    std::vector<Picture> references;
    for (int i = 0; i < kBoxes; ++i) {
        boxes.push_back({9.0 * std::cos(2.4 * i), 9.0 * std::sin(2.4 * i), 0.5 * kTurn * (i + 0.3) / kBoxes, 13.4, 8.7});
        rooms.push_back(tallBox(boxes[i]));
        references.push_back(referenceOf(rooms[i], boxes[i], 3.0));
    }
    struct Bands { Peak each, together; };
    const auto bands = [&](const char* name, const char* preset, const Changes& changes) {
        std::vector<double> power(kMost + 1, 0.0);
        Waves mean(kRings * (kMost + 1));
        for (int i = 0; i < kBoxes; ++i) {
            const Waves waves = wavesOf(run(rooms[i], values(changes, preset), "exponential:3"), references[i], boxes[i]);
            const std::vector<double> one = powerOf(waves);
            for (int f = 0; f <= kMost; ++f) power[f] += one[f] / kBoxes;
            for (size_t w = 0; w < waves.size(); ++w) mean[w] += waves[w] / double(kBoxes);
        }
        const Bands result{peakOf(power), peakOf(powerOf(mean))};
        printf("%-16s highest peak %2d a turn, %.4f, %5.1f medians; in the mean error %2d a turn, %.4f\n", name, result.each.frequency,
               result.each.amplitude, result.each.medians, result.together.frequency, result.together.amplitude);
        return result;
    };
    const Bands improved = bands("default", "default", {});
    EXPECT_LE(improved.each.medians, 3.0);
    EXPECT_LE(improved.together.amplitude, 0.2 / 255.0);
    // It tells bands where there are some: the paper's, those that alternation takes out, those of fewer directions with as many segments.
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
