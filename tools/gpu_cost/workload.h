// The passes of a method as one frame runs them, recorded without running: shaders, push constants, sizes.
#pragma once

#include <string>
#include <vector>

#include "ao/method.h"

namespace obscura::gpu_cost {

struct PassLoad {
    std::string name;    // of the pass
    std::string shader;  // of the library
    std::vector<gpu::Constant> specialization;
    std::vector<std::byte> constants;
    uint64_t invocations = 0;
    uint64_t bytes = 0;  // its bindings, each read or written once
};

struct Workload {
    uint32_t width = 0, height = 0;  // px of the image, without guard band
    std::vector<PassLoad> passes;
};

// A frame of that size with depth, normals, motion and what else the values ask for, in the forms that cost least. The device makes the
// method's pipelines and none of its images. Throws app::Complaint where a pipeline cannot be made.
Workload workloadOf(gpu::Device& device, const gpu::ShaderLibrary& shaders, const ao::Values& values, const ao::Falloff& falloff,
    uint32_t width, uint32_t height);

}  // namespace obscura::gpu_cost
