// What a driver's compiler says of a compiled pipeline (VK_KHR_pipeline_executable_properties). Needs DeviceOptions::statistics and
// Caps::statistics; also on a device whose hardware is missing, as Mesa's RADV has it with RADV_FORCE_FAMILY.
#pragma once

#include <map>
#include <string>

#include "gpu/program.h"

namespace obscura::gpu {

struct PipelineStatistics {
    std::map<std::string, double> values;  // by the driver's own names, such as "VGPRs", and "Subgroup size"
    std::string assembly;                  // the driver's text; empty where it offers none
    double of(const char* name) const;     // -1 where the driver has no such value
};

// Of one stage of a program's pipeline. Empty where the device has none.
PipelineStatistics statisticsOf(const Device& device, const Program& program, VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT);

}  // namespace obscura::gpu
