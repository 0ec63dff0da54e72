// Depth layers behind the visible surface, drawn by either technique, for every kind of geometry.
#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "fixture.h"
#include "render/layers.h"
#include "scene/pose.h"

namespace obscura::test {
namespace {

constexpr float kNear = 0.05f;

float depthAt(const Picture& picture, uint32_t x, uint32_t y) {  // linear; 0: sky
    const float d = picture.depth.at<float>(x, y);
    return d > 0.0f ? kNear / d : 0.0f;
}
float thicknessAt(const Picture& picture, uint32_t x, uint32_t y) { return glm::unpackHalf1x16(picture.thickness.at<uint16_t>(x, y)); }

class Layers : public GpuTest {
protected:
    Picture draw(const scene::World& world, ao::LayerMode use, render::LayerForm form,
        const std::function<void(render::FrameOptions&)>& change = {}) {
        m_values.set("depth_layers", float(use));
        render::FrameOptions options = m_fixture.options();
        options.method = &m_values;
        options.camera.nearPlane = kNear;
        options.view = render::View::visibility;
        options.layerForm = form;
        options.cut = true;
        if (change) change(options);
        return m_fixture.render(world, options);
    }
    Picture draw(const scene::World& world) { return draw(world, ao::LayerMode::second, render::LayerForm::best); }

    RenderFixture m_fixture;
    ao::Values m_values{*ao::findMethod("layered")};
};

scene::World oneWorld(std::shared_ptr<const scene::Model> model) {
    scene::World world;
    world.add(instanceOf(std::move(model)));
    return world;
}

// Number of covered pixels, and of those with finite thickness and with none.
struct Counts {
    size_t covered = 0, thick = 0, sheet = 0;
};
Counts count(const Picture& picture) {
    Counts result;
    for (uint32_t y = 0; y < picture.size.height; ++y)
        for (uint32_t x = 0; x < picture.size.width; ++x) {
            if (depthAt(picture, x, y) == 0.0f) continue;
            ++result.covered;
            const float t = thicknessAt(picture, x, y);
            result.thick += t > 0.0f && t < 100.0f;
            result.sheet += t == 0.0f;
        }
    return result;
}

TEST_F(Layers, thicknessOfACubeIsExact) {
    const scene::World world = oneWorld(turningCube());
    render::FrameOptions camera = m_fixture.options();
    const Picture picture = draw(world);
    const scene::Instance& instance = world.instances()[0];
    const glm::mat4 toCube = glm::inverse(instance.placement * scene::evaluate(*instance.model, instance.animation, 0.0f).world[0]);
    const glm::mat4 toWorld = glm::inverse(camera.camera.view());
    const glm::vec2 size(picture.size.width, picture.size.height);
    const glm::mat4 lens = camera.camera.projection(size, glm::vec2(320, 240));
    size_t covered = 0;
    for (uint32_t y = 0; y < picture.size.height; ++y)
        for (uint32_t x = 0; x < picture.size.width; ++x) {
            const float z = depthAt(picture, x, y);
            if (z == 0.0f) continue;
            const glm::vec2 ndc = (glm::vec2(x, y) + 0.5f) / size * 2.0f - 1.0f;
            const glm::vec3 ray(ndc.x / lens[0][0], ndc.y / lens[1][1], -1.0f);
            const glm::vec3 o = glm::vec3(toCube * toWorld * glm::vec4(0, 0, 0, 1)), d = glm::mat3(toCube) * glm::mat3(toWorld) * ray;
            const glm::vec3 a = (glm::vec3(-0.5f) - o) / d, b = (glm::vec3(0.5f) - o) / d, near = glm::min(a, b), far = glm::max(a, b);
            const float in = std::max({near.x, near.y, near.z}), out = std::min({far.x, far.y, far.z});
            if (out - in < 0.02f) continue;  // edges through pixel centres
            EXPECT_NEAR(z, in, 1e-3f);
            EXPECT_NEAR(thicknessAt(picture, x, y), out - in, 2e-3f) << x << " " << y;
            ++covered;
        }
    EXPECT_GT(covered, 3000u);
}

TEST_F(Layers, layersAreOrderedByDepth) {
    const Picture picture =
        draw(mixedWorld(), ao::LayerMode::second, render::LayerForm::best, [](render::FrameOptions& o) { o.time = 0.35f; });
    size_t seconds = 0, solids = 0;
    for (uint32_t y = 0; y < picture.size.height; ++y)
        for (uint32_t x = 0; x < picture.size.width; ++x) {
            const float z = depthAt(picture, x, y), t = thicknessAt(picture, x, y);
            const glm::vec2 second = picture.second.at<glm::vec2>(x, y);
            if (z == 0.0f) {
                EXPECT_EQ(t, 65504.0f);
                continue;
            }
            EXPECT_GE(t, 0.0f);
            EXPECT_GE(second.y, 0.0f);
            solids += t > 0.0f;
            if (second.x == 0.0f) continue;
            ++seconds;
            EXPECT_GE(second.x * 1.001f, z + t) << x << " " << y;
            EXPECT_GT(second.x, z);
        }
    EXPECT_GT(solids, 5000u);
    EXPECT_GT(seconds, 4000u);
}

TEST_F(Layers, bothTechniquesGiveTheSameLayers) {
    if (!device().caps().fragmentWrites) skip("the device's fragment shaders do not write");
    for (const float time : {0.0f, 0.35f, 0.8f}) {
        const auto at = [&](render::FrameOptions& o) { o.time = time; };
        const Picture peeled = draw(mixedWorld(), ao::LayerMode::second, render::LayerForm::peeling, at);
        const Picture climbed = draw(mixedWorld(), ao::LayerMode::second, render::LayerForm::ladder, at);
        size_t thicknesses = 0, seconds = 0;
        for (uint32_t y = 0; y < peeled.size.height; ++y)
            for (uint32_t x = 0; x < peeled.size.width; ++x) {
                thicknesses += thicknessAt(peeled, x, y) != thicknessAt(climbed, x, y);
                seconds += peeled.second.at<glm::vec2>(x, y) != climbed.second.at<glm::vec2>(x, y);
            }
        EXPECT_EQ(thicknesses, 0u) << time;
        EXPECT_EQ(seconds, 0u) << time;
    }
}

TEST_F(Layers, cheaperTechniqueIsChosenByTime) {
    const auto found = [](double peel, double ladder) {  // ms per peeling pass, ms of the ladder
        render::FormTrial trial;
        graph::Timings arrived;
        for (int frame = 0; frame < 40; ++frame) {
            const bool climbs = trial.next(arrived) == render::LayerForm::ladder;
            if (peel == 0.0) continue;
            const double compiling = frame < 2 ? 100.0 * (climbs ? peel : ladder) : 0.0;
            arrived.frame = uint64_t(frame + 1);
            if (climbs) arrived.passes = {{"layers.clear", 0.1}, {"layers.ladder", ladder + compiling}};
            else arrived.passes = {{"layers.second hit", peel + compiling}, {"layers.third hit", peel}, {"layers.fourth hit", peel}};
        }
        return trial.chosen();
    };
    EXPECT_EQ(found(1.0, 2.5), render::LayerForm::ladder);
    EXPECT_EQ(found(1.0, 3.5), render::LayerForm::peeling);
    EXPECT_EQ(found(0.0, 0.0), render::LayerForm::ladder);  // a device without timestamps
    if (!device().caps().fragmentWrites) skip("the device's fragment shaders do not write");
    // The technique does not change the images.
    Picture first;
    for (int frame = 0; frame < 12; ++frame) {
        const Picture picture = draw(mixedWorld());
        if (frame == 0) first = picture;
        EXPECT_EQ(picture.thickness, first.thickness) << frame;
        EXPECT_EQ(picture.second, first.second) << frame;
    }
    EXPECT_TRUE(std::any_of(logged().begin(), logged().end(),
        [](const std::string& line) { return line.find("layers: two depth layers are drawn by") != std::string::npos; }));
}

TEST_F(Layers, halfSizeIsEverySecondPixel) {
    for (const render::LayerForm form : {render::LayerForm::peeling, render::LayerForm::ladder}) {
        const auto odd = [](render::FrameOptions& o) { o.visible = {301, 199}; };
        const Picture whole = draw(mixedWorld(), ao::LayerMode::second, form, odd),
                      half = draw(mixedWorld(), ao::LayerMode::secondHalf, form, odd);
        EXPECT_EQ(whole.thickness, half.thickness);
        EXPECT_EQ(half.second.width, (whole.second.width + 1) / 2);
        size_t different = 0, there = 0;
        for (uint32_t y = 0; y < half.second.height; ++y)
            for (uint32_t x = 0; x < half.second.width; ++x) {
                const glm::vec2 a = whole.second.at<glm::vec2>(2 * x, 2 * y), b = half.second.at<glm::vec2>(x, y);
                there += a.x > 0.0f;
                different += std::abs(a.x - b.x) > 2e-3f * a.x || std::abs(a.y - b.y) > 5e-3f;
            }
        EXPECT_GT(there, 500u);
        EXPECT_LT(different, there / 100) << int(form);  // edges through pixel centres
    }
}

TEST_F(Layers, closedMeshesAreSolid) {
    scene::World mirrored;
    scene::Instance cube = instanceOf(turningCube());
    cube.placement = glm::scale(glm::mat4(1.0f), glm::vec3(-1.0f, 1.0f, 1.0f));
    mirrored.add(cube);
    for (const scene::World& world : {oneWorld(turningCube()), mirrored, oneWorld(bendingBar())}) {
        const Counts counts =
            count(draw(world, ao::LayerMode::second, render::LayerForm::best, [](render::FrameOptions& o) { o.time = 0.7f; }));
        EXPECT_GT(counts.covered, 2000u);
        EXPECT_GT(double(counts.thick), 0.98 * double(counts.covered));
    }
}

TEST_F(Layers, enclosingSolidEndsAtItsOwnBack) {
    scene::World alone = oneWorld(turningCube()), holding = alone;
    scene::Instance within = instanceOf(turningCube());
    within.placement = within.placement * glm::scale(glm::mat4(1.0f), glm::vec3(0.5f));
    holding.add(within);
    const Picture bare = draw(alone), full = draw(holding);
    size_t covered = 0, different = 0;
    for (uint32_t y = 0; y < bare.size.height; ++y)
        for (uint32_t x = 0; x < bare.size.width; ++x) {
            if (depthAt(bare, x, y) == 0.0f) continue;
            ++covered;
            different += thicknessAt(bare, x, y) != thicknessAt(full, x, y);
        }
    EXPECT_GT(covered, 2000u);
    EXPECT_LT(different, covered / 100);
}

TEST_F(Layers, openMeshesAreSheets) {
    for (const auto& model : {wavingPatch(), floorPlate()}) {
        const Counts counts = count(draw(oneWorld(model)));
        EXPECT_GT(counts.covered, 2000u);
        EXPECT_EQ(counts.sheet, counts.covered);
    }
    // The back side of an open sheet is a sheet as well.
    scene::Material both;
    both.doubleSided = true;
    scene::World world = oneWorld(with(wavingPatch(), both));
    const Counts behind = count(
        draw(world, ao::LayerMode::second, render::LayerForm::best, [](render::FrameOptions& o) { o.camera.eye.z = -o.camera.eye.z; }));
    EXPECT_GT(behind.covered, 2000u);
    EXPECT_EQ(behind.sheet, behind.covered);
}

TEST_F(Layers, materialsOverrideTheShell) {
    scene::Material sheet;
    sheet.shell = scene::Shell::sheet;
    const Counts open = count(draw(oneWorld(with(turningCube(), sheet))));
    EXPECT_GT(open.covered, 2000u);
    EXPECT_EQ(open.sheet, open.covered);

    const auto wrong = [](scene::Shell shell) {  // wound inside out
        scene::Material material;
        material.doubleSided = true;
        material.shell = shell;
        auto model = with(turningCube(), material);
        auto& indices = model->meshes[0].primitives[0].indices;
        for (size_t i = 0; i + 2 < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
        return model;
    };
    const Counts unflipped = count(draw(oneWorld(wrong(scene::Shell::solid)))),
                 flipped = count(draw(oneWorld(wrong(scene::Shell::flipped))));
    EXPECT_EQ(unflipped.sheet, unflipped.covered);
    EXPECT_GT(double(flipped.thick), 0.98 * double(flipped.covered));
}

TEST_F(Layers, maskedHolesAreTransparent) {
    for (const render::LayerForm form : {render::LayerForm::peeling, render::LayerForm::ladder}) {
        const auto world = [](float alpha) {
            scene::Material masked;
            masked.alphaMode = scene::AlphaMode::mask;
            masked.baseColor.a = alpha;
            scene::World result;
            result.add(instanceOf(turningCube(), {0, 0, 0.5f}));
            result.add(instanceOf(with(turningCube(), masked), {0.1f, 0, -1.5f}));
            return result;
        };
        const Picture holes = draw(world(0.2f), ao::LayerMode::second, form), there = draw(world(0.8f), ao::LayerMode::second, form);
        size_t behind = 0;
        for (uint32_t y = 0; y < there.size.height; ++y)
            for (uint32_t x = 0; x < there.size.width; ++x) {
                EXPECT_EQ(holes.second.at<glm::vec2>(x, y).x, 0.0f);
                behind += there.second.at<glm::vec2>(x, y).x > 0.0f && there.second.at<glm::vec2>(x, y).y > 0.0f;
            }
        EXPECT_GT(behind, 200u);
    }
}

TEST_F(Layers, guardBandHasLayers) {
    const auto guard = [](float fraction) { return [fraction](render::FrameOptions& o) { o.guard = fraction; }; };
    const Picture bare = draw(mixedWorld(), ao::LayerMode::second, render::LayerForm::best, guard(0.0f));
    const Picture guarded = draw(mixedWorld(), ao::LayerMode::second, render::LayerForm::best, guard(0.2f));
    size_t different = 0;
    for (uint32_t y = 0; y < 240; ++y)
        for (uint32_t x = 0; x < 320; ++x) different += std::abs(thicknessAt(bare, x, y) - thicknessAt(guarded, x + 64, y + 48)) > 3e-3f;
    EXPECT_LT(different, 60u);  // edges through pixel centres
    size_t solid = 0;
    for (uint32_t y = 0; y < guarded.size.height; ++y)
        for (uint32_t x = 0; x < 64; ++x) solid += thicknessAt(guarded, x, y) != 65504.0f;
    EXPECT_GT(solid, 1000u);
}

TEST_F(Layers, otherMethodsDrawNoLayers) {
    const ao::Values hbao(*ao::findMethod("hbao"));
    const Picture picture =
        draw(mixedWorld(), ao::LayerMode::second, render::LayerForm::best, [&](render::FrameOptions& o) { o.method = &hbao; });
    EXPECT_TRUE(picture.thickness.bytes.empty());
}

}  // namespace
}  // namespace obscura::test
