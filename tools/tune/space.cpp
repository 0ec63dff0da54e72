#include "space.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "app/complaint.h"

namespace obscura::tune {

namespace {

bool shared(std::string_view id) { return id.starts_with("temporal") || id.starts_with("offscreen"); }

// The names that apply to this method, without "METHOD.".
std::vector<std::string> namesOf(const ao::MethodInfo& info, const std::vector<std::string>& names) {
    std::vector<std::string> mine;
    for (const std::string& name : names) {
        const size_t dot = name.find('.');
        if (dot == std::string::npos) mine.push_back(name);
        else if (name.substr(0, dot) == info.id) mine.push_back(name.substr(dot + 1));
    }
    return mine;
}

}  // namespace

Space::Space(const measure::Candidate& start, const std::vector<std::string>& names) : m_start(start) {
    constexpr double kFactor = 4.0;
    const ao::MethodInfo& info = start.info();
    const std::vector<std::string> wanted = namesOf(info, names);
    std::vector<std::string> known;
    for (const ao::Parameter& parameter : info.parameters) known.emplace_back(parameter.id);
    for (const std::string& name : wanted)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw app::Complaint(fmt::format("--parameters {}: {} has no such parameter; {}", name, info.id, app::choices(name, known)));
    for (const ao::Parameter& parameter : info.parameters) {
        const bool named = std::find(wanted.begin(), wanted.end(), parameter.id) != wanted.end();
        if (wanted.empty() ? parameter.choices.size() > 0 || shared(parameter.id) : !named) continue;
        const double value = start.values[parameter.id];
        Axis axis{&parameter, parameter.minimum, parameter.maximum, value,
            value > 0.0 && parameter.minimum >= 0.0f && parameter.choices.size() == 0};
        if (axis.ratios) axis.low = std::max(axis.low, value / kFactor), axis.high = std::min(axis.high, value * kFactor);
        if (axis.high > axis.low) m_axes.push_back(axis);
    }
    if (m_axes.empty()) throw app::Complaint(fmt::format("--method {}: has no parameter to search", info.id));
}

double Space::Axis::value(double u) const {
    const double v = ratios ? low * std::pow(high / low, u) : low + (high - low) * u;
    // Three significant digits, as in the presets' tables.
    const double digits = v == 0.0 ? 1.0 : std::pow(10.0, 2.0 - std::floor(std::log10(std::fabs(v))));
    return std::clamp(parameter->integer ? std::round(v) : std::round(v * digits) / digits, low, high);
}

std::vector<double> Space::start() const {
    std::vector<double> point;
    for (const Axis& axis : m_axes)
        point.push_back(std::clamp(axis.ratios ? std::log(axis.start / axis.low) / std::log(axis.high / axis.low)
                                               : (axis.start - axis.low) / (axis.high - axis.low),
            0.0, 1.0));
    return point;
}

measure::Candidate Space::at(std::span<const double> point) const {
    measure::Candidate candidate = m_start;
    for (size_t i = 0; i < m_axes.size(); ++i) {
        const Axis& axis = m_axes[i];
        const double value = axis.value(std::clamp(point[i], 0.0, 1.0));
        if (std::fabs(value - axis.start) <= 1e-3 * std::fabs(axis.start)) continue;
        candidate.values.set(axis.parameter->id, float(value));
        candidate.settings.push_back(fmt::format("{}={:g}", axis.parameter->id, value));
    }
    return candidate;
}

}  // namespace obscura::tune
