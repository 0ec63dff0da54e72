// Chips whose compiler is at hand: Mesa's RADV compiles for AMD chips that are not in the machine, and says what the code costs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu/device.h"

namespace obscura::gpu_cost {

struct Chip {
    const char* id;       // as RADV_FORCE_FAMILY spells it
    const char* product;  // whose data sheet the figures are of
    double simds;         // each runs one wave's instruction a cycle
    double gigahertz;     // boost clock
    double gigabytes;     // a second, of device memory
};
const std::vector<Chip>& chips();
const Chip* findChip(const std::string& id);

// A device that compiles for that chip and runs nothing: no image may be made on it. Null, with the reason and what to do in `error`,
// where RADV is not installed or its build offers no statistics. Sets environment variables of this process that choose Vulkan's driver.
std::unique_ptr<gpu::Device> compilerOf(const Chip& chip, std::string& error);

std::string driverOf(const gpu::Device& device);  // "Mesa 22.3.6"

}  // namespace obscura::gpu_cost
