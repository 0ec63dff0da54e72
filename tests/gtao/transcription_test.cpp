// The published presets against the CPU transcription: mean difference below 0.25/255.
#include "ao/solids.h"
#include "gtao/published.h"

namespace obscura::test {
namespace {

class Transcription : public MethodTest {
protected:
    Transcription() : MethodTest("gtao") {}

    // Floor, wall, box, ball and pillar, 160x90 and its guard band.
    static Room furnished() {
        using Kind = Solid::Kind;
        Room room = frameOf({{Kind::plane, {0, -1.5f, 0}, {0, 1, 0}}, {Kind::plane, {0, 0, -7}, {0.2f, 0, 1}},
                                {Kind::box, {0.6f, -1.2f, -4}, {0.4f, 0.3f, 0.5f}}, {Kind::sphere, {-0.8f, -1.0f, -3.5f}, {0.5f, 0, 0}},
                                {Kind::cylinder, {-0.2f, 0, -5}, {0.08f, 0, 0}}},
            192, 108, 16);
        room.thickness.clear();
        room.second.clear();
        return room;
    }
    void compare(const char* preset, Published published, const Changes& changes = {}) {
        const Room room = furnished();
        const Picture gpu = run(room, values(changes, preset), "ramp:0.385:1"), cpu = published.run(room, room.frame());
        ASSERT_GT(mean(cpu), 0.03);  // the frame has obscurance
        const double apart = meanDifference(gpu, cpu);
        printf("gtao %s: mean %.4f, difference %.6f = %.3f/255\n", preset, mean(cpu), apart, apart * 255.0);
        EXPECT_LT(apart, 0.25 / 255.0) << preset;
    }
};

TEST_F(Transcription, highMatches) { compare("high", Published()); }
TEST_F(Transcription, lowMatches) { compare("low", Published(1, 2)); }
TEST_F(Transcription, mediumMatches) { compare("medium", Published(2, 2)); }
TEST_F(Transcription, ultraMatches) { compare("ultra", Published(9, 3)); }
TEST_F(Transcription, highWithoutBlurMatches) { compare("high", Published(3, 3, false), {{"denoise", 0}}); }
TEST_F(Transcription, defaultIsHigh) { EXPECT_TRUE(values({}) == values({}, "high")); }

// Depth layers of infinite thickness give the published result, within the 1/32 resolution of a side.
TEST_F(Transcription, infiniteLayersGiveThePublishedResult) {
    Room room = furnished();
    const Changes fine{
        {"mip_offset", 30}, {"slices", 8}};  // level 0 only: coarser depths are means without layers and single texels with them
    const Picture bare = run(room, values(fine, "high"), "ramp:0.385:1");
    room.thickness.assign(room.depth.size(), 65504.0f);
    Changes layers = fine;
    layers.push_back({"depth_layers", 1});
    const Picture endless = run(room, values(layers, "high"), "ramp:0.385:1");
    EXPECT_LT(meanDifference(endless, bare), 1.5 / 255.0);
    room.thickness.assign(room.depth.size(), 0.1f);
    EXPECT_LT(mean(run(room, values(layers, "high"), "ramp:0.385:1")), 0.9 * mean(endless));
}

// The curve visits each of 64x64 pixels once, from neighbour to neighbour.
TEST(Hilbert, visitsNeighbours) {
    std::vector<glm::ivec2> at(64 * 64, glm::ivec2(-1));
    for (unsigned y = 0; y < 64; ++y)
        for (unsigned x = 0; x < 64; ++x) at[Published::hilbert(x, y)] = glm::ivec2(x, y);
    for (size_t i = 1; i < at.size(); ++i) {
        const glm::ivec2 step = glm::abs(at[i] - at[i - 1]);
        ASSERT_EQ(step.x + step.y, 1) << i;
    }
}

}  // namespace
}  // namespace obscura::test
