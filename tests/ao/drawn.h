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
        const gpu::Buffer back = readBack(*m_graph, image);
        gpu::Status status = gpu::Status::ok;
        EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { status = m_executor->execute(*m_graph, cmd); }), gpu::Status::ok);
        EXPECT_EQ(status, gpu::Status::ok);
        truth::Plane visibility(captured.visible().x, captured.visible().y);
        visibility.values = halvesOf(back);
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
