// Accuracy against stored references: of captured frames, which have no layers, and of the same scenes drawn by our renderer,
// which has.
#include "ao/oracle.h"
#include "render/renderer.h"
#include "scene/gltf.h"
#include "scene/pose.h"

namespace obscura::test {
namespace {

constexpr const char* kFalloff = "quadratic:1";
constexpr const char* kWorld = "world.quadratic_1";

class Oracle : public OracleTest {
protected:
    Oracle() : OracleTest("layered") {}

    // eA of the scene NAME.glb at its camera.
    float drawn(const std::string& name, const ao::Values& values) {
        const fs::path folder = this->folder();
        if (!fs::exists(folder / (name + ".glb"))) skip("no " + (folder / name).string() + ".glb; set OBSCURA_ORACLE to the stored references");
        const truth::CapturedFrame captured = truth::readCapture(folder / name);
        m_shaders.add(render::shaders());
        if (!m_renderer) m_renderer = render::Renderer::create(m_device, m_shaders);
        scene::World world;
        world.add({.model = scene::loadGltf(folder / (name + ".glb"))});
        const scene::Instance& first = world.instances().front();
        render::FrameOptions options;
        options.visible = {captured.visible().x, captured.visible().y};
        options.camera = scene::lensCamera(first, scene::evaluate(*first.model, first.animation, 0.0f), 0);
        options.method = &values;
        options.view = render::View::visibility;
        EXPECT_TRUE(ao::parseFalloff(kFalloff, options.falloff));
        m_device.nextFrame();
        m_graph->begin();
        const graph::ImageId image = m_renderer->add(*m_graph, world, options).visibility;
        gpu::Buffer back;
        EXPECT_EQ(gpu::Buffer::create(m_device, uint64_t(options.visible.width) * options.visible.height * 2, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                      gpu::Memory::readback, "back", back), gpu::Status::ok);
        const graph::BufferId to = m_graph->import("back", back, graph::Graph::Shared::written);
        m_graph->pass("read back").use(image, graph::Access::transferRead).use(to, graph::Access::transferWrite).keep()
            .record([image, size = options.visible, handle = back.handle()](const graph::PassContext& c) {
                const VkBufferImageCopy region{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {size.width, size.height, 1}};
                c.device.vk().CmdCopyImageToBuffer(c.cmd, c.image(image), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, handle, 1, &region);
            });
        gpu::Status status = gpu::Status::ok;
        EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { status = m_graph->execute(cmd); }), gpu::Status::ok);
        EXPECT_EQ(status, gpu::Status::ok);
        truth::Plane visibility(captured.visible().x, captured.visible().y);
        for (size_t i = 0; i < visibility.values.size(); ++i) visibility.values[i] = halfToFloat(reinterpret_cast<const uint16_t*>(back.mapped())[i]);
        truth::Plane reference = truth::readExr(folder / (name + ".reference.exr")).plane(kWorld);
        for (float& v : reference.values) v = 1.0f - v;
        const truth::Metrics metrics = truth::compare(visibility, reference, truth::Mask(captured.visibleMask()));
        printf("%-9s drawn: eA %.4f, bias %+.4f, within 0.05 %.3f\n", name.c_str(), double(metrics.raw.eA), double(metrics.raw.bias), double(metrics.raw.e5));
        return metrics.raw.eA;
    }

    std::unique_ptr<render::Renderer> m_renderer;
};

TEST_F(Oracle, cornerWithoutLayers) {
    EXPECT_LE(measure("corner", values({{"thickness", 1000}}), kFalloff, kWorld).raw.eA, 0.0040f);
    EXPECT_LE(measure("corner", values({{"thickness", 1000}}, "quality"), kFalloff, kWorld).raw.eA, 0.0030f);
    EXPECT_LE(measure("corner", values({{"thickness", 1000}}, "reference"), kFalloff, kWorld).raw.eA, 0.0015f);
}

// Strata of metres: what counts for a stretch of surface is not the mean of its ends.
TEST_F(Oracle, cornerFarReaching) {
    EXPECT_LE(measure("corner", values({{"thickness", 1000}}), "exponential:1", "world.exponential_1").raw.eA, 0.0056f);
}

TEST_F(Oracle, cornerDrawn) {
    EXPECT_LE(drawn("corner", values({})), 0.0040f);
    EXPECT_LE(drawn("corner", values({}, "quality")), 0.0030f);
    EXPECT_LE(drawn("corner", values({}, "reference")), 0.0015f);
}

TEST_F(Oracle, atriumDrawn) {
    EXPECT_LE(drawn("atrium", values({})), 0.0145f);
    EXPECT_LE(drawn("atrium", values({}, "quality")), 0.0115f);
    EXPECT_LE(drawn("atrium", values({}, "reference")), 0.0070f);
}

}  // namespace
}  // namespace obscura::test
