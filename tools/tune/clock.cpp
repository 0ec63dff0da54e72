#include "clock.h"

#include <fmt/format.h>

#include "ao/method.h"
#include "app/complaint.h"
#include "gpu_cost/workload.h"

namespace obscura::tune {

CycleClock::CycleClock(measure::Machine& machine) : m_machine(machine), m_chip(*gpu_cost::findChip("navi21")) {
    std::string error;
    m_compiler = gpu_cost::compilerOf(m_chip, error);
    if (!m_compiler) throw app::Complaint(fmt::format("--clock cycles: {}", error), app::kFailed);
    m_shaders.add(ao::shaders());
    m_model = std::make_unique<gpu_cost::CostModel>(*m_compiler, m_chip, m_shaders);
}

const gpu_cost::MethodCost& CycleClock::costOf(const measure::Candidate& candidate, const measure::FalloffChoice& falloff) {
    const auto [at, isNew] = m_known.try_emplace(candidate.label() + " " + falloff.text);
    if (isNew)
        at->second = m_model->costOf(gpu_cost::workloadOf(m_machine.device(), m_shaders, candidate.values, falloff.falloff, 1920, 1080));
    return at->second;
}

}  // namespace obscura::tune
