// The paper's temporal filter (k = 0.5) on the flythrough of the toasters: reduction of flicker, and trails behind walking
// toasters.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <glm/gtc/packing.hpp>

#include "render/fixture.h"
#include "scene/gltf/gltf.h"

namespace obscura::test {
namespace {

namespace fs = std::filesystem;

class Flythrough : public GpuTest {
protected:
    struct Moves {
        bool camera, toasters;
    };
    // Frames at 30 Hz from `start` seconds on, of the camera path and the animation. What does not move stays at `start`.
    std::vector<Picture> frames(const std::vector<ao::Setting>& settings, float start, int count, Moves moves) {
        const fs::path content = fs::path(OBSCURA_SOURCE_DIR) / "content";
        fs::path file = content / "toasters.glb";
        if (const char* named = std::getenv("OBSCURA_CONTENT"); named && *named && !fs::exists(file))
            file = fs::path(named) / "toasters.glb";
        if (!fs::exists(file)) skip("no " + file.string() + "; build the target 'content', which generates it");
        scene::World world;
        world.add(instanceOf(scene::loadGltf(file)));
        const scene::CameraPath path = scene::loadCameraPath(content / "toasters.path.json");

        const ao::MethodInfo& info = *ao::findMethod("multi_resolution");
        ao::Values values(info);
        for (const ao::Preset& preset : info.presets)
            if (std::string("paper") == preset.id) values.apply(preset);
        for (const ao::Setting& setting : settings) EXPECT_TRUE(values.set(setting.id, setting.value));

        RenderFixture fixture;
        std::vector<Picture> pictures;
        for (int i = 0; i < count; ++i) {
            render::FrameOptions options = fixture.options();
            options.visible = {320, 180};
            options.method = &values;
            const float time = start + float(i) / 30.0f;
            options.time = moves.toasters ? time : start;
            options.camera = path.at(moves.camera ? time : start);
            options.cut = i == 0;
            options.falloff = {ao::FalloffKind::quadratic, 2.0f, 0.0f};
            pictures.push_back(fixture.render(world, options));
            m_near = options.camera.nearPlane;
        }
        return pictures;
    }

    static float visibilityAt(const Picture& p, uint32_t x, uint32_t y) { return glm::unpackHalf1x16(p.visibility.at<uint16_t>(x, y)); }
    float depthAt(const Picture& p, uint32_t x, uint32_t y) const {
        const float device = p.depth.at<float>(x + p.guard.width, y + p.guard.height);
        return device > 0.0f ? m_near / device : INFINITY;
    }

    // Mean over pixels of |A_t(p) - A_{t-1}(p - v(p))|, bilinear, where depth (to 2 %) and normal agree at all four texels.
    double reprojectedDifference(const std::vector<Picture>& pictures) const {
        double sum = 0.0;
        size_t compared = 0;
        for (size_t t = 1; t < pictures.size(); ++t) {
            const Picture &now = pictures[t], &then = pictures[t - 1];
            const uint32_t gx = now.guard.width, gy = now.guard.height, width = now.visibility.width, height = now.visibility.height;
            for (uint32_t y = 0; y < height; ++y)
                for (uint32_t x = 0; x < width; ++x) {
                    const glm::vec2 at = glm::vec2(x, y) + now.motionAt(x + gx, y + gy), corner = glm::floor(at), fraction = at - corner;
                    if (corner.x < 0 || corner.y < 0 || corner.x + 1 >= float(width) || corner.y + 1 >= float(height)) continue;
                    const float z = depthAt(now, x, y);
                    bool agrees = std::isfinite(z);
                    float history = 0.0f;
                    for (uint32_t i = 0; i < 4 && agrees; ++i) {
                        const uint32_t qx = uint32_t(corner.x) + (i & 1), qy = uint32_t(corner.y) + (i >> 1);
                        agrees = std::abs(depthAt(then, qx, qy) / z - 1.0f) < 0.02f &&
                                 glm::dot(then.normalAt(qx + gx, qy + gy), now.normalAt(x + gx, y + gy)) > 0.9f;
                        history +=
                            visibilityAt(then, qx, qy) * (i & 1 ? fraction.x : 1 - fraction.x) * (i >> 1 ? fraction.y : 1 - fraction.y);
                    }
                    if (!agrees) continue;
                    sum += std::abs(double(visibilityAt(now, x, y) - history));
                    ++compared;
                }
        }
        EXPECT_GT(compared, pictures.size() * 5000);
        return sum / double(compared);
    }

    float m_near = 0.0f;
};

// Walking toasters change the true obscurance, which the filter must keep, so their ratio is higher.
TEST_F(Flythrough, filterReducesFlicker) {
    for (const bool toasters : {false, true})
        for (const float start : {2.0f, 12.0f}) {
            const double raw = reprojectedDifference(frames({{"temporal", 0}}, start, 12, {true, toasters}));
            const double filtered = reprojectedDifference(frames({}, start, 12, {true, toasters}));
            printf("from %.1f s%s: reprojected difference %.5f, filtered %.5f, ratio %.3f\n", double(start), toasters ? ", walking" : "",
                raw, filtered, filtered / raw);
            EXPECT_GT(raw, 0.001);
            EXPECT_LE(filtered, (toasters ? 0.65 : 0.6) * raw);
        }
}

// With a resting camera, differences between the filtered and the raw image are caused by history.
TEST_F(Flythrough, walkingToastersLeaveNoTrail) {
    const std::vector<Picture> bare = frames({{"temporal", 0}}, 1.0f, 10, {false, true}), filtered = frames({}, 1.0f, 10, {false, true});
    const Picture &now = filtered.back(), &then = filtered[filtered.size() - 2];
    size_t disoccluded = 0, visible = 0;
    float worst = 0.0f;
    double everywhere = 0.0;
    for (uint32_t y = 0; y < now.visibility.height; ++y)
        for (uint32_t x = 0; x < now.visibility.width; ++x) {
            const float difference = std::abs(visibilityAt(now, x, y) - visibilityAt(bare.back(), x, y));
            everywhere += double(difference);
            visible += difference > 0.1f;
            if (!std::isfinite(depthAt(now, x, y)) || depthAt(then, x, y) > 0.95f * depthAt(now, x, y))
                continue;  // keep only pixels disoccluded in this frame
            worst = std::max(worst, difference);
            ++disoccluded;
        }
    const size_t count = size_t(now.visibility.width) * now.visibility.height;
    printf("%zu px disoccluded, worst %.4f; whole image: mean %.5f, %zu px by more than 0.1\n", disoccluded, double(worst),
        everywhere / double(count), visible);
    EXPECT_GT(disoccluded, 50u);
    EXPECT_LT(worst, 0.1f) << "history of the occluder remains";
    EXPECT_LT(everywhere / double(count), 0.004);
    EXPECT_LT(visible, count / 1000);
}

}  // namespace
}  // namespace obscura::test
