// Controls of the result that artists expect of every method: intensity, power, floor and fading by distance.
#pragma once

#include "ao/method.h"

namespace obscura::ao {

// v' = max((1 - intensity (1 - v))^power, floor), then open beyond a distance.
struct ControlSettings {
    float intensity = 1.0f;                // factor on obscurance
    float power = 1.0f;                    // exponent on visibility
    float floor = 0.0f;                    // lowest visibility
    float fadeFrom = 0.0f, fadeTo = 0.0f;  // linear depth, metres: as computed up to the first, open from the second on; 0: everywhere
    bool neutral() const { return intensity == 1.0f && power == 1.0f && floor == 0.0f && fadeTo <= 0.0f; }
};

class Controls {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Controls& out);
    // visibility: R16F, visible size. Returns it where the settings are neutral, else a new image of its kind.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const ControlSettings& settings);

private:
    gpu::Program m_program;
};

}  // namespace obscura::ao
