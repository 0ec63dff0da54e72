// The smallest method: obscurance is the mean over samples q around the pixel of
//     3 rho(|q-p|) max(dot(n, q-p) / |q-p| - bias, 0),
// with samples on a spiral in one of 16 rotations over a 4x4 tile.
// Reads linear depth and normals, guard band included; writes visibility of the visible part. Passes: samples, blur.
#include <iterator>

#include "ao/denoise.h"
#include "ao/example/constants.h"

namespace obscura::ao::example {
namespace {

const Parameter kParameters[] = {
    {"samples", "", 1, 64, 16, true, {}, "Samples around the pixel. Cost grows with them. Too few: noise."},
    {"bias", "", 0, 1, 0.02f, false, {}, "Samples lower than this sine above the surface are ignored. Too low: flat surfaces darken."},
    {"denoise", "", 0, 1, 1, true, {}, "5x5 blur weighted by depth and normal. Off: the 4x4 noise pattern shows."},
};
const Preset kPresets[] = {{"default", "16 samples.", {}}};
const MethodInfo kInfo{"example", "Example", "", "Mean of what rises above the tangent plane.", kDepth | kNormals,
    {kParameters, std::size(kParameters)}, {kPresets, std::size(kPresets)}};

class Example final : public Method {
public:
    static std::unique_ptr<Method> create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff) {
        auto result = std::make_unique<Example>();
        if (gpu::Program::compute(device, shaders, "ao/example/samples.comp", {falloffConstant(falloff)}, result->m_samples) !=
            gpu::Status::ok)
            return nullptr;
        if (Denoise::create(device, shaders, result->m_denoise) != Status::ok) return nullptr;
        return result;
    }

    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values& values) override {
        const auto& visible = inputs.view.visible;
        const graph::ImageId visibility = graph.image("example.visibility", {VK_FORMAT_R16_SFLOAT, visible.x, visible.y});
        graph.pass("example.samples", m_samples)
            .read(inputs.viewBlock)
            .read(inputs.depth)
            .read(inputs.normals)
            .write(visibility)
            .constants(shared::ExampleSamples{inputs.falloff, values.count("samples"), values["bias"]})
            .dispatch(visible.x, visible.y);
        return values.count("denoise") ? m_denoise.add(graph, inputs, visibility, "example.blur") : visibility;
    }

private:
    gpu::Program m_samples;
    Denoise m_denoise;
};

}  // namespace

MethodEntry entry() { return {&kInfo, &Example::create}; }

}  // namespace obscura::ao::example
