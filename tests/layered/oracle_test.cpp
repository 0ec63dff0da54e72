// Accuracy against stored references: captured frames, which have no depth layers, and the same scenes drawn by our renderer, which
// have them.
#include "ao/drawn.h"

namespace obscura::test {
namespace {

constexpr const char* kFalloff = "quadratic:1";
constexpr const char* kWorld = "world.quadratic_1";

class Oracle : public DrawnOracleTest {
protected:
    Oracle() : DrawnOracleTest("layered") {}

    float drawn(const std::string& name, const ao::Values& values) { return DrawnOracleTest::drawn(name, values, kFalloff, kWorld); }
};

TEST_F(Oracle, cornerWithoutLayersIsBelowTheLimit) {
    EXPECT_LE(measure("corner", values({{"thickness", 1000}}), kFalloff, kWorld).raw.eA, 0.0070f);
    EXPECT_LE(measure("corner", values({{"thickness", 1000}}, "ultra"), kFalloff, kWorld).raw.eA, 0.0052f);
    EXPECT_LE(measure("corner", values({{"thickness", 1000}}, "reference"), kFalloff, kWorld).raw.eA, 0.0024f);
}

// Strata several metres long: the mean falloff over a segment differs from the mean of its ends.
TEST_F(Oracle, cornerWithLongFalloffIsBelowTheLimit) {
    EXPECT_LE(measure("corner", values({{"thickness", 1000}}), "exponential:1", "world.exponential_1").raw.eA, 0.0115f);
}

TEST_F(Oracle, drawnCornerIsBelowTheLimit) {
    EXPECT_LE(drawn("corner", values({})), 0.0048f);
    EXPECT_LE(drawn("corner", values({}, "ultra")), 0.0042f);
    EXPECT_LE(drawn("corner", values({}, "reference")), 0.0015f);
}

TEST_F(Oracle, drawnAtriumIsBelowTheLimit) {
    EXPECT_LE(drawn("atrium", values({})), 0.0145f);
    EXPECT_LE(drawn("atrium", values({}, "ultra")), 0.0135f);
    EXPECT_LE(drawn("atrium", values({}, "reference")), 0.0065f);
}

}  // namespace
}  // namespace obscura::test
