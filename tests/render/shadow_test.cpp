// The sun's shadow: penumbrae are as wide as the distance of what casts them asks for, open floor has none.
#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_precision.hpp>

#include "fixture.h"

namespace obscura::test {
namespace {

class SunShadow : public GpuTest {
protected:
    // From above, 300 px to the metre, x to the right.
    static render::FrameOptions above(const RenderFixture& fixture) {
        render::FrameOptions options = fixture.options();
        options.camera.eye = {0.0f, 3.0f, 0.0f};
        options.camera.target = {0.0f, 0.0f, 0.0f};
        options.camera.up = {0.0f, 0.0f, -1.0f};
        options.camera.orthoHalfHeight = 0.4f;
        options.sun.direction = {1.0f, -1.0f, 0.0f};
        options.shadowSize = 4096;
        return options;
    }
};

scene::Instance plainFloor() {
    auto floor = floorPlate();
    floor->materials[0] = {};
    floor->materials[0].baseColor = {0.5f, 0.5f, 0.5f, 1.0f};
    floor->materials[0].metallic = 0.0f;
    floor->materials[0].roughness = 1.0f;
    return instanceOf(floor);
}

// A plate at height h, with an edge at x = -h: the shadow's edge is at x = 0, its penumbra 2 h times the sun's diameter wide (45 degrees).
TEST_F(SunShadow, penumbraGrowsWithDistance) {
    float widths[2];
    for (const int i : {0, 1}) {
        RenderFixture fixture;
        const float height = i == 0 ? 0.35f : 0.7f;
        scene::World world;
        world.add(plainFloor());
        scene::Instance plate = plainFloor();
        plate.placement =
            glm::translate(glm::mat4(1.0f), glm::vec3(-height - 1.0f, height, 0.0f)) * glm::scale(glm::mat4(1.0f), glm::vec3(1.0f / 3.0f));
        world.add(plate);
        const Picture picture = fixture.render(world, above(fixture));
        const auto light = [&](uint32_t x) { return float(picture.color.at<glm::u8vec4>(x, 120).g); };
        const float dark = light(100), bright = light(300);
        EXPECT_GT(bright, dark + 40.0f);
        const auto crossing = [&](float share) {
            uint32_t x = 100;
            while (x < 300 && light(x) < glm::mix(dark, bright, share)) ++x;
            return float(x);
        };
        widths[i] = (crossing(0.9f) - crossing(0.1f)) / 300.0f;
        EXPECT_NEAR(0.5f * (crossing(0.9f) + crossing(0.1f)), 160.0f, 4.0f) << "px: the shadow is where it belongs";
        std::printf("  height %.2f m: %.1f mm from 10 to 90 %% of the light, the penumbra is %.1f mm\n", height, widths[i] * 1e3f,
            2e3f * height * 0.02f);
        EXPECT_GT(widths[i], 0.35f * 2.0f * height * 0.02f);
        EXPECT_LT(widths[i], 1.0f * 2.0f * height * 0.02f);
    }
    EXPECT_GT(widths[1], 1.4f * widths[0]);
}

// No surface shadows itself, at any height of the sun.
TEST_F(SunShadow, openFloorIsLitEvenly) {
    RenderFixture fixture;
    scene::World world;
    world.add(plainFloor());
    for (const float slope : {0.0f, 1.0f, 3.0f, 8.0f}) {
        render::FrameOptions options = above(fixture);
        options.camera.orthoHalfHeight = 1.5f;
        options.shadowSize = 512;
        options.sun.direction = {slope, -1.0f, 0.3f * slope};
        const Picture picture = fixture.render(world, options);
        uint8_t low = 255, high = 0;
        for (uint32_t y = 0; y < 240; ++y)
            for (uint32_t x = 0; x < 320; ++x) {
                const uint8_t g = picture.color.at<glm::u8vec4>(x, y).g;
                low = std::min(low, g);
                high = std::max(high, g);
            }
        EXPECT_LE(high - low, 6) << "slope " << slope << ", levels of 255 (reflection changes a little over the picture)";
    }
}

}  // namespace
}  // namespace obscura::test
