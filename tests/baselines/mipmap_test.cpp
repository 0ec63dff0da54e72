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

}  // namespace
}  // namespace obscura::test
