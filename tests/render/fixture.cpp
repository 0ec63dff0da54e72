// Fixture: renders frames and reads their images back.
#include "fixture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <glm/gtc/packing.hpp>

#include "graph/executor.h"
#include "graph/read_back.h"
#include "obscura/ao.h"

namespace obscura::test {
namespace {

// An image of the graph, copied when the graph executes.
struct Readback {
    gpu::Buffer buffer;
    Pixels* target = nullptr;
};

void copyOut(graph::Graph& graph, graph::ImageId image, Readback& back, Pixels& target) {
    const gpu::ImageDesc desc = graph.desc(image);
    target.width = desc.width;
    target.height = desc.height;
    target.bytes.resize(size_t(desc.width) * desc.height * gpu::bytesPerTexel(desc.format));
    back.target = &target;
    back.buffer = readBack(graph, image);
    if (!back.buffer) throw std::runtime_error("no readback buffer");
}

}  // namespace

glm::vec2 Picture::motionAt(uint32_t x, uint32_t y) const { return glm::unpackHalf2x16(motion.at<uint32_t>(x, y)); }

glm::vec3 Picture::normalAt(uint32_t x, uint32_t y) const {
    const glm::vec2 e = glm::unpackSnorm2x16(normals.at<uint32_t>(x, y));
    glm::vec3 n(e, 1.0f - std::abs(e.x) - std::abs(e.y));
    const float t = std::max(-n.z, 0.0f);
    n.x -= n.x >= 0 ? t : -t;
    n.y -= n.y >= 0 ? t : -t;
    return glm::normalize(n);
}

glm::vec3 Picture::colorAt(float x, float y) const {
    const float px = glm::clamp(x - 0.5f, 0.0f, float(color.width - 1) - 0.001f),
                py = glm::clamp(y - 0.5f, 0.0f, float(color.height - 1) - 0.001f);
    const uint32_t ix = uint32_t(px), iy = uint32_t(py);
    const auto texel = [&](uint32_t i, uint32_t j) { return glm::vec3(color.at<glm::u8vec4>(i, j)); };
    const glm::vec3 top = glm::mix(texel(ix, iy), texel(ix + 1, iy), px - float(ix));
    const glm::vec3 bottom = glm::mix(texel(ix, iy + 1), texel(ix + 1, iy + 1), px - float(ix));
    return glm::mix(top, bottom, py - float(iy));
}

RenderFixture::RenderFixture(const std::string& without) : m_none(*ao::findMethod("none")) {
    m_shaders.add(render::shaders());
    for (const gpu::EmbeddedShader& shader : ao::shaders())
        if (without.empty() || !std::string_view(shader.name).starts_with(without)) m_shaders.add({&shader, 1});
    m_renderer = render::Renderer::create(device(), m_shaders);
    if (!m_renderer) throw std::runtime_error("no renderer");
    m_graph = std::make_unique<graph::Graph>(device());
    m_executor = std::make_unique<graph::Executor>(device());
}

render::FrameOptions RenderFixture::options() const {
    render::FrameOptions options;
    options.visible = {320, 240};
    options.guard = 0.1f;
    options.method = &m_none;
    options.camera.eye = {0.6f, 0.9f, 3.6f};
    options.camera.target = {0.0f, 0.1f, 0.0f};
    return options;
}

Picture RenderFixture::render(const scene::World& world, const render::FrameOptions& options) {
    Picture picture;
    Readback backs[7];
    device().nextFrame();
    m_graph->begin(&m_executor->timings());
    const render::Outputs out = m_renderer->add(*m_graph, world, options);
    copyOut(*m_graph, out.color, backs[0], picture.color);
    copyOut(*m_graph, out.visibility, backs[1], picture.visibility);
    copyOut(*m_graph, out.depth, backs[2], picture.depth);
    copyOut(*m_graph, out.normals, backs[3], picture.normals);
    copyOut(*m_graph, out.motion, backs[4], picture.motion);
    if (out.layers.thickness) copyOut(*m_graph, out.layers.thickness, backs[5], picture.thickness);
    if (out.layers.second) copyOut(*m_graph, out.layers.second, backs[6], picture.second);
    gpu::Status executed = gpu::Status::ok;
    const gpu::Status ran = device().runNow([&](VkCommandBuffer cmd) { executed = m_executor->execute(*m_graph, cmd); });
    if (executed != gpu::Status::ok || ran != gpu::Status::ok) throw std::runtime_error("the frame did not run\n" + allLogged());
    for (const Readback& back : backs)
        if (back.target) std::memcpy(back.target->bytes.data(), back.buffer.mapped(), back.target->bytes.size());
    picture.size = {picture.depth.width, picture.depth.height};
    picture.guard = {(picture.depth.width - picture.color.width) / 2, (picture.depth.height - picture.color.height) / 2};
    return picture;
}

}  // namespace obscura::test
