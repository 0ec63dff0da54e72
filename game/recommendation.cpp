#include "recommendation.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/content.h"
#include "choice.h"
#include "scene/json_file.h"

namespace obscura::game {

namespace {

// By rising cost and falling error, in cycles and against rays through the scene; `gtao half` reads no depth layers, whose geometry may
// cost more than the method.
constexpr std::pair<const char*, const char*> kCandidates[] = {
    {"gtao", "half"}, {"layered", "low"}, {"layered", "medium"}, {"layered", "high"}, {"layered", "ultra"}};

std::string nameOf(size_t candidate) { return fmt::format("{} {}", kCandidates[candidate].first, kCandidates[candidate].second); }

}  // namespace

std::vector<ao::Values> candidates() {
    std::vector<ao::Values> list;
    for (const auto& [method, preset] : kCandidates) {
        Choice choice;
        choice.select(std::string(method));
        choice.applyPreset(preset);
        choice.applyResolve("temporal");
        list.push_back(choice.values());
    }
    return list;
}

Recommendation recommend(std::vector<double> costs, double budget) {
    Recommendation made{0, std::move(costs), budget};
    for (size_t i = 0; i < made.costs.size(); ++i)
        if (made.costs[i] <= budget) made.candidate = i;
    return made;
}

std::string Recommendation::reason() const {
    if (costs.empty()) return fmt::format("{}: this device measures no GPU times", nameOf(candidate));
    std::string text = fmt::format("{} takes {:.3g} of {:g} ms", nameOf(candidate), costs[candidate], budget);
    if (costs[candidate] > budget) text += "; nothing takes less";
    else if (candidate + 1 < costs.size()) text += fmt::format("; {} would take {:.3g}", nameOf(candidate + 1), costs[candidate + 1]);
    return text;
}

KnownFigures::KnownFigures() {
    const auto file = app::findContent("methods.json");
    if (!file) return;
    const scene::JsonFile json(*file);
    const scene::JsonAt list = json.root().at("methods").expectArray();
    for (size_t i = 0; i < list.size(); ++i) {
        const scene::JsonAt at = list.at(i);
        Entry entry{at.at("method").text(), at.at("preset").text(), {.eA = at.at("eA").number(0.0, 1.0)}};
        if (const auto flicker = at.find("flicker")) entry.figures.flicker = flicker->number(0.0, 1.0);
        if (const auto cycles = at.find("cycles")) entry.figures.cycles = cycles->number(0.0);
        m_entries.push_back(std::move(entry));
    }
}

std::optional<Figures> KnownFigures::of(const std::string& method, const std::string& preset) const {
    const auto found =
        std::find_if(m_entries.begin(), m_entries.end(), [&](const Entry& e) { return e.method == method && e.preset == preset; });
    return found == m_entries.end() ? std::nullopt : std::optional(found->figures);
}

}  // namespace obscura::game
