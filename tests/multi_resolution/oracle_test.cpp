// Accuracy on the stored captured frames.
#include "ao/oracle.h"

namespace obscura::test {
namespace {

class Oracle : public OracleTest {
protected:
    Oracle() : OracleTest("multi_resolution") {}
    truth::Metrics measure(const std::string& name, const char* preset) {
        return OracleTest::measure(name, values({}, preset), "quadratic:2", "world.quadratic_2");
    }
};

TEST_F(Oracle, cornerErrorIsBelowTheLimit) {
    const truth::Metrics paper = measure("corner", "paper"), ours = measure("corner", "default");
    EXPECT_LE(paper.raw.eA, 0.027f);
    EXPECT_LT(ours.raw.eA, 0.024f);
    EXPECT_GE(ours.ssim, 0.97f);
}

TEST_F(Oracle, atriumErrorIsBelowTheLimit) {
    const truth::Metrics paper = measure("atrium", "paper"), ours = measure("atrium", "default");
    EXPECT_LE(paper.raw.eA, 0.046f);
    EXPECT_LT(ours.raw.eA, 0.043f);
    EXPECT_GT(ours.ssim, paper.ssim);
}

TEST_F(Oracle, defaultIsMoreAccurateThanPaperOnRealScenes) {
    for (const char* scene : {"sponza_a", "dragon"}) {
        const truth::Metrics paper = measure(scene, "paper"), ours = measure(scene, "default");
        EXPECT_LT(ours.raw.eA, paper.raw.eA) << scene;
        EXPECT_GT(ours.ssim, paper.ssim + 0.01f) << scene;
    }
}

}  // namespace
}  // namespace obscura::test
