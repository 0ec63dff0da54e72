// Off-screen occluders where the answer is known [offscreen.md, 5.5]: nothing where nothing is, nothing twice, and a tall box beside the
// picture that obscures as if it were seen.
#include "ao/method_test.h"
#include "tall_box.h"

namespace obscura::test {
namespace {

constexpr float kOff = 0, kOffScreen = 1, kHidden = 2;

class OffScreenTest : public MethodTest {
protected:
    OffScreenTest() : MethodTest("hbao") {}
    // Of each method that has the switch, or the chosen one.
    static std::vector<const ao::MethodInfo*> offered() {
        std::vector<const ao::MethodInfo*> result;
        for (const ao::MethodInfo* info : ao::methods())
            if (ao::Values(*info).has("offscreen")) result.push_back(info);
        return result;
    }
    Picture with(const Room& room, float offscreen, const char* falloff = "quadratic:2", const std::string& preset = "default") {
        return run(room, values({{"offscreen", offscreen}}, preset), falloff);
    }
    Picture with(const TallBox& box, float offscreen) { return run(box, box.seen(), values({{"offscreen", offscreen}}), "quadratic:2"); }
};

TEST_F(OffScreenTest, everyMethodOfTheScreenHasTheSwitchAndNeedsAVolumeForIt) {
    EXPECT_GE(offered().size(), 6u);
    for (const ao::MethodInfo* info : offered()) {
        ao::Values values(*info);
        EXPECT_FALSE(ao::needs(values) & ao::kVolume) << info->id;
        values.set("offscreen", kOffScreen);
        EXPECT_TRUE(ao::needs(values) & ao::kVolume) << info->id;
    }
    for (const char* id : {"none", "hybrid"}) EXPECT_FALSE(ao::Values(*ao::findMethod(id)).has("offscreen")) << id;
}

TEST_F(OffScreenTest, emptyVoxelsAndBarePlanesAddNothing) {
    Room bare;
    bare.build();
    for (const float tilt : {0.0f, 0.3f, 0.785398f, 1.1f}) {
        bare.voxelize(128, 0.1f, tilt);
        EXPECT_EQ(with(bare, kHidden), with(bare, kOff)) << tilt;
    }
    Room walled;
    walled.wall = -4.0f;
    walled.build();
    std::fill(walled.bits.begin(), walled.bits.end(), 0u);
    for (const ao::MethodInfo* info : offered()) {
        m_method = info->id;
        EXPECT_EQ(with(walled, kHidden), with(walled, kOff)) << info->id;
    }
}

TEST_F(OffScreenTest, whatThePictureShowsIsNotCountedAgain) {
    Room walled;
    walled.wall = -4.0f;
    walled.build();
    const Picture alone = with(walled, kOff);
    EXPECT_GT(highest(alone), 0.2f);
    for (const float what : {kOffScreen, kHidden}) {
        const Picture both = with(walled, what);
        // The wall goes on beside the picture, which is to be counted; well inside there is nothing to add.
        for (uint32_t y = 0; y < walled.visibleHeight(); ++y)
            for (uint32_t x = 48; x < walled.visibleWidth() - 48; ++x) {
                const size_t i = size_t(y) * walled.visibleWidth() + x;
                EXPECT_NEAR(both[i], alone[i], 0.02f) << x << ' ' << y;
            }
    }
}

TEST_F(OffScreenTest, withoutAVolumeTheMethodStandsAloneAndOneLineSaysSo) {
    Room none;
    none.wall = -4.0f;
    none.build();
    none.bits.clear();
    const Picture alone = with(none, kOff);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(with(none, kHidden), alone);
    EXPECT_EQ(std::count_if(logged().begin(), logged().end(), [](const std::string& line) { return line.find("brings no volume") != std::string::npos; }), 1);
}

TEST_F(OffScreenTest, aTallBoxBesideThePictureObscuresAsIfItWereSeen) {
    TallBox box;
    ao::Falloff rho;
    ASSERT_TRUE(ao::parseFalloff("quadratic:2", rho));
    std::vector<double> truth(size_t(TallBox::kWide) * TallBox::kHigh_, 0.0);
    for (uint32_t y = 0; y < TallBox::kHigh_; ++y)
        for (uint32_t x = 0; x < TallBox::kWide; ++x) {
            const float z = box.depth[size_t(y + TallBox::kGuardY) * box.width + x + TallBox::kGuardX];
            std::array<double, 3> p = box.direction(x + TallBox::kGuardX + 0.5, y + TallBox::kGuardY + 0.5);
            for (double& v : p) v *= double(z);
            if (z < 100.0f && std::abs(p[0]) < 3.0 && p[2] > -9.0) truth[size_t(y) * TallBox::kWide + x] = TallBox::truth(p, rho);
        }
    for (const float n : box.normals) ASSERT_TRUE(n == 0.0f || n == 1.0f);  // floor alone: the box is not in the buffer
    for (const ao::MethodInfo* info : offered()) {
        m_method = info->id;
        const Picture alone = with(box, kOff), offscreen = with(box, kOffScreen), hidden = with(box, kHidden);
        double missed[3] = {}, mean = 0.0, everywhere = 0.0;
        size_t count = 0;
        for (size_t i = 0; i < truth.size(); ++i) {
            everywhere += std::abs(double(hidden[i]) - truth[i]);
            if (truth[i] < 0.03) continue;
            mean += truth[i];
            missed[0] += std::abs(double(alone[i]) - truth[i]);
            missed[1] += std::abs(double(offscreen[i]) - truth[i]);
            missed[2] += std::abs(double(hidden[i]) - truth[i]);
            ++count;
        }
        ASSERT_GT(count, 500u);
        const double n = double(count);
        printf("%-17s %zu pixels miss the box, obscurance %.4f there; error alone %.4f, offscreen %.4f, hidden %.4f: %.1f times less; all pixels %.5f\n", info->id, count,
               mean / n, missed[0] / n, missed[1] / n, missed[2] / n, missed[0] / missed[2], everywhere / double(truth.size()));
        EXPECT_LT(missed[1], missed[0] / 8) << info->id;
        EXPECT_LT(missed[2], missed[0] / 8) << info->id;
    }
}

}  // namespace
}  // namespace obscura::test
