// Fixture: renders frames with the sample's renderer and reads their images back.
#pragma once

#include "gpu/test_device.h"
#include "graph/executor.h"
#include "models.h"
#include "render/renderer.h"

namespace obscura::test {

struct Pixels {
    uint32_t width = 0, height = 0;
    std::vector<std::byte> bytes;
    template <class T> const T& at(uint32_t x, uint32_t y) const { return reinterpret_cast<const T*>(bytes.data())[size_t(y) * width + x]; }
    bool operator==(const Pixels&) const = default;
};

struct Picture {
    VkExtent2D size{}, guard{};
    Pixels color, visibility, depth, normals, motion;
    Pixels thickness, second;                          // halves, pairs of floats; empty if the method reads no depth layers
    glm::vec2 motionAt(uint32_t x, uint32_t y) const;  // px, guard band included
    glm::vec3 normalAt(uint32_t x, uint32_t y) const;  // eye space
    glm::vec3 colorAt(float x, float y) const;         // bilinear, levels, pixel centres at whole numbers + 0.5
};

class RenderFixture {
public:
    explicit RenderFixture(const std::string& without = "");  // shaders of the library that are left out: a beginning of their names
    Picture render(const scene::World& world, const render::FrameOptions& options);
    render::FrameOptions options() const;  // 320x240, no obscurance
    render::Renderer& renderer() { return *m_renderer; }

private:
    gpu::ShaderLibrary m_shaders;
    std::unique_ptr<render::Renderer> m_renderer;
    std::unique_ptr<graph::Graph> m_graph;
    std::unique_ptr<graph::Executor> m_executor;
    ao::Values m_none;
};

}  // namespace obscura::test
