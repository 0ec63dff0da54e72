// Off-screen occluders where the exact value is known: empty voxels add nothing, visible occluders are not counted twice, and a tall box
// outside the image has its exact obscurance.
#include "ao/method_test.h"
#include "tall_box.h"

namespace obscura::test {
namespace {

constexpr float kOff = 0, kOffScreen = 1, kHidden = 2;

class OffScreenTest : public MethodTest {
protected:
    OffScreenTest() : MethodTest("hbao") {}
    // The methods with the parameter `offscreen`.
    static std::vector<const ao::MethodInfo*> offered() {
        std::vector<const ao::MethodInfo*> result;
        for (const ao::MethodInfo* info : ao::methods())
            if (ao::Values(*info).has("offscreen")) result.push_back(info);
        return result;
    }
    Picture with(const Room& room, float offscreen, const char* falloff = "quadratic:2", const std::string& preset = "default") {
        return run(room, values({{"offscreen", offscreen}}, preset), falloff);
    }
    // Obscurance at a world point, bilinear.
    double obscurance(const TallBox& box, const TallBox::Point& p, float offscreen) {
        const Picture picture = with(box, offscreen);
        const auto at = box.pixelOf(p);
        const double fx = at[0] - 0.5, fy = at[1] - 0.5, u = fx - std::floor(fx), v = fy - std::floor(fy);
        EXPECT_TRUE(fx >= 0 && fx < box.visibleWide() - 1 && fy >= 0 && fy < box.visibleTall() - 1) << at[0] << ' ' << at[1];
        const size_t i = size_t(fy) * box.visibleWide() + size_t(fx);
        return (1 - v) * ((1 - u) * double(picture[i]) + u * double(picture[i + 1])) +
               v * ((1 - u) * double(picture[i + box.visibleWide()]) + u * double(picture[i + box.visibleWide() + 1]));
    }
    struct Range {
        double least = 1.0, most = 0.0;
        void add(double v) { least = std::min(least, v), most = std::max(most, v); }
        double changes() const { return 255.0 * (most - least); }  // in 255ths
    };
    Picture with(const TallBox& box, float offscreen) { return run(box, box.seen(), values({{"offscreen", offscreen}}), "quadratic:2"); }
};

TEST_F(OffScreenTest, everyScreenSpaceMethodHasTheParameterAndNeedsAVolume) {
    EXPECT_GE(offered().size(), 6u);
    for (const ao::MethodInfo* info : offered()) {
        ao::Values values(*info);
        EXPECT_FALSE(ao::needs(values) & ao::kVolume) << info->id;
        values.set("offscreen", kOffScreen);
        EXPECT_TRUE(ao::needs(values) & ao::kVolume) << info->id;
    }
    for (const char* id : {"none", "hybrid"}) EXPECT_FALSE(ao::Values(*ao::findMethod(id)).has("offscreen")) << id;
}

TEST_F(OffScreenTest, emptyVoxelsAndPlanesAddNothing) {
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

TEST_F(OffScreenTest, visibleOccludersAreNotCountedTwice) {
    Room walled;
    walled.wall = -4.0f;
    walled.build();
    const Picture alone = with(walled, kOff);
    EXPECT_GT(highest(alone), 0.2f);
    for (const float what : {kOffScreen, kHidden}) {
        const Picture both = with(walled, what);
        // The wall continues outside the image and counts there; well inside the image nothing is added.
        for (uint32_t y = 0; y < walled.visibleHeight(); ++y)
            for (uint32_t x = 48; x < walled.visibleWidth() - 48; ++x) {
                const size_t i = size_t(y) * walled.visibleWidth() + x;
                EXPECT_NEAR(both[i], alone[i], 0.02f) << x << ' ' << y;
            }
    }
    // A box inside the image has hidden faces behind the visible ones, which a horizon method already counts.
    TallBox box({2.0, TallBox::kFloor, -5.5}, {3.2, 1.4, -4.0});
    box.turnTo(-18.0 * TallBox::kPi / 180);
    const double added = mean(with(box, kHidden)) - mean(with(box, kOff));
    EXPECT_GE(added, 0.0);
    printf("a visible box: %.5f added\n", added);
    EXPECT_LT(added, 0.0005);
}

// With depth layers a solid extends from its front to its back, whatever the parameter `thickness`: so the back of a solid box is already
// counted, while behind a box drawn as a thin panel it is not.
TEST_F(OffScreenTest, depthLayersExcludeCountedSolids) {
    TallBox box({2.0, TallBox::kFloor, -5.5}, {3.2, 1.4, -4.0});
    box.turnTo(-18.0 * TallBox::kPi / 180);
    box.thickness.assign(box.depth.size(), 65504.0f);
    box.second.assign(2 * box.depth.size(), 0.0f);
    Room panel = box;
    size_t solids = 0;
    for (uint32_t y = 0; y < box.height; ++y)
        for (uint32_t x = 0; x < box.width; ++x) {
            const TallBox::Point d = box.direction(x + 0.5, y + 0.5), from{50 * d[0], 50 * d[1], 50 * d[2]}, to{-d[0], -d[1], -d[2]};
            const size_t i = size_t(y) * box.width + x;
            int axis = 0;
            const double front = box.hit({0, 0, 0}, d, axis), back = 50.0 - box.hit(from, to, axis);
            if (std::abs(front - double(box.depth[i])) > 1e-3) continue;
            box.thickness[i] = float(back - front);
            panel.thickness[i] = 0.1f;
            ++solids;
        }
    ASSERT_GT(solids, 500u);
    for (const char* method : {"layered", "hbao", "gtao"}) {
        m_method = method;
        const auto added = [&](const Room& room, float thickness) {
            const auto of = [&](float what) {
                Changes changes{{"depth_layers", 3}, {"offscreen", what}};
                if (values({}).has("thickness")) changes.push_back({"thickness", thickness});
                return mean(run(room, box.seen(), values(changes), "quadratic:2"));
            };
            return of(kHidden) - of(kOff);
        };
        const double solid = added(box, 0.1f), hollow = added(panel, 1000.0f);
        printf("%-8s a visible solid box: %.5f added; a thin panel: %.5f added\n", method, solid, hollow);
        EXPECT_GE(solid, 0.0) << method;
        EXPECT_LT(solid, 0.0002) << method;
        EXPECT_GT(hollow, 0.0004) << method;
    }
}

TEST_F(OffScreenTest, withoutVolumeNothingIsAddedAndOneLineIsLogged) {
    Room none;
    none.wall = -4.0f;
    none.build();
    none.bits.clear();
    const Picture alone = with(none, kOff);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(with(none, kHidden), alone);
    EXPECT_EQ(std::count_if(logged().begin(), logged().end(),
                  [](const std::string& line) { return line.find("has no volume") != std::string::npos; }),
        1);
}

TEST_F(OffScreenTest, boxOutsideTheImageHasItsExactObscurance) {
    TallBox box;
    ao::Falloff rho;
    ASSERT_TRUE(ao::parseFalloff("quadratic:2", rho));
    std::vector<double> truth(size_t(box.visibleWide()) * box.visibleTall(), 0.0);
    for (uint32_t y = 0; y < box.visibleTall(); ++y)
        for (uint32_t x = 0; x < box.visibleWide(); ++x) {
            const float z = box.depth[size_t(y + box.guards.height) * box.width + x + box.guards.width];
            TallBox::Point p = box.direction(x + box.guards.width + 0.5, y + box.guards.height + 0.5);
            for (double& v : p) v *= double(z);
            if (z < 100.0f && std::abs(p[0]) < 3.0 && p[2] > -9.0) truth[size_t(y) * box.visibleWide() + x] = box.truth(p, rho);
        }
    for (const float n : box.normals) ASSERT_TRUE(n == 0.0f || n == 1.0f);  // only the floor is in the depth buffer, not the box
    for (const ao::MethodInfo* info : offered()) {
        m_method = info->id;
        const Picture alone = with(box, kOff), offscreen = with(box, kOffScreen), hidden = with(box, kHidden);
        // Error of the result, and of the part added by voxels: some methods obscure a bare floor even without voxels.
        double error[3] = {}, added[3] = {}, mean = 0.0;
        size_t count = 0;
        for (size_t i = 0; i < truth.size(); ++i) {
            if (truth[i] < 0.03) continue;
            mean += truth[i];
            const float seen[3] = {alone[i], offscreen[i], hidden[i]};
            for (int what = 0; what < 3; ++what) {
                error[what] += std::abs(double(seen[what]) - truth[i]);
                added[what] += std::abs(double(seen[what]) - double(alone[i]) - truth[i]);
            }
            ++count;
        }
        ASSERT_GT(count, 500u);
        const double n = double(count);
        printf(
            "%-18s %zu px lack the box, obscurance %.4f; error alone %.4f, offscreen %.4f, hidden %.4f: %.1f times less; of the added part "
            "%.4f: %.1f times\n",
            info->id, count, mean / n, error[0] / n, error[1] / n, error[2] / n, error[0] / error[2], added[2] / n, added[0] / added[2]);
        EXPECT_LT(added[1], added[0] / 8) << info->id;
        EXPECT_LT(added[2], added[0] / 8) << info->id;
        if (!info->baseline) {
            EXPECT_LT(error[2], error[0] / 8) << info->id;
        }
    }
}

// horizon_split can trace voxels above its horizons: it then includes the box, and the off-screen pass adds nothing.
TEST_F(OffScreenTest, raysThroughVoxelsAreNotCountedTwice) {
    m_method = "horizon_split";
    TallBox box;
    const Changes voxels{{"rays_in", 1}}, both{{"rays_in", 1}, {"offscreen", kHidden}};
    EXPECT_TRUE(ao::needs(values(voxels)) & ao::kVolume);
    const Picture traced = run(box, box.seen(), values(voxels), "quadratic:2");
    EXPECT_LT(mean(with(box, kOff)), 1e-4);
    EXPECT_NEAR(mean(traced), mean(with(box, kOffScreen)), 0.1 * mean(traced));
    EXPECT_EQ(run(box, box.seen(), values(both), "quadratic:2"), traced);
    box.bits.clear();  // without a volume rays use the depth buffer
    EXPECT_EQ(run(box, box.seen(), values(voxels), "quadratic:2"), with(box, kOff));
}

// More rays are less noise: with 16 times as many the added obscurance is less than half as far from that of 64.
TEST_F(OffScreenTest, raysRemoveNoise) {
    TallBox box;
    const auto rays = [&](float count) {
        return run(box, box.seen(), values({{"offscreen", kOffScreen}, {"offscreen_rays", count}}), "quadratic:2");
    };
    const Picture most = rays(64);
    const auto away = [&](const Picture& picture) {
        double sum = 0.0;
        for (size_t i = 0; i < most.size(); ++i) sum += std::abs(double(picture[i]) - double(most[i]));
        return sum / double(most.size());
    };
    const double few = away(rays(4)), many = away(rays(48));
    printf("  away from 64 rays: 4 rays %.5f, 48 rays %.5f\n", few, many);
    EXPECT_GT(few, 0.0);
    EXPECT_LT(many, 0.5 * few);
}

// Steps of several cells miss walls that are one cell thick, and shorter ones find no more than the default does.
TEST_F(OffScreenTest, longStridesMissThinWalls) {
    TallBox box({0.1, TallBox::kFloor, -6.0}, {0.15, 1.4, -3.0});  // a sheet, thinner than a cell
    const double alone = mean(with(box, kOff));
    const auto found = [&](float stride) {
        return mean(run(box, box.seen(), values({{"offscreen", kOffScreen}, {"offscreen_rays", 64}, {"offscreen_stride", stride}}),
                   "quadratic:2")) -
               alone;
    };
    const double shortest = found(0.5f), initial = found(1.25f), longest = found(8.0f);
    printf("  a sheet adds: stride 0.5 %.5f, 1.25 %.5f, 8 %.5f\n", shortest, initial, longest);
    EXPECT_GT(shortest, 0.002);
    EXPECT_NEAR(initial, shortest, 0.15 * shortest);
    EXPECT_LT(longest, 0.4 * shortest);
}

// A floor point beside a box. The camera yaws until the box has left the guard band and the point is about to leave the image: the
// obscurance of the point must stay constant.
TEST_F(OffScreenTest, obscuranceIsConstantWhileTheBoxLeavesTheImage) {
    TallBox box({2.0, TallBox::kFloor, -5.5}, {3.2, 1.4, -4.0});
    const TallBox::Point p{1.2, TallBox::kFloor, -4.75};
    ao::Falloff rho;
    ASSERT_TRUE(ao::parseFalloff("quadratic:2", rho));
    const double truth = box.truth(p, rho);
    for (const ao::MethodInfo* info : offered()) {
        m_method = info->id;
        Range whole[2];
        // Methods that are accurate while the box is visible lose it without voxels; with voxels only their noise remains.
        const bool sees =
            std::string(info->id) == "hbao" || std::string(info->id) == "horizon_split" || std::string(info->id) == "far_field";
        for (int step = sees ? 0 : 24; step <= 24; ++step) {
            box.turnTo((31.0 - 60.0 * (1.0 - step / 24.0)) * TallBox::kPi / 180);
            for (const float what : {kOff, kHidden}) whole[what == kHidden].add(obscurance(box, p, what));
        }
        const double outside = obscurance(box, p, kHidden) - obscurance(box, p, kOff);
        printf(
            "%-17s obscurance %.4f changes by %.1f / 255 without voxels, %.1f / 255 with them; voxels add %.4f once the box is outside\n",
            info->id, truth, whole[0].changes(), whole[1].changes(), outside);
        EXPECT_NEAR(outside, truth, 0.02) << info->id;
        if (sees) {
            // Texels at the edge count for points up to one pixel beyond it, which is half a percent of this picture.
            EXPECT_LT(whole[1].changes(), 0.28 * whole[0].changes()) << info->id;
        }
    }
}

// The obscurance added by voxels is fixed to the floor: the box stays outside while the camera yaws in small steps.
TEST_F(OffScreenTest, addedObscuranceIsFixedToTheWorld) {
    m_method = "statistical";
    TallBox box(640);
    for (const double x : {-0.8, -1.2}) {
        Range range;
        for (int step = 0; step <= 8; ++step) {
            box.turnTo(box.away() + 0.008 * step);
            range.add(obscurance(box, {x, TallBox::kFloor, -4.5}, kHidden));
        }
        printf("%.1f m from the box: %.4f to %.4f\n", 0.1 - x, range.least, range.most);
        EXPECT_LT(range.changes(), 1.0) << x;  // noise fixed to pixels would give twice as much
    }
}

}  // namespace
}  // namespace obscura::test
