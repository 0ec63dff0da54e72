#include "render/antialias.h"

#include <cmath>

#include "post/antialias.h"

namespace obscura::render {
namespace {

double halton(uint64_t index, uint64_t base) {
    double value = 0.0, digit = 1.0;
    for (; index > 0; index /= base) value += double(index % base) * (digit /= double(base));
    return value;
}

// Pixel -> last frame's pixel of what is infinitely far away, and what the third coordinate gives for depth: see AntialiasBlock.
void setReprojection(const shared::View& view, const CameraPair& camera, shared::AntialiasBlock& block) {
    if (camera.orthographic) {
        for (int row = 0; row < 3; ++row)
            block.previousPixel[row] = {row == 0 ? 1.0f : 0.0f, row == 1 ? 1.0f : 0.0f, row == 2 ? 1.0f : 0.0f, 0.0f};
        return;
    }
    const glm::mat4 previousFromEye = camera.previousView * glm::inverse(camera.view);
    const glm::mat4& p = camera.previousProjection;
    const float x = 0.5f * float(view.size.x), y = 0.5f * float(view.size.y);
    const glm::mat3 eyeFromPixel(view.unproject.x, 0, 0, 0, view.unproject.y, 0, view.unproject.z, view.unproject.w, -1);
    const glm::mat3 pixelFromEye(x * p[0][0], 0, 0, 0, y * p[1][1], 0, x * (p[2][0] - 1.0f), y * (p[2][1] - 1.0f), -1);
    const glm::mat3 m = pixelFromEye * glm::mat3(previousFromEye) * eyeFromPixel;
    for (int row = 0; row < 3; ++row)
        block.previousPixel[row] = {m[0][row], m[1][row], m[2][row], row == 2 ? -previousFromEye[3][2] : 0.0f};
}

}  // namespace

glm::vec2 antialiasJitter(uint64_t frame) {
    const auto around0 = [](double value) { return float(value < 0.5 ? value : value - 1.0); };
    return {around0(halton(frame % 8, 2)), around0(halton(frame % 8, 3))};
}

gpu::Status Antialias::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Antialias& out) {
    return gpu::Program::compute(device, shaders, "post/antialias.comp", {}, out.m_resolve);
}

graph::ImageId Antialias::add(graph::Graph& graph, const Inputs& in) {
    const shared::View& view = in.view;
    const auto history = graph.history("antialias history", {graph.desc(in.lit).format, view.visible.x, view.visible.y}, m_history, in.cut);
    shared::AntialiasBlock block{};
    setReprojection(view, in.camera, block);
    block.visible = view.visible;
    block.guard = view.guard;
    block.exposure = in.exposure;
    graph.pass("antialias", m_resolve)
        .read(in.lit)
        .read(in.linearDepth)
        .read(in.motion)
        .read(history.previous, graph::Sampling::linear)
        .write(history.current)
        .constants(block)
        .dispatch(view.visible.x, view.visible.y);
    return history.current;
}

void Antialias::skip(graph::Graph& graph) {
    graph.onRecorded([this] { m_history.invalidate(); });
}

}  // namespace obscura::render
