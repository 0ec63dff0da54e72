// The clock of `--clock cycles`: what a GPU would charge, counted by its compiler.
#pragma once

#include <map>

#include "gpu_cost/cost.h"
#include "measure/candidate.h"
#include "measure/machine.h"

namespace obscura::tune {

class CycleClock {
public:
    explicit CycleClock(measure::Machine& machine);  // throws app::Complaint, with what is missing
    // On navi21 at 1920 x 1080; the same for the same arguments.
    const gpu_cost::MethodCost& costOf(const measure::Candidate& candidate, const measure::FalloffChoice& falloff);

private:
    measure::Machine& m_machine;
    const gpu_cost::Chip& m_chip;
    std::unique_ptr<gpu::Device> m_compiler;
    gpu::ShaderLibrary m_shaders;
    std::unique_ptr<gpu_cost::CostModel> m_model;
    std::map<std::string, gpu_cost::MethodCost> m_known;
};

}  // namespace obscura::tune
