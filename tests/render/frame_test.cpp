// Whole frames: guard band, culling, determinism, normals, views, released memory.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/type_precision.hpp>

#include "fixture.h"
#include "graph/executor.h"

namespace obscura::test {
namespace {

class Frame : public GpuTest {};

TEST_F(Frame, guardBandDoesNotChangeTheVisiblePart) {
    RenderFixture fixture;
    const scene::World world = mixedWorld();
    render::FrameOptions options = fixture.options();
    options.time = 0.35f;
    options.guard = 0.0f;
    const Picture bare = fixture.render(world, options);
    options.guard = 0.2f;
    const Picture guarded = fixture.render(world, options);
    EXPECT_EQ(guarded.guard.width, 64u);
    EXPECT_EQ(guarded.guard.height, 48u);
    EXPECT_EQ(guarded.size.width, 448u);
    size_t different = 0, covered = 0;
    for (uint32_t y = 0; y < 240; ++y)
        for (uint32_t x = 0; x < 320; ++x) {
            const float a = bare.depth.at<float>(x, y), b = guarded.depth.at<float>(x + 64, y + 48);
            covered += a > 0.0f;
            different += std::abs(a - b) > 1e-5f * std::max(a, b);
        }
    EXPECT_GT(covered, 30000u);
    EXPECT_LT(different, 20u);  // edges through pixel centres
    EXPECT_TRUE(guarded.depth.at<float>(20, 240) > 0.0f) << "the floor continues in the guard band";
}

// The view of bent normals is that of normals where nothing is blocked, and light from them then the same; elsewhere both differ.
TEST_F(Frame, bentNormalsBendWhereLightIsBlocked) {
    RenderFixture fixture;
    const scene::World world = mixedWorld();
    render::FrameOptions options = fixture.options();
    ao::Values layered(*ao::findMethod("layered"));
    options.method = &layered;
    options.falloff = {ao::FalloffKind::quadratic, 0.5f};
    const auto drawn = [&](render::View view, bool bent) {
        options.view = view;
        options.bentNormals = bent;
        options.cut = true;
        return fixture.render(world, options);
    };
    const Picture normals = drawn(render::View::normals, false), bent = drawn(render::View::bentNormals, false),
                  plain = drawn(render::View::final, false), lit = drawn(render::View::final, true);
    double openBend = 0.0, blockedBend = 0.0, open = 0.0, blocked = 0.0, openLight = 0.0, blockedLight = 0.0;
    for (uint32_t y = 2; y < 238; ++y)
        for (uint32_t x = 2; x < 318; ++x) {
            if (!(normals.depth.at<float>(x + normals.guard.width, y + normals.guard.height) > 0.0f)) continue;
            const float visibility = glm::unpackHalf1x16(plain.visibility.at<uint16_t>(x, y));
            double bend = 0.0, light = 0.0;
            for (int channel = 0; channel < 3; ++channel) {
                const auto level = [&](const Pixels& of) { return double(of.at<glm::u8vec4>(x, y)[channel]); };
                bend = std::max(bend, std::abs(level(normals.color) - level(bent.color)));
                light = std::max(light, std::abs(level(plain.color) - level(lit.color)));
            }
            if (visibility > 0.999f) openBend += bend, openLight += light, open += 1.0;
            if (visibility < 0.75f) blockedBend += bend, blockedLight += light, blocked += 1.0;
        }
    ASSERT_GT(open, 1000.0);
    ASSERT_GT(blocked, 100.0);
    EXPECT_LT(openBend / open, 1.0) << "levels of 255";
    EXPECT_GT(blockedBend / blocked, 25.0);
    EXPECT_LT(openLight / open, 0.3);
    EXPECT_GT(blockedLight / blocked, 4.0);
    EXPECT_EQ(drawn(render::View::final, false).color, plain.color);
    options.method = fixture.options().method;  // none
    EXPECT_EQ(drawn(render::View::bentNormals, false).color, drawn(render::View::visibility, false).color);
}

TEST_F(Frame, cullingIsInvisible) {
    RenderFixture fixture;
    scene::World world = mixedWorld();
    for (int i = 0; i < 12; ++i) world.add(instanceOf(bendingBar(), {3.0f * std::cos(float(i)), 0.0f, 5.0f * std::sin(float(i))}));
    render::FrameOptions options = fixture.options();
    options.camera.eye = {0, 0.4f, 1.0f};
    for (const float turn : {0.0f, 1.3f, 2.6f, 4.0f, 5.2f}) {
        options.camera.target = options.camera.eye + glm::vec3(std::sin(turn), -0.1f, -std::cos(turn));
        options.time = turn * 0.15f;
        options.cut = true;
        options.cull = true;
        const Picture culled = fixture.render(world, options);
        const size_t drawn = fixture.renderer().facts().drawn;
        options.cull = false;
        const Picture whole = fixture.render(world, options);
        EXPECT_LT(drawn, fixture.renderer().facts().drawn);
        EXPECT_EQ(culled.color, whole.color) << turn;
        EXPECT_EQ(culled.depth, whole.depth) << turn;
        EXPECT_EQ(culled.normals, whole.normals) << turn;
    }
}

TEST_F(Frame, sameFrameTwiceIsBitIdentical) {
    const scene::World world = mixedWorld();
    RenderFixture first, second;
    const ao::Values hbao(*ao::findMethod("hbao"));
    Picture pictures[3];
    int at = 0;
    for (RenderFixture* fixture : {&first, &second, &second}) {
        render::FrameOptions options = fixture->options();
        options.method = &hbao;
        options.time = 0.6f;
        options.cut = true;
        pictures[at++] = fixture->render(world, options);
    }
    for (int i = 1; i < 3; ++i) {
        EXPECT_EQ(pictures[0].color, pictures[i].color);
        EXPECT_EQ(pictures[0].visibility, pictures[i].visibility);
        EXPECT_EQ(pictures[0].depth, pictures[i].depth);
        EXPECT_EQ(pictures[0].normals, pictures[i].normals);
    }
}

// Geometric normals follow the triangles, not the vertex normals, and face the camera.
TEST_F(Frame, normalsAreGeometricAndFaceTheCamera) {
    RenderFixture fixture;
    scene::World world;
    scene::Material twoSided;
    twoSided.doubleSided = true;
    world.add(instanceOf(floorPlate(), {0, -0.8f, 0}));
    auto back = with(floorPlate(), twoSided);  // seen from below
    for (glm::vec3& n : back->meshes[0].primitives[0].normals) n = glm::vec3(0.6f, 0.8f, 0.0f);
    world.add(instanceOf(back, {0, 2.5f, 0}));
    render::FrameOptions options = fixture.options();
    const Picture picture = fixture.render(world, options);
    const glm::mat3 eye(options.camera.view());
    const glm::mat4 projection = options.camera.projection({picture.size.width, picture.size.height}, {320, 240});
    const float epsilon = 2e-3f;
    size_t up = 0, down = 0, wrong = 0;
    for (uint32_t y = 0; y < picture.size.height; ++y)
        for (uint32_t x = 0; x < picture.size.width; ++x) {
            if (picture.depth.at<float>(x, y) <= 0.0f) continue;
            const glm::vec3 normal = picture.normalAt(x, y);
            const glm::vec2 ndc = (glm::vec2(x, y) + 0.5f) / glm::vec2(picture.size.width, picture.size.height) * 2.0f - 1.0f;
            const glm::vec3 ray(ndc.x / projection[0][0], ndc.y / projection[1][1], -1.0f);
            const glm::vec3 world_ = glm::transpose(eye) * normal;
            if (glm::dot(normal, ray) > 0.0f) ++wrong;
            if (glm::length(world_ - glm::vec3(0, 1, 0)) < epsilon) ++up;
            else if (glm::length(world_ - glm::vec3(0, -1, 0)) < epsilon) ++down;
            else ++wrong;
        }
    EXPECT_GT(up, 5000u);
    EXPECT_GT(down, 5000u);
    EXPECT_EQ(wrong, 0u);
}

// Mirrored instances show their front faces, like the unmirrored one.
TEST_F(Frame, mirroredInstancesKeepTheirFaces) {
    RenderFixture fixture;
    scene::World world;
    scene::Instance cube = instanceOf(turningCube());
    cube.animation = -1;
    world.add(cube);
    render::FrameOptions options = fixture.options();
    options.camera.eye = {0.0f, 0.8f, 3.0f};
    const Picture plain = fixture.render(world, options);
    world.instances()[0].placement = glm::scale(glm::mat4(1.0f), glm::vec3(-1, 1, 1));
    options.cut = true;
    const Picture mirrored = fixture.render(world, options);
    size_t different = 0;
    for (size_t i = 0; i < size_t(plain.size.width) * plain.size.height; ++i) {
        const uint32_t x = uint32_t(i % plain.size.width), y = uint32_t(i / plain.size.width);
        different += std::abs(plain.depth.at<float>(x, y) - mirrored.depth.at<float>(x, y)) > 1e-5f;
    }
    EXPECT_LT(different, 50u);
}

TEST_F(Frame, masksCutHolesAndBlendsWriteNoDepth) {
    RenderFixture fixture;
    render::FrameOptions options = fixture.options();
    const auto covered = [&](const scene::Material& material, bool skipMasked = false) {
        scene::World world;
        world.add(instanceOf(with(wavingPatch(), material)));
        options.skipMasked = skipMasked;
        options.cut = true;
        const Picture picture = fixture.render(world, options);
        size_t count = 0;
        for (uint32_t y = 0; y < picture.size.height; ++y)
            for (uint32_t x = 0; x < picture.size.width; ++x) count += picture.depth.at<float>(x, y) > 0.0f;
        return std::pair(count, picture.colorAt(160.5f, 120.5f));
    };
    scene::Material material;
    material.metallic = 0.0f;
    const auto [whole, wholeColor] = covered(material);
    EXPECT_GT(whole, 5000u);
    material.alphaMode = scene::AlphaMode::mask;
    EXPECT_EQ(covered(material).first, whole);
    EXPECT_EQ(covered(material, true).first, 0u);
    material.baseColor.a = 0.4f;
    EXPECT_EQ(covered(material).first, 0u);
    material.alphaMode = scene::AlphaMode::blend;
    const auto [blended, blendedColor] = covered(material);
    EXPECT_EQ(blended, 0u);
    material.baseColor.a = 0.0f;
    const auto [clear, clearColor] = covered(material);
    EXPECT_EQ(clear, 0u);
    EXPECT_GT(glm::length(blendedColor - clearColor), 8.0f) << "a blended surface is visible";
}

TEST_F(Frame, viewsParseAndShow) {
    RenderFixture fixture;
    const scene::World world = mixedWorld();
    for (const render::View view : render::kViews) {
        render::View parsed = render::View::pass;
        std::string pass;
        ASSERT_TRUE(render::parseView(render::name(view), parsed, pass));
        EXPECT_EQ(parsed, view);
        render::FrameOptions options = fixture.options();
        options.view = view;
        const Picture picture = fixture.render(world, options);
        EXPECT_EQ(picture.color.width, 320u);
        if (view == render::View::visibility) {
            EXPECT_EQ(picture.color.at<glm::u8vec4>(100, 100), glm::u8vec4(255)) << "nothing is obscured";
        }
    }
    for (const char* text : {"pass:gbuffer", "pass:shadow", "pass:lighting", "pass:prepare.depth", "pass:no such pass"}) {
        render::FrameOptions options = fixture.options();
        ASSERT_TRUE(render::parseView(text, options.view, options.passView));
        fixture.render(world, options);
    }
    render::View view;
    std::string pass;
    EXPECT_FALSE(render::parseView("nonsense", view, pass));
    EXPECT_FALSE(render::parseView("pass:", view, pass));
}

// Lighting reads the depth that the library prepares for the method.
TEST_F(Frame, methodThatCannotBeMadeIsLitWithoutObscurance) {
    const scene::World world = mixedWorld();
    RenderFixture whole;
    const Picture open = whole.render(world, whole.options());
    RenderFixture lacking("ao/hbao/");
    render::FrameOptions options = lacking.options();
    const ao::Values hbao(*ao::findMethod("hbao"));
    options.method = &hbao;
    const Picture picture = lacking.render(world, options);
    EXPECT_TRUE(loggedContains("ao/hbao/")) << allLogged();
    EXPECT_EQ(picture.color, open.color);
    EXPECT_EQ(picture.visibility, open.visibility);
}

// Ranges of the posed buffers freed by another scene's models are reused without trace.
TEST_F(Frame, sceneSwitchLeavesNoTrace) {
    RenderFixture switched, fresh;
    scene::World second;
    for (const float x : {-1.0f, 0.0f, 1.0f}) {
        second.add(instanceOf(wavingPatch(), {x, 0.2f, -1.0f}));
        second.add(instanceOf(bendingBar(), {x, -0.4f, 0.0f}));
    }
    render::FrameOptions options = fresh.options();
    options.time = 0.4f;
    options.cut = true;
    for (int i = 0; i < 3; ++i) {
        switched.render(mixedWorld(), options);
        switched.render(second, options);
    }
    EXPECT_EQ(switched.render(second, options).depth, fresh.render(second, options).depth);
}

// Each brick is uploaded once, even in a frame that does not read the volume.
TEST_F(Frame, voxelsAreUploadedInCulledFrames) {
    graph::Graph graph(device());
    graph::Executor executor(device());
    render::VoxelVolume voxels;
    scene::World world;
    world.add(instanceOf(floorPlate()));
    const scene::Camera camera = RenderFixture().options().camera;
    gpu::Buffer back;
    uint64_t bytes = 0;
    for (const bool isRead : {false, true}) {
        device().nextFrame();
        graph.begin();
        ao::Volume volume;
        const graph::BufferId bits = voxels.add(graph, {world, 0.0f, camera, {}, {}, true}, {.cellSize = 0.1f}, volume);
        ASSERT_TRUE(bool(bits));
        bytes = uint64_t(volume.cells) * volume.cells * volume.cells / 8;  // of level 0
        if (isRead) {
            ASSERT_EQ(gpu::Buffer::create(device(), bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback, "back", back),
                gpu::Status::ok);
            graph.pass("read back")
                .use(bits, graph::Access::transferRead)
                .use(graph.import("back", back, graph::Graph::Shared::written), graph::Access::transferWrite)
                .keep()
                .record([&, bits](const graph::PassContext& c) {
                    const VkBufferCopy region{c.buffer(bits).offset, 0, bytes};
                    c.device.vk().CmdCopyBuffer(c.cmd, c.buffer(bits).buffer, back.handle(), 1, &region);
                });
        }
        ASSERT_EQ(device().runNow([&](VkCommandBuffer cmd) { EXPECT_EQ(executor.execute(graph, cmd), gpu::Status::ok); }), gpu::Status::ok);
    }
    const auto* words = reinterpret_cast<const uint32_t*>(back.mapped());
    size_t set = 0;
    for (uint64_t i = 0; i < bytes / 4; ++i) set += size_t(std::popcount(words[i]));
    EXPECT_EQ(set, voxels.voxels()->statistics().resting.cells);
    EXPECT_GT(set, 100u);
}

TEST_F(Frame, removedModelsFreeTheirMemory) {
    RenderFixture fixture;
    scene::World world;
    world.add(instanceOf(floorPlate()));
    fixture.render(world, fixture.options());
    device().waitIdle();
    const uint64_t before = device().memoryUse();
    const uint64_t bytes = fixture.renderer().facts().geometryBytes;
    auto big = bendingBar();
    big->images[0].width = big->images[0].height = 1024;
    big->images[0].rgba.assign(4u << 20, 200);
    const uint32_t id = world.add(instanceOf(big));
    fixture.render(world, fixture.options());
    EXPECT_GT(device().memoryUse(), before + (4u << 20));
    EXPECT_GT(fixture.renderer().facts().geometryBytes, bytes);
    world.remove(id);
    fixture.render(world, fixture.options());
    device().waitIdle();
    EXPECT_EQ(fixture.renderer().facts().geometryBytes, bytes);
    EXPECT_LT(device().memoryUse(), before + (1u << 20));
}

}  // namespace
}  // namespace obscura::test
