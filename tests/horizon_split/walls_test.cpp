// A wall on a floor against its exact obscurance, and the influence of the parameters there.
#include "horizon_split/fixture.h"

namespace obscura::test {
namespace {

constexpr double kPi = 3.14159265358979;

// Obscurance of a floor point `a` metres from an infinite wall, falloff 1 - d/R: 1/pi times the integral over the
// hemisphere of rho cos, where a ray of azimuth phi and elevation t meets the wall at a / (cos phi cos t).
double exactAtWall(double a, double reach) {
    const int n = 400;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        const double phi = (i + 0.5) / n * kPi - kPi / 2;
        for (int j = 0; j < n; ++j) {
            const double sine2 = (j + 0.5) / n;  // equal steps of sine^2 are equal cosine-weighted solid angles
            sum += std::max(1.0 - a / (std::cos(phi) * std::sqrt(1.0 - sine2)) / reach, 0.0);
        }
    }
    return sum / (2.0 * n * n);
}

TEST_F(HorizonSplitTest, infiniteWallMatchesTheExactValueAtEveryDistance) {
    // Check of the integral against independently computed values.
    for (const auto& [a, exact] : {std::pair{0.10, 0.3556}, {0.25, 0.2361}, {0.50, 0.1178}, {1.0, 0.0174}})
        EXPECT_NEAR(exactAtWall(a, 1.5), exact, 5e-4);
    const Room room = crease();
    // A line that meets the wall at a slant climbs it slowly: a few per cent are missing in the limit, more with few samples.
    const ao::Values fine = values({{"directions", 24}, {"steps", 64}, {"thickness", 100}, {"horizon_thickness", 100}, {"blur", 0}});
    for (const auto& [what, tolerance] : {std::pair{fine, 0.03}, {values({}), 0.06}, {values({}, "paper"), 0.08}}) {
        const Picture picture = run(room, what);
        int rows = 0;
        double before = 0.0;
        for (uint32_t y = room.visibleHeight(); y-- > 0;) {  // towards the wall: darker and darker
            const size_t i = size_t(y + room.guard) * room.width + room.width / 2;
            const double a = -room.wall - room.depth[i];
            if (room.normals[4 * i + 1] < 0.5f || a < 0.06 || a > 1.8) continue;  // nearer than 0.06 m a pixel is larger than the distance
            const double now = rowMean(room, picture, y);
            EXPECT_NEAR(now, exactAtWall(a, 1.5), tolerance) << a << " m from the wall";
            EXPECT_GT(now, before - 0.004) << a << " m from the wall";
            before = now;
            ++rows;
        }
        EXPECT_GT(rows, 20);
    }
}

TEST_F(HorizonSplitTest, moreSamplesKeepTheLimit) {
    const Room room = crease();
    const double limit = mean(run(room, values({{"directions", 24}, {"steps", 18}, {"normal_rays", 4}})));
    EXPECT_GT(limit, 0.02);
    // An odd count's last direction has no partner; beyond 8 directions the horizons fill more than one row of words.
    for (const float directions : {5.0f, 6.0f, 7.0f, 8.0f, 9.0f, 16.0f, 17.0f, 24.0f})
        EXPECT_NEAR(mean(run(room, values({{"directions", directions}}))), limit, 0.06 * limit) << directions;
    for (const float rays : {1.0f, 2.0f, 5.0f, 8.0f})
        EXPECT_NEAR(mean(run(room, values({{"normal_rays", rays}}))), limit, 0.06 * limit) << rays;
}

TEST_F(HorizonSplitTest, rayMarchingConvergesToTheSameResult) {
    const Room room = crease();
    const Picture split =
        run(room, values({{"directions", 24}, {"steps", 64}, {"normal_rays", 2}, {"thickness", 100}, {"horizon_thickness", 100}}));
    const Picture marched =
        run(room, values({{"directions", 24}, {"steps", 64}, {"normal_rays", 8}, {"thickness", 100}, {"term", kMarching}}));
    double difference = 0.0;
    for (size_t i = 0; i < split.size(); ++i) difference += std::abs(split[i] - marched[i]);
    EXPECT_LT(difference / double(split.size()), 0.01);
    EXPECT_GT(mean(marched), 0.02);
    // With few rays the result differs.
    EXPECT_NE(run(room, values({{"normal_rays", 2}, {"term", kMarching}})), run(room, values({{"normal_rays", 2}})));
}

TEST_F(HorizonSplitTest, longerFalloffBlocksMore) {
    const Room room = crease();
    for (const char* kind : {"constant", "linear", "quadratic", "wendland", "exponential"}) {
        double before = 0.0;
        for (const char* length : {"0.25", "0.5", "1", "2"}) {
            const double now = mean(run(room, values({{"steps", 32}}), (std::string(kind) + ":" + length).c_str()));
            EXPECT_GT(now, before) << kind << ":" << length;
            before = now;
        }
    }
}

TEST_F(HorizonSplitTest, radiusTruncatesTheFalloff) {
    const Room room = crease();
    const ao::Values cut = values({{"radius", 0.5f}}), whole = values({});
    EXPECT_EQ(run(room, cut, "constant:2"), run(room, whole, "constant:0.5"));
    EXPECT_EQ(run(room, values({{"radius", 50}}), "linear:1.5"), run(room, whole, "linear:1.5"));
}

TEST_F(HorizonSplitTest, bothBlursReduceNoiseAndKeepTheMean) {
    const Room room = crease();
    const Picture raw = run(room, values({{"blur", 0}}));
    for (const float blur : {1.0f, 2.0f}) {
        const Picture smooth = run(room, values({{"blur", blur}}));
        EXPECT_NEAR(mean(smooth), mean(raw), 0.02 * mean(raw));
        const auto roughness = [&](const Picture& picture) {
            double sum = 0.0;
            for (size_t i = 1; i < picture.size(); ++i) sum += std::abs(picture[i] - picture[i - 1]);
            return sum;
        };
        EXPECT_LT(roughness(smooth), 0.5 * roughness(raw)) << blur;
    }
}

TEST_F(HorizonSplitTest, paperBlurStopsAtDepthEdges) {
    // A bare wall in front: obscurance behind it must not blur across its edge.
    Room room = crease();
    for (uint32_t y = 0; y < room.height; ++y)
        for (uint32_t x = 0; x < room.width / 2; ++x) {
            const size_t i = size_t(y) * room.width + x;
            room.depth[i] = 1.0f;
            room.normals[4 * i + 1] = 0.0f;
            room.normals[4 * i + 2] = 1.0f;
        }
    const Picture raw = run(room, values({{"blur", 0}})), smooth = run(room, values({{"blur", 1}}));
    const uint32_t width = room.visibleWidth(), edge = room.width / 2 - room.guard;
    double near = 0.0;
    for (uint32_t y = 0; y < room.visibleHeight(); ++y) near = std::max(near, double(smooth[size_t(y) * width + edge - 1]));
    EXPECT_EQ(highest({raw.begin() + edge - 1, raw.begin() + edge}), 0.0f);
    EXPECT_LT(near, 0.02);
}

TEST_F(HorizonSplitTest, everyPresetIsDeterministic) {
    const Room room = crease();
    for (const ao::Preset& preset : ao::findMethod("horizon_split")->presets)
        EXPECT_EQ(run(room, values({}, preset.id)), run(room, values({}, preset.id))) << preset.id;
}

}  // namespace
}  // namespace obscura::test
