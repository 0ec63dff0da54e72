// No obscurance: visibility 1 everywhere, against which cost and image of every method are compared.
#include "ao/method.h"

namespace obscura::ao::none {
namespace {

const Preset kPresets[] = {{"default", "Nothing is computed.", {}}};
const MethodInfo kInfo{
    "none", "No obscurance", "", "Ambient light reaches every point: the image without obscurance.", 0, {}, {kPresets, 1}};

class None final : public Method {
public:
    MethodOutput add(graph::Graph& graph, const Inputs& inputs, const Values&) override {
        return allOpen(graph, {inputs.view.visible.x, inputs.view.visible.y}, "none.clear");
    }
};

}  // namespace

MethodEntry entry() {
    const auto create = [](gpu::Device&, const gpu::ShaderLibrary&, FalloffKind) -> std::unique_ptr<Method> {
        return std::make_unique<None>();
    };
    return {.info = &kInfo, .create = create, .perFalloff = false};
}

}  // namespace obscura::ao::none
