// Downsampling of depths, and the number of samples on each level.
#include "multi_resolution/fixture.h"

namespace obscura::test {
namespace {

class Levels : public MultiResolutionTest {};

// A wall of repeated 2x2 blocks with these depths.
Room blocks(const std::array<float, 4>& depths) {
    Room room = wall(1.0f);
    for (uint32_t y = 0; y < room.height; ++y)
        for (uint32_t x = 0; x < room.width; ++x) room.depth[size_t(y) * room.width + x] = depths[(y & 1) * 2 + (x & 1)];
    return room;
}

TEST_F(Levels, blockDownsamplesToItsMedianOrSecondNearest) {
    readLevel("depth", 2);  // the threshold is half of 2 m
    for (const auto& far :
        {std::array{1.0f, 2.0f, 3.0f, 10.0f}, std::array{10.0f, 1.0f, 2.0f, 3.0f}, std::array{3.0f, 10.0f, 1.0f, 2.0f}}) {
        run(blocks(far), values({}, "paper"));
        EXPECT_FLOAT_EQ(depthAt(90, 50), 2.0f);
    }
    for (const auto& near : {std::array{1.0f, 1.2f, 1.4f, 1.8f}, std::array{1.8f, 1.4f, 1.0f, 1.2f}, std::array{1.4f, 1.0f, 1.2f, 1.8f}}) {
        run(blocks(near), values({}, "paper"));
        EXPECT_FLOAT_EQ(depthAt(90, 50), 1.3f);
        run(blocks(near), values({{"threshold", 0}}, "paper"));
        EXPECT_FLOAT_EQ(depthAt(90, 50), 1.2f);
    }
}

TEST_F(Levels, planeIsPreserved) {
    for (const std::array<float, 3>& n : {std::array{0.0f, 1.0f, 0.0f}, std::array{0.5f, 1.0f, 0.05f}, std::array{0.3f, -0.2f, 1.0f}}) {
        const Room room = plane(n);
        for (const float threshold : {0.5f, 0.0f, 1000.0f}) {
            for (const int side : {2, 4, 8}) {
                readLevel("depth", side);
                run(room, values({{"threshold", threshold}}, "paper"));
                float worst = 0.0f;
                size_t compared = 0;
                for (uint32_t y = 0; y < m_probed.height; ++y)
                    for (uint32_t x = 0; x < m_probed.width; ++x) {
                        const auto [right, up] = rayAt(room, (float(x) + 0.5f) * float(side), (float(y) + 0.5f) * float(side));
                        const float expected = -1.6f * std::hypot(n[0], n[1], n[2]) / (n[0] * right + n[1] * up - n[2]);
                        // Skip blocks that contain sky.
                        const float steepest = std::abs(n[0] * right + n[1] * up - n[2]);
                        if (expected <= 0.0f || expected > 60.0f || steepest < 0.1f) continue;
                        worst = std::max(worst, std::abs(depthAt(x, y) / expected - 1.0f));
                        ++compared;
                    }
                EXPECT_GT(compared, m_probed.words.size() / 5);
                EXPECT_LT(worst, 2e-4f) << "1/" << side << ", threshold " << threshold;
            }
        }
    }
}

// 155.885 px per metre at 1 m: at 5 m and a reach of 2 m radii are 62.35, 31.18, 15.59, 7.79 texels, all capped at 5; at 20 m they
// are 15.59, 7.79, 3.90, 1.95, 0.97.
TEST_F(Levels, sampleCountFollowsTheRadius) {
    const auto counts = [&](float depth, const Changes& changes) {
        std::vector<float> result;
        for (const int side : {1, 2, 4, 8, 16}) {
            readLevel("near", side);
            run(wall(depth), values(changes, "paper"));
            result.push_back(samplesAt(m_probed.width / 2, m_probed.height / 2));
        }
        return result;
    };
    std::vector<float> close = counts(5.0f, {{"levels", 5}});
    close.pop_back();  // level 1/16 has 14 rows, fewer than the pattern needs
    EXPECT_EQ(close, (std::vector<float>{16, 36, 36, 36}));
    EXPECT_EQ(counts(20.0f, {{"levels", 5}}), (std::vector<float>{16, 36, 16, 4, 0}));
    EXPECT_EQ(counts(20.0f, {{"levels", 5}, {"pattern", 0}, {"first_radius", 0.5f}}), (std::vector<float>{36, 16, 4, 0, 0}));
    EXPECT_EQ(counts(20.0f, {{"levels", 5}, {"pattern", 0}, {"max_radius", 2}}), (std::vector<float>{4, 4, 4, 4, 0}));
}

// A step in a wall 20 m away, where patterns shrink to 4 and 2 texels across, and its mirror images.
TEST_F(Levels, mirroredStepGivesTheMirroredPicture) {
    for (const bool vertical : {true, false}) {
        Room room = wall(20.0f), mirror = room;
        const uint32_t w = room.width, h = room.height;
        for (uint32_t y = 0; y < h; ++y)
            for (uint32_t x = 0; x < w; ++x) {
                const bool near = vertical ? x < w / 2 : y < h / 2;
                room.depth[y * w + x] = near ? 19.2f : 20.0f;
                mirror.depth[y * w + x] = near ? 20.0f : 19.2f;
            }
        for (const char* preset : {"paper", "default", "fast", "quality"})
            for (const float radius : {1.2f, 2.3f, 3.9f, 4.99f, 7.0f}) {
                const ao::Values of = values({{"max_radius", radius}}, preset);
                const Picture picture = run(room, of), image = run(mirror, of);
                EXPECT_GT(highest(picture), 0.02f) << preset << radius;
                const uint32_t vw = room.visibleWidth(), vh = room.visibleHeight();
                float most = 0.0f;
                for (uint32_t y = 0; y < vh; ++y)
                    for (uint32_t x = 0; x < vw; ++x)
                        most =
                            std::max(most, std::abs(picture[y * vw + x] - image[vertical ? y * vw + vw - 1 - x : (vh - 1 - y) * vw + x]));
                EXPECT_LT(most, 0.001f) << preset << ", radius " << radius << (vertical ? ", vertical" : ", horizontal");
            }
    }
}

// A pixel is not its own sample: beside a wall that blocks all of its samples, obscurance of a level is their mean at any radius.
TEST_F(Levels, pixelIsNotItsOwnSample) {
    for (const float radius : {1.0f, 1.5f, 2.0f, 2.4f, 3.0f, 4.0f}) {
        Room room = wall(1.0f);
        const uint32_t x = room.width / 2, y = room.height / 2;
        room.depth[size_t(y) * room.width + x] = 4.0f;  // a shaft
        for (const float pattern : {0.0f, 1.0f}) {
            readLevel("near", 1);
            run(room, values({{"max_radius", radius}, {"pattern", pattern}, {"gain", 1}}, "paper"), "constant:5");
            EXPECT_GT(maximumAt(x - room.guard, y - room.guard), 0.98f) << radius << ", pattern " << pattern;
        }
    }
}

TEST_F(Levels, samplesOutsideTheImageAreNotCounted) {
    Room room = wall(5.0f);
    room.guard = 0;  // makes the corner texel visible
    room.width = 320;
    room.height = 180;
    room.build();
    std::fill(room.depth.begin(), room.depth.end(), 5.0f);
    readLevel("near", 2);
    run(room, values({}, "paper"));
    EXPECT_EQ(samplesAt(0, 0), 9);  // offsets 1, 3, 5 of -5 to 5
    EXPECT_EQ(samplesAt(80, 0), 18);
}

TEST_F(Levels, eachLevelDoublesTheReach) {
    Room room = hall();
    room.wall = -4.0f;  // 25 px from the floor at 2.8 m: 2 and 3 levels reach 10 and 20 px
    room.build();
    const uint32_t row = uint32_t(90.0f + 155.885f * 1.5f / 2.8f), width = room.visibleWidth();
    const auto at = [&](float levels) { return run(room, values({{"levels", levels}}, "paper")).at(size_t(row) * width + width / 2); };
    EXPECT_EQ(at(2), 0.0f);
    EXPECT_EQ(at(3), 0.0f);
    EXPECT_GT(at(4), 0.01f);
    EXPECT_GT(at(5), at(4));
}

}  // namespace
}  // namespace obscura::test
