// Accuracy on the stored captured frames, against rays marched through the same depth buffer.
#include "ao/drawn.h"

namespace obscura::test {
namespace {

struct Error {
    double eA = 0.0, e5 = 0.0;
};

class FarFieldOracle : public OracleTest {
protected:
    FarFieldOracle() : OracleTest("far_field") {}

    // Means over corner and atrium, exponential falloffs of 1 and 3 m.
    Error mean(const ao::Values& values) {
        Error result;
        for (const char* scene : {"corner", "atrium"}) {
            for (const char* falloff : {"exponential:1", "exponential:3"}) {
                std::string channel = std::string("screen.") + falloff;
                std::replace(channel.begin(), channel.end(), ':', '_');
                const truth::Metrics metrics = measure(scene, values, falloff, channel);
                result.eA += 0.25 * double(metrics.raw.eA);
                result.e5 += 0.25 * double(metrics.raw.e5);
            }
        }
        return result;
    }
};

TEST_F(FarFieldOracle, defaultErrorIsBelowTheLimit) {
    const Error error = mean(values({}));
    EXPECT_LE(error.eA, 0.011);
    EXPECT_GE(error.e5, 0.97);
}

TEST_F(FarFieldOracle, interleavedErrorIsBelowTheLimit) { EXPECT_LE(mean(values({}, "fast")).eA, 0.019); }

// The paper's settings, with its shortest interval, have the error of another implementation of them: 0.0212.
TEST_F(FarFieldOracle, paperPresetHasTheErrorOfAnotherImplementation) {
    EXPECT_NEAR(mean(values({{"interval", 5}}, "paper_16x2")).eA, 0.0212, 0.08 * 0.0212);
}

TEST_F(FarFieldOracle, everyImprovementReducesTheError) {
    const double slab = mean(values({}, "paper_16x2")).eA;
    const double connected = mean(values({{"estimator", 1}}, "paper_16x2")).eA;
    EXPECT_LT(connected, 0.8 * slab);
    EXPECT_LT(mean(values({})).eA, connected);
}

TEST_F(FarFieldOracle, sparseLinesAddLittleError) {
    EXPECT_LE(mean(values({{"lines", 1}})).eA, 0.012);
    EXPECT_LE(mean(values({{"lines", 2}})).eA, 0.014);
}

TEST_F(FarFieldOracle, sphereBeforeSkyIsBelowTheLimit) {
    EXPECT_LE(measure("sphere", values({}), "exponential:1", "screen.exponential_1").raw.eA, 0.008f);
}

// With a single layer, free-standing pillars hide half of the atrium: the error is 0.12. With layers, prototypes reached 0.0123 to 0.0153.
class FarFieldDrawn : public DrawnOracleTest {
protected:
    FarFieldDrawn() : DrawnOracleTest("far_field") {}
    float drawn(const std::string& name, float layers, const char* falloff = "exponential:1", const char* channel = "world.exponential_1") {
        return DrawnOracleTest::drawn(name, values({{"depth_layers", layers}}, "layers"), falloff, channel);
    }
};

TEST_F(FarFieldDrawn, depthLayersReduceTheError) {
    const float none = drawn("atrium", 0), thickness = drawn("atrium", 1), two = drawn("atrium", 3);
    EXPECT_GT(none, 0.1f);
    EXPECT_LE(thickness, 0.024f);
    EXPECT_LE(two, 0.0165f);
    EXPECT_LE(drawn("atrium", 2), 0.0175f);
    EXPECT_LE(drawn("corner", 3), 0.0042f);
}

TEST_F(FarFieldDrawn, depthLayersHelpAtEveryFalloff) {
    EXPECT_LE(drawn("atrium", 3, "quadratic:2", "world.quadratic_2"), 0.0225f);
    for (const char* scene : {"atrium", "corner"})  // most of the remaining error is due to occluders outside the image
        EXPECT_LE(drawn(scene, 3, "exponential:3", "world.exponential_3"),
            0.003f + std::min(0.045f, drawn(scene, 0, "exponential:3", "world.exponential_3")))
            << scene;
}

class MipmapOracle : public FarFieldOracle {
protected:
    MipmapOracle() { m_method = "mipmap"; }
};

TEST_F(MipmapOracle, defaultHasThePublishedError) { EXPECT_NEAR(mean(values({})).eA, 0.0338, 0.2 * 0.0338); }

TEST_F(MipmapOracle, denseMipmapHalvesTheError) {
    const double dense = mean(values({}, "dense")).eA;
    EXPECT_LT(dense, 0.5 * mean(values({})).eA);
    EXPECT_GT(dense, 0.011);
}

}  // namespace
}  // namespace obscura::test
