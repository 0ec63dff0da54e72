// Extreme frames: only sky, a camera close to a wall, tiny, odd and large sizes, orthographic projection.
#include "far_field/fixture.h"

namespace obscura::test {
namespace {

const char* const kPresets[] = {"default", "fast", "paper_8x2", "paper_16x2", "paper_saao"};

class FarFieldEdges : public FarFieldTest {
protected:
    void everyPreset(const Room& room, const char* falloff, const char* what) {
        m_method = "far_field";
        for (const char* preset : kPresets) EXPECT_TRUE(finite(run(room, values({}, preset), falloff))) << what << ", " << preset;
        m_method = "mipmap";
        EXPECT_TRUE(finite(run(room, values({}), falloff))) << what << ", mipmap";
        m_method = "far_field";
    }
};

TEST_F(FarFieldEdges, skyIsOpen) {
    Room room;
    room.build();
    std::fill(room.depth.begin(), room.depth.end(), 1e4f);
    for (const char* preset : kPresets) EXPECT_EQ(highest(run(room, values({}, preset), "exponential:1")), 0.0f) << preset;
    m_method = "mipmap";
    EXPECT_EQ(highest(run(room, values({}), "exponential:1")), 0.0f);
}

TEST_F(FarFieldEdges, anySizeGivesValidObscurance) {
    for (const auto& [width, height, guard] :
        {std::tuple{8u, 8u, 0u}, {1u, 1u, 0u}, {9u, 33u, 1u}, {97u, 61u, 7u}, {161u, 3u, 0u}, {160u, 120u, 0u}}) {
        const Room room = crease(width, height, guard);
        everyPreset(room, "exponential:1", (std::to_string(width) + "x" + std::to_string(height)).c_str());
    }
}

TEST_F(FarFieldEdges, scaledWorldGivesTheSameResult) {
    for (const float scale : {0.0033f, 1.0f, 1.67f, 167.0f}) {  // the wall 1 cm, 3 m, 5 m and 500 m away
        Room room = crease(160, 120, 16);
        for (float& z : room.depth) z *= z < 5e3f ? scale : 1.0f;
        everyPreset(room, "exponential:1", std::to_string(scale).c_str());
        for (const char* falloff : {"constant:0.01", "constant:100000", "linear:0.25", "exponential:100", "ramp:0.1:0.2"})
            everyPreset(room, falloff, falloff);
        // The result is the same if all lengths are scaled, falloff included.
        const std::string falloff = "exponential:" + std::to_string(scale);
        const Picture scaled = run(room, values({}), falloff.c_str()), one = run(crease(160, 120, 16), values({}), "exponential:1");
        double difference = 0.0;
        for (size_t i = 0; i < one.size(); ++i) difference += std::abs(double(one[i]) - double(scaled[i]));
        EXPECT_LT(difference / double(one.size()), 0.001) << scale;
    }
}

TEST_F(FarFieldEdges, orthographicStepMatchesTheClosedForm) {
    // A step seen from above by an orthographic camera: pixels near its foot are dark, those on top are open.
    Room room;
    room.width = room.height = 128;
    room.guard = 16;
    room.build();
    const float scale = 2.0f / (128.0f * 0.02f);  // 2 cm per px
    const float orthographic[16] = {scale, 0, 0, 0, 0, -scale, 0, 0, 0, 0, -0.01f, 0, 0, 0, 0, 1};
    std::memcpy(room.projection, orthographic, sizeof(orthographic));
    for (size_t i = 0; i < room.depth.size(); ++i) {
        room.depth[i] = i % 128 < 64 ? 3.0f : 2.0f;
        room.normals[4 * i + 1] = 0.0f;
        room.normals[4 * i + 2] = 1.0f;
    }
    for (const char* preset : kPresets) {
        const Picture picture = run(room, values({}, preset), "constant:100");
        ASSERT_TRUE(finite(picture)) << preset;
        // A wall 1 m high at distance a on an infinite floor blocks (1 - a / sqrt(1 + a^2)) / 2; the paper's slabs miss some of it.
        for (const uint32_t x : {10u, 30u, 40u}) {
            const double a = 0.02 * (48.0 - x - 0.5);
            EXPECT_NEAR(picture[48 * 96 + x], 0.5 * (1.0 - a / std::sqrt(1.0 + a * a)), preset[0] == 'p' ? 0.09 : 0.05)
                << preset << " " << a;
        }
        EXPECT_LT(picture[48 * 96 + 70], 0.01f) << preset;
    }
}

// Orthographic depths count from a plane of the host's choice.
TEST_F(FarFieldEdges, orthographicDepthsMayBeginAnywhere) {
    const auto at = [](float from) {
        Room room;
        room.width = 160;
        room.height = 120;
        room.guard = 16;
        room.build();
        const float scale = 2.0f / (160.0f * 0.02f);  // 2 cm per px
        const float orthographic[16] = {scale, 0, 0, 0, 0, -scale * 160.0f / 120.0f, 0, 0, 0, 0, -0.0001f, 0, 0, 0, 0, 1};
        std::memcpy(room.projection, orthographic, sizeof(orthographic));
        for (size_t i = 0; i < room.depth.size(); ++i) {
            const size_t x = i % 160, y = i / 160;
            room.depth[i] = from + (x < 64 ? 3.0f : x < 90 && y > 50 ? 2.4f : 2.0f);
            room.normals[4 * i + 1] = 0.0f;
            room.normals[4 * i + 2] = 1.0f;
        }
        return room;
    };
    const Room near = at(0.0f);
    for (const float from : {10.0f, 1000.0f}) {
        const Room far = at(from);
        for (const char* preset : {"default", "fast", "paper_8x2", "paper_saao", "thin", "mipmap"}) {
            const bool mipmap = preset[0] == 'm';
            m_method = mipmap ? "mipmap" : "far_field";
            const ao::Values with = values({}, mipmap ? "default" : preset);
            const Picture one = run(near, with, "exponential:1"), two = run(far, with, "exponential:1");
            double difference = 0.0;
            for (size_t i = 0; i < one.size(); ++i) difference += std::abs(double(one[i]) - double(two[i]));
            EXPECT_LT(difference / double(one.size()), (preset[0] == 't' ? 0.06 : 0.02) * mean(one)) << preset << ", " << from << " m";
        }
    }
    m_method = "far_field";
}

// Directions of large images are scanned one after another, as in section 6 of the paper, so that intervals stay as long as asked for.
TEST_F(FarFieldEdges, largeImagesKeepTheirIntervals) {
    const ao::FarFieldLimits limits{1u << 28, 16384};
    for (const shared::uvec2 size : {shared::uvec2{1536, 864}, {2304, 1296}, {4916, 2766}})
        for (const auto& [directions, interval, averaging] : {std::tuple{12u, 5u, ao::Averaging::pyramid},
                 {18u, 10u, ao::Averaging::prefixSums}, {16u, 5u, ao::Averaging::prefixSums}, {32u, 5u, ao::Averaging::prefixSums}}) {
            const ao::FarFieldGrid grid = ao::farFieldGrid(size, directions, interval, 1, averaging, limits);
            EXPECT_EQ(grid.interval, interval) << size.x << " px, " << directions;
            EXPECT_LE(grid.bytes, limits.bytes);
        }
    EXPECT_EQ(ao::farFieldGrid({1536, 864}, 12, 5, 1, ao::Averaging::pyramid, limits).batch, 6u) << "all at once if they fit";
    // What does not fit at all is scanned in longer intervals.
    const ao::FarFieldGrid small = ao::farFieldGrid({4916, 2766}, 16, 3, 1, ao::Averaging::pyramid, {1u << 20, 4096});
    EXPECT_GT(small.interval, 3u);
    EXPECT_EQ(small.batch, 1u);
    EXPECT_LE(small.bytes, 1u << 20);
}

TEST_F(FarFieldEdges, batchesGiveTheSamePicture) {
    const Room room = crease(320, 240, 32);
    Room solid = room;
    solid.thickness.assign(room.depth.size(), 65504.0f);
    for (uint32_t y = 60; y < 140; ++y)
        for (uint32_t x = 100; x < 140; ++x) {
            const size_t i = size_t(y) * 320 + x;
            solid.depth[i] = 2.0f;
            solid.thickness[i] = 0.2f;
            for (size_t c = 0; c < 3; ++c) solid.normals[4 * i + c] = c == 2 ? 1.0f : 0.0f;
        }
    for (const char* preset : {"default", "fast", "layers", "thin", "paper_8x2", "paper_saao"}) {
        const Picture one = run(solid, values({{"memory", 256}, {"blur", 0}}, preset), "exponential:1");
        const uint64_t all = m_executor->frameBytes();
        const Picture many = run(solid, values({{"memory", 1}, {"blur", 0}}, preset), "exponential:1");
        const std::string plan = m_executor->plan().text(m_graph->recording());
        size_t scans = 0;
        for (size_t at = plan.find("far_field.scan"); at != std::string::npos; at = plan.find("far_field.scan", at + 1)) ++scans;
        EXPECT_LT(m_executor->frameBytes(), all) << preset;
        float most = 0.0f;
        for (size_t i = 0; i < one.size(); ++i) most = std::max(most, std::abs(one[i] - many[i]));
        EXPECT_GT(scans, 1u) << preset;
        EXPECT_LT(most, 0.003f) << preset;
    }
}

}  // namespace
}  // namespace obscura::test
