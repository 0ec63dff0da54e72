// A compute shader as it runs with one set of push constants: they become constants of the code, and every loop is marked to be unrolled.
// A compiler then counts the work of exactly that setting, where it would guess how often a loop with an unknown count runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura::gpu_cost {

// spirv: a valid module with at most one push-constant block; `constants`: its contents. Returns a module without push constants, or the
// same module if it has none. For compilers only: layout decorations stay on a variable that needs none, which validators report.
std::vector<uint32_t> withFixedConstants(std::span<const uint32_t> spirv, std::span<const std::byte> constants);

}  // namespace obscura::gpu_cost
