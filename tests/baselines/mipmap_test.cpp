// Mipmapped ambient obscurance: mirrored pictures, and the levels that surfaces of finite thickness are read from.
#include "baselines/baseline_test.h"

namespace obscura::test {
namespace {

class Mipmap : public BaselineTest {
protected:
    Mipmap() : BaselineTest("mipmap") {}

    // Steps of 1 m before a wall at 6 m, on both axes.
    static Room steps(uint32_t width, uint32_t height) {
        Room room;
        room.width = width;
        room.height = height;
        room.guard = 12;
        room.build();
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x) {
                const size_t i = size_t(y) * width + x;
                room.depth[i] = 6.0f - (y * 9 / height % 3 == 1 ? 1.0f : 0.0f) - (x * 7 / width % 3 == 1 ? 1.0f : 0.0f);
                room.normals[4 * i + 1] = 0.0f;
                room.normals[4 * i + 2] = 1.0f;
            }
        return room;
    }
    static Room mirrored(const Room& room, bool across) {
        Room result = room;
        for (uint32_t y = 0; y < room.height; ++y)
            for (uint32_t x = 0; x < room.width; ++x)
                result.depth[size_t(y) * room.width + x] =
                    room.depth[size_t(across ? y : room.height - 1 - y) * room.width + (across ? room.width - 1 - x : x)];
        return result;
    }
};

// Sizes of levels are not always halves: 216 rows give 108, 54, 27, 13, 6.
TEST_F(Mipmap, mirroredPicturesMirror) {
    for (const char* preset : {"default", "thin"})
        for (const auto& [width, height] : {std::pair{384u, 216u}, {200u, 120u}, {97u, 131u}}) {
            const Room room = steps(width, height);
            const ao::Values with = preset[0] == 't' ? values({{"jitter", 0}, {"thickness", 0.5f}}, preset) : values({}, preset);
            const Picture picture = run(room, with, "exponential:1");
            EXPECT_GT(mean(picture), 0.01);
            for (const bool across : {false, true}) {
                const Picture other = run(mirrored(room, across), with, "exponential:1");
                const uint32_t w = room.visibleWidth(), h = room.visibleHeight();
                double sum = 0.0;
                for (uint32_t y = 0; y < h; ++y)
                    for (uint32_t x = 0; x < w; ++x)
                        sum +=
                            std::abs(double(picture[y * w + x]) - double(other[(across ? y : h - 1 - y) * w + (across ? w - 1 - x : x)]));
                // Of points on a texel's edge, the mirror image takes the other texel: some steps to the sides are whole pixels.
                EXPECT_LT(sum / (w * h), (preset[0] == 't' ? 0.02 : 1e-4) * mean(picture))
                    << preset << " " << width << "x" << height << (across ? " across" : " down");
            }
        }
}

// The far field alone: nothing nearer than the boundary counts, and what is farther is the far field of far_field.
TEST_F(Mipmap, nearSamplesCanBeLeftOut) {
    const Room room = steps(320, 200);
    EXPECT_EQ(run(room, values({{"nearest", 1}}), "exponential:1"), run(room, values({}), "exponential:1"));
    const double far = mean(run(room, values({{"nearest", 15}}), "exponential:1"));
    EXPECT_LT(far, 0.9 * mean(run(room, values({}), "exponential:1")));
    m_method = "far_field";
    EXPECT_NEAR(far, mean(run(room, values({{"near", 0}}, "paper_8x2"), "exponential:1")), 0.25 * far);
    m_method = "mipmap";
    // A hole of 9 px: its walls are near.
    Room hole = room;
    for (uint32_t y = 0; y < hole.height; ++y)
        for (uint32_t x = 0; x < hole.width; ++x)
            hole.depth[size_t(y) * hole.width + x] = std::abs(int(x) - 160) < 5 && std::abs(int(y) - 100) < 5 ? 4.5f : 4.0f;
    const uint32_t middle = (100 - hole.guard) * hole.visibleWidth() + 160 - hole.guard;
    EXPECT_GT(run(hole, values({}), "exponential:1")[middle], 0.5f);
    EXPECT_LT(run(hole, values({{"nearest", 15}}), "exponential:1")[middle], 0.5f * run(hole, values({}), "exponential:1")[middle]);
}

}  // namespace
}  // namespace obscura::test
