#include "ao/edge_blur.h"

#include "ao/common/constants.h"

namespace obscura::ao {
namespace {
constexpr float kCentre = 1.2f, kOff = 1e4f;  // weight of the pixel itself: as published; so large that neighbours do not count
}

Status EdgeBlur::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, EdgeBlur& out) {
    for (uint32_t last = 0; last < 2; ++last)
        if (gpu::Program::compute(device, shaders, "ao/common/edge_blur.comp", {{0, last}}, out.m_blur[last]) != gpu::Status::ok)
            return Status::shaderError;
    return Status::ok;
}

graph::ImageId EdgeBlur::add(graph::Graph& graph, graph::ImageId noisy, bool on, const char* passName) {
    const uint32_t width = graph.desc(noisy).width, height = graph.desc(noisy).height;
    const graph::ImageId visibility = graph.image(passName, {VK_FORMAT_R16_SFLOAT, width, height});
    for (uint32_t last = on ? 0 : 1; last < 2; ++last) {
        const graph::ImageId intermediate = graph.image("blurred once", {VK_FORMAT_R32_UINT, last ? 1 : width, last ? 1 : height});
        graph.pass(passName, m_blur[last])
            .read(noisy)
            .write(intermediate)
            .write(visibility)
            .constants(shared::EdgeBlur{shared::sizeOf(width, height), on ? kCentre : kOff, 0})
            .dispatch(width, height);
        noisy = intermediate;
    }
    return visibility;
}

}  // namespace obscura::ao
