// The methods there are, in the order keys and menus show them. A new one is one line in each of the two lists.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <iterator>

#include "ao/method.h"

namespace obscura::ao {

MethodEntry noneEntry();
MethodEntry hbaoEntry();
MethodEntry horizonSplitEntry();

std::span<const MethodEntry> registry() {
    static const MethodEntry kEntries[] = {noneEntry(), hbaoEntry(), horizonSplitEntry()};
    return kEntries;
}

List<const MethodInfo*> methods() {
    static const std::vector<const MethodInfo*> kInfos = [] {
        std::vector<const MethodInfo*> result;
        for (const MethodEntry& entry : registry()) result.push_back(entry.info);
        return result;
    }();
    return {kInfos.data(), kInfos.size()};
}

const MethodInfo* findMethod(const char* id) {
    for (const MethodInfo* info : methods())
        if (id && std::strcmp(info->id, id) == 0) return info;
    return nullptr;
}

// ---- Values ---------------------------------------------------------------------------------------------------------

Values::Values(const MethodInfo& info) : m_info(&info) {
    for (const Parameter& parameter : info.parameters) m_values.push_back(parameter.initial);
}

bool Values::apply(const Preset& preset) {
    bool known = true;
    *this = Values(*m_info);
    for (const Setting& setting : preset.settings) known &= set(setting.id, setting.value);
    return known;
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

float Values::operator[](const char* id) const {
    for (size_t i = 0; i < m_values.size(); ++i)
        if (std::strcmp(m_info->parameters[i].id, id) == 0) return m_values[i];
    assert(!"a method asked for a parameter that its table does not have");
    return 0.0f;
}

}  // namespace obscura::ao
