// Temporal anti-aliasing: a single frame is unchanged, a still picture converges, moved objects leave no trail, motion vectors and views
// are free of jitter, memory is as said.
#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_precision.hpp>

#include "fixture.h"
#include "render/antialias.h"

namespace obscura::test {
namespace {

class AntialiasTest : public GpuTest {
protected:
    static render::FrameOptions options(render::Antialiasing antialiasing) {
        render::FrameOptions options;
        options.visible = {160, 120};
        options.camera.eye = {0.6f, 0.9f, 3.6f};
        options.camera.target = {0.0f, 0.1f, 0.0f};
        options.time = 0.35f;
        static const ao::Values none(*ao::findMethod("none"));
        options.method = &none;
        options.antialiasing = antialiasing;
        return options;
    }
    static constexpr auto kNone = render::Antialiasing::none, kTemporal = render::Antialiasing::temporal;
};

glm::vec3 level(const Pixels& picture, uint32_t x, uint32_t y) { return glm::vec3(picture.at<glm::u8vec4>(x, y)); }

// Without texture, whose detail depends on the size of the picture.
std::shared_ptr<scene::Model> plain(std::shared_ptr<scene::Model> model, const glm::vec4& color) {
    model->materials[0] = {};
    model->materials[0].baseColor = color;
    model->materials[0].metallic = 0.0f;
    return model;
}

double rootMeanSquare(const Pixels& picture, const std::vector<glm::vec3>& reference) {
    double sum = 0.0;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const glm::vec3 off = level(picture, x, y) - reference[size_t(y) * picture.width + x];
            sum += double(glm::dot(off, off)) / 3.0;
        }
    return std::sqrt(sum / double(reference.size()));
}

TEST_F(AntialiasTest, jitterCoversThePixel) {
    EXPECT_EQ(render::antialiasJitter(0), glm::vec2(0.0f));
    bool columns[8] = {};
    double rows = 0.0;
    for (uint64_t i = 0; i < 8; ++i) {
        const glm::vec2 jitter = render::antialiasJitter(i);
        ASSERT_TRUE(jitter.x >= -0.5f && jitter.x < 0.5f && jitter.y >= -0.5f && jitter.y < 0.5f);
        columns[int((jitter.x + 0.5f) * 8.0f)] = true;
        rows += double(jitter.y) / 8.0;
        EXPECT_EQ(render::antialiasJitter(i + 8), jitter);
    }
    EXPECT_TRUE(std::all_of(std::begin(columns), std::end(columns), [](bool seen) { return seen; }));
    EXPECT_LT(std::abs(rows), 0.05);
}

TEST_F(AntialiasTest, firstFrameAndFrameAfterACutAreUnchanged) {
    RenderFixture with, without;
    const scene::World world = mixedWorld();
    render::FrameOptions on = options(kTemporal), off = options(kNone);
    EXPECT_EQ(with.render(world, on).color, without.render(world, off).color);
    for (int i = 0; i < 5; ++i) with.render(world, on);
    EXPECT_NE(with.render(world, on).color, without.render(world, off).color);
    on.camera.eye.x = off.camera.eye.x = -0.8f;
    on.cut = off.cut = true;
    EXPECT_EQ(with.render(world, on).color, without.render(world, off).color);
}

// The reference has 64 samples a pixel: the mean of 8x8 pixels of a larger picture.
TEST_F(AntialiasTest, stillPictureConverges) {
    RenderFixture fixture;
    scene::World world;
    world.add(instanceOf(plain(turningCube(), {0.9f, 0.1f, 0.1f, 1.0f})));
    world.add(instanceOf(plain(bendingBar(), {0.1f, 0.4f, 0.9f, 1.0f}), {0.9f, 0, -0.5f}));
    world.add(instanceOf(plain(floorPlate(), {0.5f, 0.5f, 0.5f, 1.0f}), {0, -0.6f, 0}));
    render::FrameOptions large = options(kNone), on = options(kTemporal);
    large.visible = {160 * 8, 120 * 8};
    const Picture samples = fixture.render(world, large);
    std::vector<glm::vec3> reference(160 * 120, glm::vec3(0.0f));
    for (uint32_t y = 0; y < 120 * 8; ++y)
        for (uint32_t x = 0; x < 160 * 8; ++x) reference[size_t(y / 8) * 160 + x / 8] += level(samples.color, x, y) / 64.0f;
    on.cut = true;
    const double first = rootMeanSquare(fixture.render(world, on).color, reference);
    on.cut = false;
    double after8 = 0.0, after32 = 0.0;
    for (int i = 1; i < 32; ++i) {
        after32 = rootMeanSquare(fixture.render(world, on).color, reference);
        if (i == 7) after8 = after32;
    }
    std::printf("  RMSE to 64 samples, levels of 255: %.2f, after 8 frames %.2f, after 32 %.2f\n", first, after8, after32);
    EXPECT_LT(after8, 0.6 * first);
    EXPECT_LT(after32, 0.6 * first);
}

// A cube moves over a floor, 4 px a frame: floor that it has uncovered is at once as in a picture without anti-aliasing, but for what
// samples differ by.
TEST_F(AntialiasTest, movedObjectLeavesNoTrail) {
    RenderFixture with, without;
    scene::World world;
    scene::Instance cube = instanceOf(plain(turningCube(), {0.9f, 0.1f, 0.1f, 1.0f}));
    cube.animation = -1;
    world.add(instanceOf(plain(floorPlate(), {0.5f, 0.5f, 0.5f, 1.0f}), {0, -0.6f, 0}));
    world.add(cube);
    std::vector<Picture> raw;
    double worst = 0.0;
    size_t uncovered = 0;
    for (int i = 0; i < 12; ++i) {
        world.instances()[1].placement = glm::translate(glm::mat4(1.0f), glm::vec3(-1.2f + 0.12f * float(i), 0.0f, 0.0f));
        const Picture smooth = with.render(world, options(kTemporal));
        raw.push_back(without.render(world, options(kNone)));
        if (i < 4) continue;
        const auto isCube = [&](const Picture& p, uint32_t x, uint32_t y) {
            const glm::vec3 c = level(p.color, x, y);
            return c.r > 2.0f * c.g;
        };
        for (uint32_t y = 2; y < 118; ++y)
            for (uint32_t x = 2; x < 158; ++x) {
                bool was = false, isNear = false;
                for (int k = 1; k <= 3; ++k) was = was || isCube(raw[size_t(i - k)], x, y);
                glm::vec3 low(255.0f), high(0.0f);
                for (uint32_t v = y - 2; v <= y + 2; ++v)
                    for (uint32_t u = x - 2; u <= x + 2; ++u) {
                        isNear = isNear || isCube(raw.back(), u, v);
                        low = glm::min(low, level(raw.back().color, u, v));
                        high = glm::max(high, level(raw.back().color, u, v));
                    }
                if (!was || isNear) continue;
                ++uncovered;
                const glm::vec3 c = level(smooth.color, x, y), off = glm::max(glm::max(low - c, c - high), glm::vec3(0.0f));
                worst = std::max(worst, double(std::max({off.r, off.g, off.b})));
            }
    }
    std::printf("  %zu uncovered pixels, worst trail %.0f levels\n", uncovered, worst);
    EXPECT_GT(uncovered, 500u);
    EXPECT_LE(worst, 3.0) << "levels of 255 outside of what lies around the pixel";
}

// Pixels that show what the cube hid hold this frame's sample alone, as in a renderer without history.
TEST_F(AntialiasTest, uncoveredPixelsBeginAnew) {
    RenderFixture with, later;
    scene::World world;
    scene::Instance cube = instanceOf(turningCube(), {0.0f, 0.2f, 1.0f});
    cube.animation = -1;
    world.add(instanceOf(floorPlate(), {0, -0.6f, 0}));
    world.add(cube);
    Picture before, after, anew;
    for (int i = 0; i < 6; ++i) {
        if (i == 5) world.instances()[1].placement = glm::translate(glm::mat4(1.0f), glm::vec3(3.0f, 0.2f, -1.0f));
        before = after;
        after = with.render(world, options(kTemporal));
        anew = later.render(world, options(i == 5 ? kTemporal : kNone));
    }
    size_t uncovered = 0, same = 0;
    for (uint32_t y = 3; y < 117; ++y)
        for (uint32_t x = 3; x < 157; ++x) {
            bool was = true;  // depth is reversed: larger is nearer
            for (uint32_t v = y - 2; v <= y + 2; ++v)
                for (uint32_t u = x - 2; u <= x + 2; ++u) {
                    const float then = before.depth.at<float>(u + before.guard.width, v + before.guard.height);
                    was = was && then > 1.25f * after.depth.at<float>(u + after.guard.width, v + after.guard.height);
                }
            if (!was) continue;
            ++uncovered;
            same += level(after.color, x, y) == level(anew.color, x, y);
        }
    std::printf("  %zu uncovered pixels, %zu begin anew\n", uncovered, same);
    EXPECT_GT(uncovered, 500u);
    EXPECT_EQ(same, uncovered);
}

TEST_F(AntialiasTest, motionIsFreeOfJitter) {
    RenderFixture with, without;
    const scene::World world = mixedWorld();
    render::FrameOptions on = options(kTemporal), off = options(kNone);
    for (int i = 0; i < 3; ++i) {
        const Picture still = with.render(world, on);
        without.render(world, off);
        EXPECT_TRUE(std::all_of(
            still.motion.bytes.begin(), still.motion.bytes.end(), [](std::byte b) { return (b & std::byte{0x7f}) == std::byte{0}; }));
    }
    for (int i = 0; i < 4; ++i) {
        on.camera.eye.x = off.camera.eye.x += 0.03f;
        const Picture a = with.render(world, on), b = without.render(world, off);
        EXPECT_NE(a.depth, b.depth) << "jittered";
        glm::dvec2 mean(0.0);
        size_t count = 0;
        for (uint32_t y = 0; y < a.motion.height; ++y)
            for (uint32_t x = 0; x < a.motion.width; ++x) {
                const glm::dvec2 off2 = glm::dvec2(a.motionAt(x, y)) - glm::dvec2(b.motionAt(x, y));
                if (glm::length(off2) > 1.0) continue;  // another surface
                mean += off2;
                ++count;
            }
        EXPECT_LT(glm::length(mean) / double(count), 0.02) << "px";
    }
}

// Other views and sampled frames are those without anti-aliasing, and leave no history behind.
TEST_F(AntialiasTest, viewsAndSamplesAreNotMoved) {
    RenderFixture switched, plain, later;
    const scene::World world = mixedWorld();
    render::FrameOptions on = options(kTemporal), off = options(kNone);
    for (int i = 0; i < 3; ++i) {
        switched.render(world, on);
        plain.render(world, off);
        later.render(world, off);
    }
    on.camera.eye.x = off.camera.eye.x = 0.9f;
    on.view = off.view = render::View::visibility;
    EXPECT_EQ(switched.render(world, on).depth, plain.render(world, off).depth);
    on.view = off.view = render::View::final;
    on.sampleStep = off.sampleStep = 4;
    const Picture sampled = switched.render(world, on), expected = plain.render(world, off);
    EXPECT_EQ(sampled.depth, expected.depth);
    EXPECT_EQ(sampled.color, expected.color);
    on.sampleStep = off.sampleStep = 0;
    for (int i = 0; i < 2; ++i) later.render(world, off);
    EXPECT_EQ(switched.render(world, on).color, later.render(world, on).color) << "begins anew";
}

TEST_F(AntialiasTest, holdsSixteenBytesAPixel) {
    const scene::World world = mixedWorld();
    uint64_t bytes[2] = {};
    for (const auto antialiasing : {kNone, kTemporal}) {
        RenderFixture fixture;
        render::FrameOptions frame = options(antialiasing);
        frame.visible = {640, 480};
        for (int i = 0; i < 4; ++i) fixture.render(world, frame);
        device().waitIdle();
        bytes[antialiasing == kTemporal] = device().memoryUse();
    }
    const uint64_t more = bytes[1] - bytes[0], history = 16ull * 640 * 480;
    EXPECT_GE(more, history);
    EXPECT_LE(more, history + 65536);
}

}  // namespace
}  // namespace obscura::test
