// What a pass and a method cost on a chip, counted by the chip's compiler.
//     cycles = sum over compute passes of (inverse throughput of a wave) x (invocations a pixel) x 64 / (invocations a wave)
// that is: cycles of a SIMD for every 64 pixels of the image. Inverse throughput is the compiler's estimate of how long a wave occupies its
// SIMD. Counts are those of the preset: integer push constants are fixed and loops unrolled (fixed_constants.h); where that would be too
// much code or take too many registers, three smaller counts are compiled and the cost extrapolated. Two floors of the time, by the chip's
// data sheet: arithmetic, cycles x pixels / 64 / (SIMDs x clock); memory, bytes / bandwidth. A frame takes at least the larger.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "gpu/pipeline_statistics.h"
#include "gpu_cost/chip.h"
#include "gpu_cost/workload.h"

namespace obscura::gpu_cost {

struct PassCost {
    std::string name, shader;
    double cycles = 0;       // of a SIMD, for 64 pixels of the image
    double fetches = 0;      // loads and samples a pixel of the image
    double bytes = 0;        // read and written, a pixel of the image
    double registers = 0;    // VGPRs of a lane
    double spills = 0;       // VGPRs spilled to memory
    double waves = 0;        // that a SIMD holds
    double sharedBytes = 0;  // of a workgroup
    bool loops = false;      // a loop whose count depends on data is left; its count is the compiler's guess
    bool fitted = false;     // extrapolated from smaller counts
};

struct MethodCost {
    std::vector<PassCost> passes;
    double cycles = 0, fetches = 0, bytes = 0;  // sums
    double registers = 0, waves = 0;            // the worst pass's
    bool loops = false;                         // any pass's
    double arithmeticMs = 0, memoryMs = 0;      // floors at the workload's size
};

// Compiles each shader as shipped, and with each set of fixed counts, once.
class CostModel {
public:
    // mostSamples: iterations that are unrolled; costs of more are extrapolated.
    CostModel(gpu::Device& compiler, const Chip& chip, const gpu::ShaderLibrary& shaders, uint32_t mostSamples = 32);
    MethodCost costOf(const Workload& load);

private:
    struct Compiled {
        double cycles, fetches, registers, spills, waves, sharedBytes, waveSize;
        bool loops, latencyBound;
    };
    Compiled compile(const PassLoad& pass, std::span<const std::byte> constants);
    Compiled compile(const PassLoad& pass, bool& fitted);

    gpu::Device& m_compiler;
    const Chip& m_chip;
    const gpu::ShaderLibrary& m_shaders;
    const uint32_t m_mostSamples;
    std::map<std::string, gpu::PipelineStatistics> m_asShipped;  // by shader and specialization
    std::map<std::string, Compiled> m_known;                     // and by push constants
};

}  // namespace obscura::gpu_cost
