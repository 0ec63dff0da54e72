// A compute shader as it runs with one set of counts: the integers among its push constants become constants of the code, and its loops may
// be marked to be unrolled. A compiler then counts the work of exactly that setting, where it would guess how often a loop with an unknown
// count runs. Floats stay push constants: what depends on them, such as the kind of falloff, costs what it costs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura::gpu_cost {

// spirv: a valid module with one entry point and at most one push-constant block; `constants`: the block's contents. For compilers only:
// layout decorations are left on a private variable, which validators may report. unroll: only where all counts are then known; compilers
// fail on other loops.
std::vector<uint32_t> withFixedConstants(std::span<const uint32_t> spirv, std::span<const std::byte> constants, bool unroll);

}  // namespace obscura::gpu_cost
