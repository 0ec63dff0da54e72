// Motion vectors, tested twice: against the previous position of each surface point by the CPU's pose, and by images: the
// colour at a pixel of frame t must be the colour of frame t-1 where the motion vector points.
#include <algorithm>
#include <cmath>

#include "fixture.h"

namespace obscura::test {
namespace {

class Motion : public GpuTest {};

// A CPU rasterizer: triangle, barycentric coordinates and depth of each pixel.
struct Seen {
    int primitive = -1;
    uint32_t triangle = 0;
    glm::vec3 barycentric{0.0f};  // barycentric, world space
    float depth = INFINITY;
};

struct Projector {
    glm::mat4 clip;
    glm::vec2 size;
    Projector(const scene::Camera& camera, const Picture& p)
        : clip(camera.projection({p.size.width, p.size.height}, {p.color.width, p.color.height}) * camera.view()),
          size(p.size.width, p.size.height) {}
    glm::vec3 operator()(const glm::vec3& world) const {  // px, px, linear depth
        const glm::vec4 c = clip * glm::vec4(world, 1.0f);
        return {(glm::vec2(c) / c.w * 0.5f + 0.5f) * size, c.w};
    }
};

std::vector<Seen> rasterize(const std::vector<scene::PosedPrimitive>& posed, const Projector& project) {
    const int width = int(project.size.x), height = int(project.size.y);
    std::vector<Seen> out(size_t(width) * size_t(height));
    for (size_t k = 0; k < posed.size(); ++k) {
        const std::vector<uint32_t>& indices = posed[k].primitive->indices;
        for (uint32_t t = 0; t < indices.size() / 3; ++t) {
            glm::vec3 c[3];
            for (int i = 0; i < 3; ++i) c[i] = project(posed[k].positions[indices[t * 3 + uint32_t(i)]]);
            if (c[0].z <= 0 || c[1].z <= 0 || c[2].z <= 0) continue;
            const auto cross = [](const glm::vec2& a, const glm::vec2& b) { return a.x * b.y - a.y * b.x; };
            const float area = cross(glm::vec2(c[1] - c[0]), glm::vec2(c[2] - c[0]));
            if (std::abs(area) < 1e-6f) continue;
            const auto low = [](float a, float b, float d) { return int(std::floor(std::min({a, b, d}))); };
            const auto high = [](float a, float b, float d) { return int(std::ceil(std::max({a, b, d}))); };
            for (int y = std::max(0, low(c[0].y, c[1].y, c[2].y)); y < std::min(height, high(c[0].y, c[1].y, c[2].y)); ++y)
                for (int x = std::max(0, low(c[0].x, c[1].x, c[2].x)); x < std::min(width, high(c[0].x, c[1].x, c[2].x)); ++x) {
                    const glm::vec2 p(float(x) + 0.5f, float(y) + 0.5f);
                    glm::vec3 b;
                    for (int i = 0; i < 3; ++i) b[i] = cross(glm::vec2(c[(i + 1) % 3]) - p, glm::vec2(c[(i + 2) % 3]) - p) / area;
                    if (b.x < 0 || b.y < 0 || b.z < 0) continue;
                    const glm::vec3 weighted(b.x / c[0].z, b.y / c[1].z, b.z / c[2].z);
                    const float inverse = weighted.x + weighted.y + weighted.z;
                    Seen& seen = out[size_t(y) * size_t(width) + size_t(x)];
                    if (1.0f / inverse < seen.depth) seen = {int(k), t, weighted / inverse, 1.0f / inverse};
                }
        }
    }
    return out;
}

struct Step {
    scene::World world;
    scene::Camera camera;
    float time = 0.0f;
};

struct Errors {
    std::vector<float> exact, fromImages;  // px
    size_t covered = 0;
};

float percentile(std::vector<float> values, float fraction) {
    if (values.empty()) return INFINITY;
    std::sort(values.begin(), values.end());
    return values[size_t(fraction * float(values.size() - 1))];
}

void compare(const Step& before, const Picture& then, const Step& after, const Picture& now, Errors& errors) {
    const Projector projectThen(before.camera, then), projectNow(after.camera, now);
    const auto posedThen = scene::pose(before.world, before.time), posedNow = scene::pose(after.world, after.time);
    ASSERT_EQ(posedThen.size(), posedNow.size());
    const std::vector<Seen> seenNow = rasterize(posedNow, projectNow), seenThen = rasterize(posedThen, projectThen);
    const uint32_t gx = now.guard.width, gy = now.guard.height;
    for (uint32_t y = gy + 2; y + gy + 2 < now.size.height; ++y)
        for (uint32_t x = gx + 2; x + gx + 2 < now.size.width; ++x) {
            const Seen& seen = seenNow[size_t(y) * now.size.width + x];
            const float device = now.depth.at<float>(x, y);
            if (seen.primitive < 0 || device <= 0.0f) continue;
            if (std::abs(after.camera.nearPlane / device - seen.depth) > 1e-3f * seen.depth) continue;  // edges
            ++errors.covered;

            const scene::PosedPrimitive& was = posedThen[size_t(seen.primitive)];
            glm::vec3 point(0.0f);
            for (int i = 0; i < 3; ++i)
                point += seen.barycentric[i] * was.positions[was.primitive->indices[seen.triangle * 3 + uint32_t(i)]];
            const glm::vec3 expected = projectThen(point);
            const glm::vec2 here(float(x) + 0.5f, float(y) + 0.5f), found = here + now.motionAt(x, y);
            errors.exact.push_back(glm::length(found - glm::vec2(expected)));

            // Was the point visible? The surface at the four texels around must be the same one, by depth.
            const glm::ivec2 at(glm::floor(found - 0.5f));
            bool visible =
                at.x > int(gx) && at.y > int(gy) && at.x + 2 < int(then.size.width - gx) && at.y + 2 < int(then.size.height - gy);
            for (int k = 0; k < 4 && visible; ++k) {
                const Seen& there = seenThen[size_t(at.y + k / 2) * then.size.width + size_t(at.x + k % 2)];
                visible = there.primitive == seen.primitive && std::abs(there.depth - expected.z) < 0.02f * expected.z;
            }
            if (!visible) continue;
            const glm::vec2 p = here - glm::vec2(gx, gy), q = found - glm::vec2(gx, gy);
            // Displacement between the images: least squares over the gradients of the channels.
            const glm::vec3 dx = 0.5f * (now.colorAt(p.x + 1, p.y) - now.colorAt(p.x - 1, p.y)),
                            dy = 0.5f * (now.colorAt(p.x, p.y + 1) - now.colorAt(p.x, p.y - 1));
            const glm::vec3 d = then.colorAt(q.x, q.y) - now.colorAt(p.x, p.y);
            const float xx = glm::dot(dx, dx), xy = glm::dot(dx, dy), yy = glm::dot(dy, dy), det = xx * yy - xy * xy;
            // Skip pixels whose pattern is too flat (below ten levels per px in some direction) or too fine.
            if (det < 100.0f * (xx + yy) || std::max(xx, yy) > 2500.0f) continue;
            const float ex = glm::dot(dx, d), ey = glm::dot(dy, d);
            errors.fromImages.push_back(glm::length(glm::vec2(yy * ex - xy * ey, xx * ey - xy * ex) / det));
        }
}

void check(const std::vector<Step>& steps, float guard = 0.1f) {
    RenderFixture fixture;
    Errors errors;
    std::vector<Picture> pictures;
    for (const Step& step : steps) {
        render::FrameOptions options = fixture.options();
        options.camera = step.camera;
        options.time = step.time;
        options.guard = guard;
        options.visible = {480, 360};
        options.view = render::View::baseColor;
        pictures.push_back(fixture.render(step.world, options));
        if (pictures.size() > 1) compare(steps[pictures.size() - 2], pictures[pictures.size() - 2], step, pictures.back(), errors);
    }
    EXPECT_GT(errors.covered, 4000u);
    EXPECT_GT(errors.fromImages.size(), errors.covered / 8);
    EXPECT_LT(percentile(errors.exact, 0.5f), 0.02f);
    EXPECT_LT(percentile(errors.exact, 1.0f), 0.1f);
    EXPECT_LT(percentile(errors.fromImages, 0.5f), 0.1f);
    EXPECT_LT(percentile(errors.fromImages, 0.95f), 0.5f);
    float travelled = 0.0f;  // the surfaces must have moved
    const Picture& last = pictures.back();
    for (uint32_t y = 0; y < last.size.height; ++y)
        for (uint32_t x = 0; x < last.size.width; ++x) travelled = std::max(travelled, glm::length(last.motionAt(x, y)));
    EXPECT_GT(travelled, 1.5f);
}

std::vector<Step> steps(const scene::World& world, int count = 3) {
    Step step{world, RenderFixture().options().camera, 0.3f};
    std::vector<Step> out;
    for (int i = 0; i < count; ++i, step.time += 1.0f / 30.0f) out.push_back(step);
    return out;
}

scene::World worldOf(std::initializer_list<scene::Instance> instances) {
    scene::World world;
    for (const scene::Instance& instance : instances) world.add(instance);
    return world;
}

TEST_F(Motion, nodeAnimation) { check(steps(worldOf({instanceOf(turningCube())}))); }
TEST_F(Motion, skinning) { check(steps(worldOf({instanceOf(bendingBar())}))); }
TEST_F(Motion, morphing) { check(steps(worldOf({instanceOf(wavingPatch())}))); }

TEST_F(Motion, cameraMotion) {
    std::vector<Step> all = steps(worldOf({instanceOf(floorPlate(), {0, -0.6f, 0})}));
    for (size_t i = 0; i < all.size(); ++i) {
        all[i].camera.eye += glm::vec3(0.05f, 0.02f, -0.08f) * float(i);
        all[i].camera.target += glm::vec3(-0.03f, 0.01f, 0.0f) * float(i);
        all[i].camera.fovY *= 1.0f + 0.02f * float(i);
    }
    check(all);
}

TEST_F(Motion, allKindsTogether) {
    std::vector<Step> all = steps(worldOf({instanceOf(turningCube(), {-0.9f, 0.2f, 0.3f}), instanceOf(bendingBar(), {0.9f, 0, -0.5f}),
                                      instanceOf(wavingPatch(), {0, 0.3f, -1.5f}), instanceOf(floorPlate(), {0, -0.8f, 0})}),
        5);
    for (size_t i = 0; i < all.size(); ++i) {
        all[i].camera.eye += glm::vec3(0.04f, 0.03f, -0.05f) * float(i);
        all[i].world.instances()[1].placement[3].x -= 0.05f * float(i);  // moved by the game
    }
    check(all, 0.0f);
    check(all, 0.25f);
}

// New instances grow the posed buffers; the others must keep their previous positions.
TEST_F(Motion, growingBuffersKeepPreviousPositions) {
    RenderFixture fixture;
    scene::World world = worldOf({instanceOf(bendingBar())});
    render::FrameOptions options = fixture.options();
    options.time = 0.3f;
    fixture.render(world, options);
    options.time += 1.0f / 30.0f;
    scene::World more = world;
    for (int i = 0; i < 40; ++i) more.add(instanceOf(wavingPatch(), {0, 0, -50.0f}));
    Picture alone, crowded;
    {
        RenderFixture other;
        other.render(world, [&] {
            auto o = other.options();
            o.time = 0.3f;
            return o;
        }());
        alone = other.render(world, [&] {
            auto o = other.options();
            o.time = options.time;
            return o;
        }());
    }
    crowded = fixture.render(more, options);
    size_t compared = 0;
    for (uint32_t y = 0; y < alone.size.height; ++y)
        for (uint32_t x = 0; x < alone.size.width; ++x) {
            if (alone.depth.at<float>(x, y) <= 0.0f) continue;
            ++compared;
            ASSERT_EQ(alone.motion.at<uint32_t>(x, y), crowded.motion.at<uint32_t>(x, y)) << x << ", " << y;
        }
    EXPECT_GT(compared, 1000u);
}

bool allZero(const Picture& picture) {
    return std::all_of(
        picture.motion.bytes.begin(), picture.motion.bytes.end(), [](std::byte b) { return (b & std::byte{0x7f}) == std::byte{0}; });
}

TEST_F(Motion, isExactlyZeroAtRest) {
    RenderFixture fixture;
    const scene::World world =
        worldOf({instanceOf(turningCube()), instanceOf(bendingBar(), {1, 0, 0}), instanceOf(floorPlate(), {0, -0.8f, 0})});
    render::FrameOptions options = fixture.options();
    options.time = 0.4f;
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(allZero(fixture.render(world, options))) << "frame " << i;
    options.time = 0.5f;
    EXPECT_FALSE(allZero(fixture.render(world, options)));
    options.time = 0.8f;
    options.camera.eye.x += 1.0f;
    options.cut = true;
    EXPECT_TRUE(allZero(fixture.render(world, options))) << "camera cut";
}

}  // namespace
}  // namespace obscura::test
