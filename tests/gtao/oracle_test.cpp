// Captured frames: the published preset equals the transcription and has the published error; `tuned` has a smaller one.
#include "ao/oracle.h"
#include "gtao/published.h"

namespace obscura::test {
namespace {

constexpr const char* kFalloff = "ramp:0.385:1";
constexpr const char* kWorld = "world.xegtao_1";

class Oracle : public OracleTest {
protected:
    Oracle() : OracleTest("gtao") {}
};

TEST_F(Oracle, highEqualsTheTranscription) {
    for (const char* name : {"corner", "atrium"}) {
        ao::Frame frame;
        const Room room = captured(name, frame);
        const double apart = meanDifference(run(room, frame, values({}, "high"), kFalloff), Published().run(room, frame));
        printf("%s: difference %.3f/255\n", name, apart * 255.0);
        EXPECT_LT(apart, 1.0 / 255.0) << name;
    }
}

// The error of XeGTAO's own shaders.
TEST_F(Oracle, highHasThePublishedError) { EXPECT_NEAR(measure("sponza_a", values({}), kFalloff, kWorld).raw.eA, 0.078f, 0.004f); }

TEST_F(Oracle, tunedHasASmallerError) {
    for (const char* name : {"corner", "atrium"})
        EXPECT_LT(measure(name, values({}, "tuned"), "quadratic:1", "world.quadratic_1").raw.eA,
            0.8f * measure(name, values({}), "quadratic:1", "world.quadratic_1").raw.eA)
            << name;
}

}  // namespace
}  // namespace obscura::test
