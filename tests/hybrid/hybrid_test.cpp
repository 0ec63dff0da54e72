// hybrid where the exact value is known: full enclosure, empty space, bare planes, an infinite wall; and the result does not depend on
// the position of the window.
#include "ao/method_test.h"

namespace obscura::test {
namespace {

class HybridTest : public MethodTest {
protected:
    HybridTest() : MethodTest("hybrid") {}
    // Full resolution, no filter.
    static Changes plain(float rays, float steps, float offset) {
        return {{"rays", rays}, {"steps", steps}, {"offset", offset}, {"map", 1}, {"filter", 0}};
    }
    static Room room(float wall) {
        Room result;
        result.wall = wall;
        result.build();
        return result;
    }
};

// Obscurance of a floor point at `a` metres from an infinite wall: cosine-weighted mean of rho over the directions that hit it.
double wallExact(double a, const ao::Falloff& rho) {
    constexpr int kAzimuths = 400, kHeights = 400;
    constexpr double kPi = 3.14159265358979;
    double sum = 0.0;
    for (int i = 0; i < kAzimuths; ++i) {
        const double azimuth = kPi * ((i + 0.5) / kAzimuths - 0.5);
        for (int k = 0; k < kHeights; ++k) {
            const double sine = std::sqrt((k + 0.5) / kHeights);  // uniform in sine squared: cosine-weighted
            sum += ao::evaluate(rho, float(a / (sine * std::cos(azimuth))));
        }
    }
    return 0.5 * sum / (kAzimuths * kHeights);
}

TEST_F(HybridTest, wendlandFalloffMatchesItsFormula) {
    const ao::Falloff rho{ao::FalloffKind::wendland, 1.0f};
    const float expected[][2] = {{0.0f, 1.0f}, {0.25f, 0.6328125f}, {0.5f, 0.1875f}, {0.75f, 0.015625f}, {1.0f, 0.0f}};
    for (const auto& [t, w] : expected) EXPECT_NEAR(ao::evaluate(rho, t), w, 1e-6f);
}

TEST_F(HybridTest, fullEnclosureIsOneAndEmptySpaceIsZero) {
    Room enclosed = room(-5.0f);
    std::fill(enclosed.bits.begin(), enclosed.bits.end(), ~0u);
    for (const char* preset : {"default", "paper", "quality"}) {
        const Picture picture = run(enclosed, values({}, preset), "constant:1");
        // Only the last row starts inside the window, which is smaller than the room.
        for (uint32_t x = 0; x < enclosed.visibleWidth(); ++x)
            EXPECT_EQ(picture[size_t(enclosed.visibleHeight() - 1) * enclosed.visibleWidth() + x], 1.0f) << preset;
    }
    const Picture touching = run(enclosed, values(plain(128, 64, 0)), "wendland:2");
    EXPECT_GT(touching.back(), 0.97f);  // t -> 0
    std::fill(enclosed.bits.begin(), enclosed.bits.end(), 0u);
    EXPECT_EQ(highest(run(enclosed, values({}), "wendland:2")), 0.0f);
}

// The offset must exceed sqrt(3) cells: the farthest corner of a cell from a plane that touches it.
TEST_F(HybridTest, planesAreOpen) {
    Room bare = room(0.0f);
    for (const float tilt : {0.0f, 0.3f, 0.785398f, 1.1f})
        for (const float offset : {1.75f, 2.0f}) {
            bare.voxelize(128, 0.1f, tilt);
            EXPECT_EQ(highest(run(bare, values({{"offset", offset}}), "wendland:2")), 0.0f) << tilt;
            EXPECT_EQ(highest(run(bare, values(plain(64, 64, offset)), "wendland:2")), 0.0f) << tilt;
        }
    bare.voxelize(128, 0.1f, 0.785398f);
    EXPECT_GT(highest(run(bare, values(plain(64, 64, 0.5f)), "wendland:2")), 0.5f);  // with a small offset they do
}

TEST_F(HybridTest, infiniteWallIsNearTheExactIntegral) {
    Room wall = room(-4.0f);
    wall.height = 192;
    wall.build();
    wall.voxelize(256, 0.07f);
    ao::Falloff rho;
    ASSERT_TRUE(ao::parseFalloff("wendland:2", rho));
    EXPECT_NEAR(wallExact(0.334, rho), 0.1639, 0.002);
    EXPECT_NEAR(wallExact(1.02, rho), 0.0076, 0.0005);
    const Picture fine = run(wall, values(plain(128, 57, 2)), "wendland:2"), coarse = run(wall, values(plain(128, 8, 2)), "wendland:2");
    size_t rows = 0;
    for (uint32_t y = 0; y < wall.visibleHeight(); ++y) {
        const float z = wall.depth[size_t(y + wall.guard) * wall.width + wall.width / 2];
        const double a = double(-wall.wall) - double(z);
        if (a < 0.3 || a > 1.1) continue;
        double mean = 0.0, coarseMean = 0.0;
        for (uint32_t x = 0; x < wall.visibleWidth(); ++x) {
            mean += fine[size_t(y) * wall.visibleWidth() + x];
            coarseMean += coarse[size_t(y) * wall.visibleWidth() + x];
        }
        mean /= wall.visibleWidth();
        coarseMean /= wall.visibleWidth();
        const double exact = wallExact(a, rho);
        // Distances are too long by at most the lift along the normal.
        EXPECT_LT(mean, 1.03 * exact) << a;
        EXPECT_GT(mean, wallExact(a + 2 * 0.07, rho)) << a;
        EXPECT_LT(coarseMean, exact) << a;         // steps longer than the thickness of the shell miss it,
        EXPECT_GT(coarseMean, 0.15 * exact) << a;  // but not always
        ++rows;
    }
    EXPECT_GE(rows, 4u);
}

TEST_F(HybridTest, movedWindowGivesTheSameResult) {
    Room still = room(-2.5f), moved = still;
    still.voxelize(64, 0.1f);
    moved.voxelize(64, 0.1f, 0.0f, {8, -24, 40});  // other addresses, same cells; their world position differs, so the noise differs
    const Picture a = run(still, values(plain(128, 32, 2)), "wendland:2"), b = run(moved, values(plain(128, 32, 2)), "wendland:2");
    EXPECT_GT(mean(a), 0.005);
    EXPECT_NEAR(mean(a), mean(b), 0.02 * mean(a));
    // Moving the origin and the lowest corner together keeps the world: where the windows overlap the result is the same, noise included.
    Room shifted = still;
    shifted.volume.origin[0] = 8;
    shifted.volume.cellFromEye[12] -= 8.0f;
    const Picture c = run(shifted, values({}), "wendland:2"), d = run(still, values({}), "wendland:2");
    const uint32_t width = still.visibleWidth();
    size_t same = 0, all = 0;
    for (size_t i = 0; i < c.size(); ++i)
        if (i % width > width / 3 && i % width < 2 * width / 3) same += std::abs(c[i] - d[i]) < 2e-3f, ++all;
    EXPECT_GT(double(same), 0.99 * double(all));
}

TEST_F(HybridTest, mapsAndFiltersStayNearTheUnfilteredResult) {
    Room wall = room(-5.0f);
    const Picture plainly = run(wall, values({{"rays", 128}, {"map", 1}, {"filter", 0}}), "wendland:2");
    for (const float map : {1.0f, 2.0f, 3.0f, 4.0f}) {
        const Picture filtered = run(wall, values({{"rays", 128}, {"map", map}}), "wendland:2");
        double difference = 0.0;
        for (size_t i = 0; i < filtered.size(); ++i) difference += std::abs(filtered[i] - plainly[i]);
        EXPECT_LT(difference / double(filtered.size()), 0.012) << map;
        EXPECT_NEAR(mean(filtered), mean(plainly), 0.25 * mean(plainly)) << map;
    }
}

TEST_F(HybridTest, withoutVolumeNothingIsBlockedAndOneLineIsLogged) {
    Room none = room(-5.0f);
    none.bits.clear();
    for (int i = 0; i < 3; ++i) EXPECT_EQ(highest(run(none, values({}), "wendland:2")), 0.0f);
    EXPECT_EQ(std::count_if(
                  logged().begin(), logged().end(), [](const std::string& line) { return line.find("no volume") != std::string::npos; }),
        1);
}

}  // namespace
}  // namespace obscura::test
