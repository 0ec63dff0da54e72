// Steps along lines on the screen (shaders/ao/common/lens.glsl) end at all four edges of the buffers alike.
#include "ao/method_test.h"

namespace obscura::test {
namespace {

class LensTest : public MethodTest {
protected:
    LensTest() : MethodTest("horizon_split") {}
};

// A wall at 4 m whose outermost texels on one side are 1 m nearer, beside its mirror image.
TEST_F(LensTest, lastTexelCountsOnceOnEverySide) {
    Room room;
    room.width = room.height = 96;
    room.guard = 0;
    room.build();
    std::array<double, 4> means{};
    for (int side = 0; side < 4; ++side) {  // left, right, top, bottom
        for (uint32_t y = 0; y < 96; ++y)
            for (uint32_t x = 0; x < 96; ++x) {
                const size_t i = size_t(y) * 96 + x;
                const uint32_t from = side == 0 ? x : side == 1 ? 95 - x : side == 2 ? y : 95 - y;
                room.depth[i] = from < 1 ? 3.0f : 4.0f;
                room.normals[4 * i + 1] = 0.0f;
                room.normals[4 * i + 2] = 1.0f;
            }
        means[side] = mean(run(room, values({{"directions", 16}, {"steps", 64}, {"normal_rays", 0}, {"blur", 0}}), "linear:3"));
    }
    EXPECT_GT(means[0], 0.01);
    for (int side = 1; side < 4; ++side) EXPECT_NEAR(means[side], means[0], 0.01 * means[0]) << side;
}

}  // namespace
}  // namespace obscura::test
