// Accuracy on the stored captured frames.
#include "ao/oracle.h"

namespace obscura::test {
namespace {

class Oracle : public OracleTest {
protected:
    Oracle() : OracleTest("horizon_split") {}
    truth::Metrics measure(const std::string& name, const ao::Values& values) {
        return OracleTest::measure(name, values, "linear:1.5", "world.linear_1.5");
    }
};

TEST_F(Oracle, cornerErrorIsBelowTheLimit) {
    const truth::Metrics metrics = measure("corner", values({}));
    EXPECT_LE(metrics.raw.eA, 0.006f);
    EXPECT_GE(metrics.raw.e5, 0.98f);
    EXPECT_GE(metrics.ssim, 0.99f);
}

TEST_F(Oracle, atriumErrorIsBelowTheLimit) { EXPECT_LE(measure("atrium", values({})).raw.eA, 0.020f); }

TEST_F(Oracle, sphereErrorIsBelowTheLimit) { EXPECT_LE(measure("sphere", values({})).raw.eA, 0.006f); }

TEST_F(Oracle, moreSamplesReduceTheError) {
    EXPECT_LT(measure("corner", values({}, "quality")).raw.eA, measure("corner", values({})).raw.eA);
    EXPECT_LT(measure("corner", values({})).raw.eA, measure("corner", values({}, "paper_fast")).raw.eA);
}

}  // namespace
}  // namespace obscura::test
