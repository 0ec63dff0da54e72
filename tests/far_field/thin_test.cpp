// Finite thickness, and directions rotated from pixel to pixel (jitter).
#include "far_field/fixture.h"

namespace obscura::test {
namespace {

// A board `width` px wide, 1 m in front of a wall at 4 m.
Room board(uint32_t width) {
    Room room = plane({0, 0, 1});
    for (size_t i = 0; i < room.depth.size(); ++i) room.depth[i] = 4.0f;
    for (uint32_t y = 0; y < room.height; ++y)
        for (uint32_t x = room.width / 2 - width / 2; x < room.width / 2 + width / 2; ++x) room.depth[size_t(y) * room.width + x] = 3.0f;
    return room;
}

double difference(const Picture& a, const Picture& b) {
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i) sum += std::abs(double(a[i]) - double(b[i]));
    return sum / double(a.size());
}

class FarFieldThin : public FarFieldTest {
protected:
    const char* falloff = "exponential:2";
    Picture thin(const Room& room, float thickness, float jitter = 0.0f) {
        return run(room, values({{"thickness", thickness}, {"jitter", jitter}, {"interval", 3}}, "thin"), falloff);
    }
};

// A thickness of 100 m gives the result of infinite thickness, a single horizon with the paper's slabs, within the width of a bin.
TEST_F(FarFieldThin, largeThicknessEqualsInfinite) {
    const Room room = crease();
    const Picture endless = run(room, values({{"directions", 16}, {"segments", 1}, {"averaging", 0}, {"estimator", 0}}), falloff);
    const Picture thick = run(room, values({{"thickness", 100}, {"jitter", 0}}, "thin"), falloff);
    EXPECT_LT(difference(endless, thick), 0.01);
    EXPECT_GT(mean(endless), 0.05);
}

TEST_F(FarFieldThin, smallerThicknessBlocksLess) {
    const Room room = board(20);
    double before = 0.0;
    for (const float thickness : {0.02f, 0.1f, 0.3f, 1.0f, 10.0f}) {
        const double now = mean(thin(room, thickness));
        EXPECT_GT(now, before) << thickness;
        before = now;
    }
    // A board 2 cm thick blocks only the solid angle that it covers, much less than one 10 m thick.
    EXPECT_LT(mean(thin(room, 0.02f)), 0.35 * mean(thin(room, 10.0f)));
    m_method = "mipmap";
    EXPECT_LT(mean(run(room, values({{"thickness", 0.05f}, {"jitter", 0}}, "thin"), falloff)),
        0.7 * mean(run(room, values({{"thickness", 10}, {"jitter", 0}}, "thin"), falloff)));
}

TEST_F(FarFieldThin, jitterAddsNoiseAndKeepsTheMean) {
    const Room room = board(20);
    const Picture still = thin(room, 1.0f), turned = thin(room, 1.0f, 1.0f);
    EXPECT_NE(still, turned);
    EXPECT_NEAR(mean(turned), mean(still), 0.05 * mean(still));
}

// Near field, far field, and both when interleaved.
TEST_F(FarFieldThin, jitterTurnsEveryField) {
    const Room room = board(20);
    for (const char* preset : {"default", "fast", "paper_saao"})
        for (const float parts : {1.0f, 2.0f}) {
            const Changes still{{"parts", parts}, {"alternate", 0}, {"jitter", 0}},
                turned{{"parts", parts}, {"alternate", 0}, {"jitter", 1}};
            const Picture one = run(room, values(still, preset), falloff), two = run(room, values(turned, preset), falloff);
            EXPECT_GT(difference(one, two), 0.02 * mean(one)) << preset << ", part " << parts;
            EXPECT_NEAR(mean(two), mean(one), 0.05 * mean(one)) << preset << ", part " << parts;
        }
}

// A setting that others leave without effect is logged, once.
TEST_F(FarFieldThin, settingsWithoutEffectAreLogged) {
    const Room room = board(20);
    const auto warns = [&](const Changes& changes, const char* preset, const char* text) {
        logged().clear();
        run(room, values(changes, preset), falloff);
        return loggedContains(text);
    };
    for (const ao::Preset& preset : ao::findMethod("far_field")->presets) EXPECT_FALSE(warns({}, preset.id, "has no effect")) << preset.id;
    EXPECT_TRUE(warns({{"estimator", 1}}, "thin", "far_field: estimator has no effect"));
    EXPECT_FALSE(warns({{"estimator", 1}}, "thin", "has no effect")) << "once is enough";
    EXPECT_TRUE(warns({{"interleave", 2}}, "thin", "far_field: interleave has no effect"));
    EXPECT_TRUE(warns({{"depth_layers", 1}}, "thin", "far_field: depth_layers has no effect"));
    EXPECT_TRUE(warns({{"averaging", 1}}, "thin", "far_field: averaging has no effect"));
    EXPECT_TRUE(warns({{"depth_layers", 1}}, "fast", "far_field: depth_layers has no effect when interleaved"));
    EXPECT_TRUE(warns({{"depth_layers", 1}}, "paper_8x2", "far_field: depth_layers has no effect without the pyramid"));
    EXPECT_TRUE(warns({{"neighbours", 1}}, "default", "far_field: neighbours has no effect"));
    EXPECT_FALSE(warns({{"estimator", 1}}, "default", "has no effect"));
}

TEST_F(FarFieldThin, directSamplesNeedNoScan) {
    const Room room = board(20);
    const Picture direct = run(room, values({{"averaging", 3}, {"jitter", 0}}, "thin"), falloff);
    EXPECT_EQ(m_executor->plan().text(m_graph->recording()).find("far_field.scan"), std::string::npos);
    EXPECT_LT(mean(direct), mean(run(room, values({{"jitter", 0}}, "thin"), falloff)));  // occluders between samples are missed
    EXPECT_GT(mean(direct), 0.002);
}

}  // namespace
}  // namespace obscura::test
