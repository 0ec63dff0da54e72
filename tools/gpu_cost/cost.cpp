#include "gpu_cost/cost.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <regex>
#include <sstream>

#include <fmt/format.h>

#include "ao/gtao/constants.h"
#include "ao/hbao/constants.h"
#include "ao/horizon_split/constants.h"
#include "ao/hybrid/constants.h"
#include "ao/layered/constants.h"
#include "ao/visibility_bitmask/constants.h"
#include "app/complaint.h"
#include "gpu/pipeline_statistics.h"
#include "gpu_cost/fixed_constants.h"

namespace obscura::gpu_cost {
namespace {

// Shaders whose loops all have counts among the push constants, or constant ones. `outer`, `inner`: of two nested loops; `side`: an
// interleaved tile divides the outer count by its square.
constexpr size_t kNone = ~size_t(0);
struct Loops {
    const char* shader;  // up to the variant
    size_t outer = kNone, inner = kNone, side = kNone;
};
#define OBSCURA_FIELD(type, name) offsetof(shared::type, name)
const Loops kLoops[] = {
    {"ao/layered/segments.comp", OBSCURA_FIELD(LayeredSegments, slices), OBSCURA_FIELD(LayeredSegments, steps)},
    {"ao/layered/gather.comp"},
    {"ao/gtao/horizons.comp", OBSCURA_FIELD(GtaoHorizons, slices), OBSCURA_FIELD(GtaoHorizons, steps)},
    {"ao/visibility_bitmask/sectors.comp", OBSCURA_FIELD(VisibilityBitmaskSectors, slices), OBSCURA_FIELD(VisibilityBitmaskSectors, steps)},
    {"ao/hbao/horizons.comp", OBSCURA_FIELD(HbaoHorizons, directions), OBSCURA_FIELD(HbaoHorizons, steps),
        OBSCURA_FIELD(HbaoHorizons, side)},
    {"ao/hybrid/trace.comp", OBSCURA_FIELD(HybridTrace, rays), OBSCURA_FIELD(HybridTrace, steps), OBSCURA_FIELD(HybridTrace, side)},
    {"ao/horizon_split/horizons.comp", OBSCURA_FIELD(HorizonSplitMarch, directions), OBSCURA_FIELD(HorizonSplitMarch, steps),
        OBSCURA_FIELD(HorizonSplitMarch, side)},
    {"ao/horizon_split/normal_rays.comp", OBSCURA_FIELD(HorizonSplitMarch, directions), OBSCURA_FIELD(HorizonSplitMarch, steps),
        OBSCURA_FIELD(HorizonSplitMarch, side)},
    {"ao/horizon_split/normal_rays_layers.comp", OBSCURA_FIELD(HorizonSplitMarch, directions), OBSCURA_FIELD(HorizonSplitMarch, steps),
        OBSCURA_FIELD(HorizonSplitMarch, side)},
    {"ao/statistical/evaluate.comp"},
    {"ao/statistical/uniform.comp"},
    {"ao/ssao/"},
    {"ao/volumetric/"},
    {"ao/scalable/"},
    {"ao/common/denoise.comp"},
    {"ao/common/gather"},
    {"ao/common/depth_mips.comp"},
    {"ao/far_field/blur.comp"},
};
#undef OBSCURA_FIELD
const Loops* loopsOf(const std::string& shader) {
    for (const Loops& loops : kLoops)
        if (shader.starts_with(loops.shader)) return &loops;
    return nullptr;
}

uint32_t wordAt(std::span<const std::byte> bytes, size_t offset) {
    uint32_t value = 1;
    if (offset != kNone && offset + 4 <= bytes.size()) std::memcpy(&value, bytes.data() + offset, 4);
    return value;
}
std::vector<std::byte> with(std::vector<std::byte> bytes, size_t offset, uint32_t value) {
    std::memcpy(bytes.data() + offset, &value, 4);
    return bytes;
}

// Vector loads and samples in the text of an AMD shader.
double fetchesIn(const std::string& assembly) {
    static const std::regex kLoad("\\n\\s*(image_load|image_sample|image_gather4|buffer_load|global_load|flat_load)");
    return double(std::distance(std::sregex_iterator(assembly.begin(), assembly.end(), kLoad), std::sregex_iterator()));
}

// Whether a branch leads back to a block before it.
bool hasLoop(const std::string& assembly) {
    static const std::regex kLabel("^BB(\\d+):"), kBranch("s_c?branch\\w* BB(\\d+)");
    std::istringstream in(assembly);
    int block = -1;
    std::smatch match;
    for (std::string line; std::getline(in, line);) {
        if (std::regex_search(line, match, kLabel)) block = std::stoi(match[1]);
        if (std::regex_search(line, match, kBranch) && std::stoi(match[1]) <= block) return true;
    }
    return false;
}

// Whether the estimate is latency / waves: unrolled code takes more registers than the loop that runs, so that too few waves fit.
bool boundByLatency(const gpu::PipelineStatistics& statistics) {
    const double waves = statistics.of("Latency") / statistics.of("Inverse Throughput");
    return waves < statistics.of("Subgroups per SIMD") && std::abs(waves - std::round(waves)) < 1e-3;
}

gpu::PipelineStatistics compiled(
    gpu::Device& compiler, const PassLoad& pass, const std::string& reflection, std::span<const uint32_t> spirv) {
    const gpu::EmbeddedShader embedded{pass.shader.c_str(), spirv, reflection.c_str()};
    gpu::ShaderLibrary library;
    library.add({&embedded, 1});
    gpu::Program program;
    if (gpu::Program::compute(compiler, library, pass.shader, pass.specialization, program) != gpu::Status::ok)
        throw app::Complaint(fmt::format("{}: {} does not compile it", pass.shader, compiler.caps().deviceName), app::kFailed);
    return statisticsOf(compiler, program);
}

}  // namespace

CostModel::CostModel(gpu::Device& compiler, const Chip& chip, const gpu::ShaderLibrary& shaders, uint32_t mostSamples)
    : m_compiler(compiler), m_chip(chip), m_shaders(shaders), m_mostSamples(mostSamples) {}

CostModel::Compiled CostModel::compile(const PassLoad& pass, std::span<const std::byte> constants) {
    std::string key = pass.shader;
    for (const gpu::Constant& constant : pass.specialization) key += fmt::format(" {}={}", constant.id, constant.value);
    const std::string shipped = key;
    key.append(reinterpret_cast<const char*>(constants.data()), constants.size());
    if (const auto known = m_known.find(key); known != m_known.end()) return known->second;

    const gpu::Shader* shader = m_shaders.find(pass.shader);
    if (!shader) throw app::Complaint(fmt::format("{}: there is no such shader", pass.shader), app::kFailed);
    const std::string reflection = describe(*shader);
    if (!m_asShipped.contains(shipped)) m_asShipped[shipped] = compiled(m_compiler, pass, reflection, shader->spirv);
    const gpu::PipelineStatistics& asIs = m_asShipped[shipped];
    const gpu::PipelineStatistics counted =
        compiled(m_compiler, pass, reflection, withFixedConstants(shader->spirv, constants, loopsOf(pass.shader)));
    const Compiled result{counted.of("Inverse Throughput"), fetchesIn(counted.assembly), asIs.of("VGPRs"), asIs.of("Spilled VGPRs"),
        asIs.of("Subgroups per SIMD"), asIs.of("LDS size"), counted.of("Subgroup size"), hasLoop(counted.assembly),
        boundByLatency(counted)};
    if (result.cycles < 0)
        throw app::Complaint(
            fmt::format("{} says nothing of inverse throughput; Mesa 22.3 and later do", m_compiler.caps().deviceName), app::kFailed);
    return m_known[key] = result;
}

CostModel::Compiled CostModel::compile(const PassLoad& pass, bool& fitted) {
    fitted = false;
    const Loops* loops = loopsOf(pass.shader);
    if (!loops || loops->outer == kNone) return compile(pass, pass.constants);
    const uint32_t side = wordAt(pass.constants, loops->side), unit = side * side, outer = wordAt(pass.constants, loops->outer) / unit,
                   inner = wordAt(pass.constants, loops->inner);
    if (outer < 1 || inner < 1) return compile(pass, pass.constants);
    if (outer * inner <= m_mostSamples) {
        const Compiled whole = compile(pass, pass.constants);
        if (!whole.latencyBound) return whole;
    }
    // cost(o, i) = a + o (b + c i), from o, i of (n, n), (n, 2 n), (2 n, n). The fewer, the more is simplified; the more, the more
    // registers.
    const auto at = [&](uint32_t o, uint32_t i) {
        return compile(pass, with(with(pass.constants, loops->outer, o * unit), loops->inner, i));
    };
    uint32_t n = 4;
    while (n > 2 && (at(n, 2 * n).latencyBound || at(2 * n, n).latencyBound)) --n;
    const Compiled few = at(n, n), more = at(n, 2 * n), twice = at(2 * n, n);
    const auto extrapolated = [&, n = double(n)](double f, double m, double t) {
        const double inside = (m - f) / (n * n), around = (t - f) / n;  // c; b + n c
        return f + (double(outer) - n) * around + double(outer) * (double(inner) - n) * inside;
    };
    Compiled result = few;
    result.cycles = extrapolated(few.cycles, more.cycles, twice.cycles);
    result.fetches = extrapolated(few.fetches, more.fetches, twice.fetches);
    fitted = true;
    return result;
}

MethodCost CostModel::costOf(const Workload& load) {
    MethodCost result;
    const double pixels = double(load.width) * load.height;
    if (!load.passes.empty()) result.waves = std::numeric_limits<double>::infinity();
    for (const PassLoad& pass : load.passes) {
        PassCost cost;
        const Compiled code = compile(pass, cost.fitted);
        const double perPixel = double(pass.invocations) / pixels;
        cost.name = pass.name;
        cost.shader = pass.shader;
        cost.cycles = code.cycles * perPixel * 64.0 / code.waveSize;
        cost.fetches = code.fetches * perPixel;
        cost.bytes = double(pass.bytes) / pixels;
        cost.registers = code.registers;
        cost.spills = code.spills;
        cost.waves = code.waves;
        cost.sharedBytes = code.sharedBytes;
        cost.loops = code.loops;
        result.cycles += cost.cycles;
        result.fetches += cost.fetches;
        result.bytes += cost.bytes;
        result.registers = std::max(result.registers, cost.registers);
        result.waves = std::min(result.waves, cost.waves);
        result.loops = result.loops || cost.loops;
        result.passes.push_back(cost);
    }
    result.arithmeticMs = result.cycles * pixels / 64.0 / (m_chip.simds * m_chip.gigahertz * 1e9) * 1e3;
    result.memoryMs = result.bytes * pixels / (m_chip.gigabytes * 1e9) * 1e3;
    return result;
}

}  // namespace obscura::gpu_cost
