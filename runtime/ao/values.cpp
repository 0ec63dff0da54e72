#include "ao/values.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "ao/method.h"

namespace obscura::ao {

Values::Values(const MethodInfo& info) : m_info(&info) {
    for (const Parameter& parameter : info.parameters) m_values.push_back(parameter.initial);
    for (size_t i = 0; i < registry().size(); ++i)
        if (registry()[i].info == &info) m_index = i;
}

bool Values::apply(const Preset& preset) {
    bool known = true;
    m_values = Values(*m_info).m_values;
    for (const Setting& setting : preset.settings) known &= set(setting.id, setting.value);
    return known;
}

void Values::resolve(const Preset& preset) {
    for (const Setting& setting : preset.settings) set(setting.id, setting.value);
}

bool Values::set(const char* id, float value) {
    for (size_t i = 0; i < m_values.size(); ++i) {
        const Parameter& parameter = m_info->parameters[i];
        if (std::strcmp(parameter.id, id) != 0) continue;
        if (std::isnan(value)) value = parameter.initial;
        value = std::clamp(value, parameter.minimum, parameter.maximum);
        m_values[i] = parameter.integer ? std::round(value) : value;
        return true;
    }
    return false;
}

bool Values::has(const char* id) const {
    return std::any_of(m_info->parameters.begin(), m_info->parameters.end(),
        [id](const Parameter& parameter) { return std::strcmp(parameter.id, id) == 0; });
}

float Values::operator[](const char* id) const {
    for (size_t i = 0; i < m_values.size(); ++i)
        if (std::strcmp(m_info->parameters[i].id, id) == 0) return m_values[i];
    assert(!"a method asked for a parameter that its table does not have");
    return 0.0f;
}

uint32_t needs(const Values& values) {
    const MethodInfo& info = values.info();
    uint32_t result = info.needs;
    if (values.has("offscreen") && values["offscreen"] > 0.0f) result |= kVolume;
    if (values.index() == Values::kUnregistered) return result;
    const MethodEntry& entry = registry()[values.index()];
    return entry.needs ? result | entry.needs(values) : result;
}

LayerMode layerModeOf(const Values& values) {
    return values.has("depth_layers") ? LayerMode(values.count("depth_layers")) : LayerMode::none;
}

}  // namespace obscura::ao
