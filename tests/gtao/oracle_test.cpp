// On captured frames: the published preset is what the transcription is, and as wrong as published; arcs are less wrong.
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

TEST_F(Oracle, highIsThePublishedPicture) {
    for (const char* name : {"corner", "atrium"}) {
        ao::Frame frame;
        const Room room = captured(name, frame);
        const double apart = meanDifference(run(room, frame, values({}, "high"), kFalloff), Published().run(room, frame));
        printf("%s: apart by %.3f/255\n", name, apart * 255.0);
        EXPECT_LT(apart, 1.0 / 255.0) << name;
    }
}

// As wrong as XeGTAO's own shaders are.
TEST_F(Oracle, highIsAsWrongAsPublished) {
    EXPECT_NEAR(measure("sponza_a", values({}), kFalloff, kWorld).raw.eA, 0.078f, 0.004f);
}

TEST_F(Oracle, arcsAreLessWrong) {
    for (const char* name : {"corner", "atrium"})
        EXPECT_LT(measure(name, values({}, "tuned"), "quadratic:1", "world.quadratic_1").raw.eA, 0.8f * measure(name, values({}), "quadratic:1", "world.quadratic_1").raw.eA) << name;
}

}  // namespace
}  // namespace obscura::test
