// Fixture: accuracy of scenes drawn by our renderer with depth layers, which stored frames lack. Links obscura_render.
#pragma once

#include "ao/oracle.h"
#include "render/renderer.h"
#include "scene/gltf/gltf.h"
#include "scene/pose.h"

namespace obscura::test {

class DrawnOracleTest : public OracleTest {
protected:
    using OracleTest::OracleTest;

    // eA of the scene NAME.glb seen by its camera, against a channel of NAME.reference.exr.
    float drawn(const std::string& name, const ao::Values& values, const char* falloff, const std::string& channel) {
        const fs::path folder = this->folder();
        if (!fs::exists(folder / (name + ".glb")))
            skip("no " + (folder / name).string() + ".glb; set OBSCURA_ORACLE to the stored references");
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
        EXPECT_TRUE(ao::parseFalloff(falloff, options.falloff));
        m_device.nextFrame();
        m_graph->begin();
        const graph::ImageId image = m_renderer->add(*m_graph, world, options).visibility;
        gpu::Buffer back;
        EXPECT_EQ(gpu::Buffer::create(m_device, uint64_t(options.visible.width) * options.visible.height * 2,
                      VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback, "back", back),
            gpu::Status::ok);
        const graph::BufferId to = m_graph->import("back", back, graph::Graph::Shared::written);
        m_graph->pass("read back")
            .use(image, graph::Access::transferRead)
            .use(to, graph::Access::transferWrite)
            .keep()
            .record([image, size = options.visible, handle = back.handle()](const graph::PassContext& c) {
                const VkBufferImageCopy region{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {size.width, size.height, 1}};
                c.device.vk().CmdCopyImageToBuffer(c.cmd, c.image(image), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, handle, 1, &region);
            });
        gpu::Status status = gpu::Status::ok;
        EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { status = m_executor->execute(*m_graph, cmd); }), gpu::Status::ok);
        EXPECT_EQ(status, gpu::Status::ok);
        truth::Plane visibility(captured.visible().x, captured.visible().y);
        for (size_t i = 0; i < visibility.values.size(); ++i)
            visibility.values[i] = halfToFloat(reinterpret_cast<const uint16_t*>(back.mapped())[i]);
        truth::Plane reference = truth::readExr(folder / (name + ".reference.exr")).plane(channel);
        for (float& v : reference.values) v = 1.0f - v;
        const truth::Metrics metrics = truth::compare(visibility, reference, truth::Mask(captured.visibleMask()));
        printf("%-9s drawn, %s: eA %.4f, bias %+.4f, within 0.05 %.3f\n", name.c_str(), channel.c_str(), double(metrics.raw.eA),
            double(metrics.raw.bias), double(metrics.raw.e5));
        return metrics.raw.eA;
    }

private:
    std::unique_ptr<render::Renderer> m_renderer;
};

}  // namespace obscura::test
