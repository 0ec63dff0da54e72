// Accuracy on the stored captured frames.
#include "ao/oracle.h"
#include "statistical/fixture.h"

namespace obscura::test {
namespace {

class StatisticalOracle : public OracleTest {
protected:
    StatisticalOracle() : OracleTest("statistical") {}
    float error(const std::string& name, const ao::Values& values) {
        return measure(name, values, "quadratic:1", "world.quadratic_1").raw.eA;
    }
};

TEST_F(StatisticalOracle, cornerErrorIsBelowTheLimit) { EXPECT_LE(error("corner", values({}, "quality")), 0.020f); }

TEST_F(StatisticalOracle, atriumErrorIsBelowTheLimit) { EXPECT_LE(error("atrium", values({}, "quality")), 0.044f); }

TEST_F(StatisticalOracle, fourAdaptiveLayersMatch64Uniform) {
    for (const char* name : {"corner", "sphere", "atrium"})
        for (const auto& [preset, most] : {std::pair{"quality", 0.003f}, {"paper", 0.0115f}})  // quadrants; one region: in the atrium
            EXPECT_NEAR(error(name, values({}, preset)), error(name, values({{"layers", kUniform64}}, preset)), most)
                << name << ", " << preset;
}

TEST_F(StatisticalOracle, everyCostlierSettingReducesTheError) {
    const float quality = error("atrium", values({}, "quality")), half = error("atrium", values({})),
                paper = error("atrium", values({}, "paper"));
    EXPECT_LT(quality, half);
    EXPECT_LT(quality, paper);
    EXPECT_LT(half, error("atrium", values({}, "paper_half")));
    EXPECT_LT(error("atrium", values({}, "paper_half")), error("atrium", values({}, "paper_quarter")));
    EXPECT_LT(paper, error("atrium", values({{"layers", kTwo}}, "paper")));
    EXPECT_LT(error("atrium", values({{"layers", kTwo}}, "paper")), 0.6f * error("atrium", values({{"layers", kOne}}, "paper")));
}

}  // namespace
}  // namespace obscura::test
