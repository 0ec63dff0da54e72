#include "choice.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "app/complaint.h"

namespace obscura::game {

using app::Complaint;

namespace {

constexpr std::string_view kFirstMethod = "layered";
constexpr const char* kOwn = "preset";  // of --resolve: what the method's preset says

}  // namespace

std::vector<std::string> methodIds() {
    std::vector<std::string> ids;
    for (const ao::MethodInfo* info : ao::methods()) ids.emplace_back(info->id);
    return ids;
}

Presets presetsOf(const ao::Values& values) {
    for (const ao::Preset& preset : values.info().presets) {
        ao::Values same(values.info());
        same.apply(preset);
        if (same == values) return {&preset, nullptr};
        for (const ao::Preset& resolve : ao::resolvePresets()) {
            ao::Values resolved = same;
            resolved.resolve(resolve);
            if (resolved == values) return {&preset, &resolve};
        }
    }
    return {};
}

void usePreset(ao::Values& values, const ao::Preset& preset) {
    const ao::Preset* resolved = presetsOf(values).resolve;
    values.apply(preset);
    if (resolved) values.resolve(*resolved);
}

void resolve(ao::Values& values, const ao::Preset& wanted) {
    // Sets the parameters of all resolve presets back to those of the method's preset: of the preset that equals `values` in all other
    // parameters, or of the first one.
    const auto reset = [&](ao::Values to, const ao::Preset& preset) {
        ao::Values own(values.info());
        own.apply(preset);
        for (const ao::Preset& resolve : ao::resolvePresets())
            for (const ao::Setting& setting : resolve.settings)
                if (own.has(setting.id)) to.set(setting.id, own[setting.id]);
        return std::pair(to, to == own);
    };
    if (values.info().presets.size() > 0) {
        ao::Values next = reset(values, values.info().presets[0]).first;
        for (const ao::Preset& preset : values.info().presets)
            if (const auto [own, same] = reset(values, preset); same) {
                next = own;
                break;
            }
        values = next;
    }
    values.resolve(wanted);
}

const ao::Preset* resolveOf(const ao::Values& values) {
    for (const ao::Preset& preset : ao::resolvePresets()) {
        ao::Values same = values;
        resolve(same, preset);
        if (same == values) return &preset;
    }
    return nullptr;
}

namespace {

// "steps=4", ...: what differs from the first preset.
std::vector<std::string> differences(const ao::Values& values) {
    ao::Values first(values.info());
    if (values.info().presets.size() > 0) first.apply(values.info().presets[0]);
    std::vector<std::string> list;
    for (const ao::Parameter& parameter : values.info().parameters)
        if (values[parameter.id] != first[parameter.id]) list.push_back(fmt::format("{}={:g}", parameter.id, values[parameter.id]));
    return list;
}

}  // namespace

std::string label(const ao::Values& values) {
    constexpr size_t kShown = 3;
    if (const auto [preset, resolved] = presetsOf(values); preset)
        return fmt::format("{}{}{}", values.info().id, preset == &values.info().presets[0] ? "" : fmt::format(" {}", preset->id),
            resolved ? fmt::format(", {}", resolved->id) : "");
    std::vector<std::string> list = differences(values);
    if (list.size() > kShown) list.resize(kShown), list.push_back("...");
    return fmt::format("{} {}", values.info().id, fmt::join(list, " "));
}

std::vector<Argument> methodOptions(const ao::Values& values) {
    std::vector<Argument> list{{"--method", values.info().id}};
    if (const auto [preset, resolved] = presetsOf(values); preset) {
        if (preset != &values.info().presets[0]) list.push_back({"--preset", preset->id});
        list.push_back({"--resolve", resolved ? resolved->id : kOwn});
        return list;
    }
    list.push_back({"--resolve", kOwn});
    for (std::string& difference : differences(values)) list.push_back({"--set", std::move(difference)});
    return list;
}

std::string compareText(const ao::Values& values) {
    std::string text = values.info().id;
    if (const auto [preset, resolved] = presetsOf(values); preset && !resolved)
        return preset == &values.info().presets[0] ? text : fmt::format("{}:{}", text, preset->id);
    for (const std::string& difference : differences(values)) text += "," + difference;
    return text;
}

Choice::Choice() {
    for (const ao::MethodInfo* info : ao::methods()) {
        ao::Values values(*info);
        if (info->presets.size() > 0) values.apply(info->presets[0]);
        m_values.push_back(std::move(values));
    }
    if (m_values.empty()) throw Complaint("this build contains no obscurance method", app::kFailed);
    // The first entry is the method `none`; the game starts with kFirstMethod.
    for (m_current = m_values.size() - 1; m_current > 0 && std::string_view(info().id) != kFirstMethod; --m_current) {}
}

const ao::Values& Choice::valuesOf(const ao::MethodInfo& info) const {
    return *std::find_if(m_values.begin(), m_values.end(), [&](const ao::Values& values) { return &values.info() == &info; });
}

void Choice::selectNext(int step) { m_current = size_t(int(m_current + m_values.size()) + step) % m_values.size(); }

void Choice::select(const std::string& id) {
    const std::vector<std::string> ids = methodIds();
    for (size_t i = 0; i < ids.size(); ++i)
        if (ids[i] == id) return select(i);
    throw Complaint(fmt::format("--method {}: no such method; {}", id, app::choices(id, ids)));
}

void Choice::applyPreset(const std::string& id) {
    std::vector<std::string> names;
    for (const ao::Preset& preset : info().presets) {
        names.emplace_back(preset.id);
        if (names.back() != id) continue;
        values() = ao::Values(info());
        values().apply(preset);
        return;
    }
    throw Complaint(fmt::format("--preset {}: {} has no such preset; {}", id, info().id, app::choices(id, names)));
}

void Choice::applyResolve(const std::string& id) {
    if (id == kOwn) return;
    const ao::Preset* preset = ao::findResolvePreset(id.c_str());
    std::vector<std::string> names{kOwn};
    for (const ao::Preset& known : ao::resolvePresets()) names.emplace_back(known.id);
    if (!preset) throw Complaint(fmt::format("--resolve {}: {}", id, app::choices(id, names)));
    resolve(values(), *preset);
}

void Choice::resolveAll(const std::string& id) {
    const ao::Preset* preset = ao::findResolvePreset(id.c_str());
    for (ao::Values& values : m_values)
        if (preset && values.info().needs) resolve(values, *preset);
}

void Choice::assign(const std::string& assignment) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw Complaint(fmt::format("--set {}: no value; write METHOD.PARAMETER=VALUE", assignment));
    const std::string left = assignment.substr(0, equals), text = assignment.substr(equals + 1);
    const size_t dot = left.find('.');
    size_t method = m_current;
    if (dot != std::string::npos) {
        const std::string id = left.substr(0, dot);
        const std::vector<std::string> ids = methodIds();
        for (method = 0; method < ids.size() && ids[method] != id; ++method) {}
        if (method == ids.size()) throw Complaint(fmt::format("--set {}: no method {}; {}", assignment, id, app::choices(id, ids)));
    }
    const std::string name = dot == std::string::npos ? left : left.substr(dot + 1);
    const ao::MethodInfo& info = m_values[method].info();
    std::vector<std::string> names;
    for (const ao::Parameter& parameter : info.parameters) {
        names.emplace_back(parameter.id);
        if (names.back() != name) continue;
        for (size_t i = 0; i < parameter.choices.size(); ++i)
            if (text == parameter.choices[i]) {
                m_values[method].set(parameter.id, float(i));
                return;
            }
        float value = 0.0f;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
            std::vector<std::string> words(parameter.choices.begin(), parameter.choices.end());
            throw Complaint(words.empty() ? fmt::format("--set {}: '{}' is not a number; {} goes from {:g} to {:g}", assignment, text, name,
                                                parameter.minimum, parameter.maximum)
                                          : fmt::format("--set {}: {}", assignment, app::choices(text, words)));
        }
        if (value < parameter.minimum || value > parameter.maximum || (parameter.integer && value != std::floor(value)))
            throw Complaint(fmt::format("--set {}: {} is a {} from {:g} to {:g}", assignment, name,
                parameter.integer ? "whole number" : "number", parameter.minimum, parameter.maximum));
        m_values[method].set(parameter.id, value);
        return;
    }
    if (names.empty()) throw Complaint(fmt::format("--set {}: {} has no parameters", assignment, info.id));
    throw Complaint(fmt::format("--set {}: {} has no parameter {}; {}", assignment, info.id, name, app::choices(name, names)));
}

void Choice::read(const std::string& text) {
    const size_t comma = text.find(','), colon = text.substr(0, comma).find(':');
    try {
        select(text.substr(0, std::min(comma, colon)));
        if (colon != std::string::npos) applyPreset(text.substr(colon + 1, comma == std::string::npos ? comma : comma - colon - 1));
        for (size_t at = comma; at != std::string::npos;) {
            const size_t next = text.find(',', at + 1);
            assign(text.substr(at + 1, next == std::string::npos ? next : next - at - 1));
            at = next;
        }
    } catch (const Complaint& complaint) {
        const std::string what = complaint.what();  // begins with the option that sets the same
        throw Complaint(fmt::format("--compare {}: {}", text, what.substr(what.find(": ") + 2)));
    }
}

void Choice::assignToAll(const std::string& parameter, const std::string& value) {
    assign(parameter + "=" + value);
    for (ao::Values& values : m_values)
        if (values.has(parameter.c_str())) values.set(parameter.c_str(), this->values()[parameter.c_str()]);
}

void Choice::setFalloff(const std::string& text) {
    if (ao::parseFalloff(text.c_str(), falloff)) return;
    const std::string kind = text.substr(0, text.find(':'));
    const std::vector<std::string> kinds(ao::falloffKinds().begin(), ao::falloffKinds().end());
    for (const std::string& known : kinds)
        if (kind == known)
            throw Complaint(fmt::format(
                "--falloff {}: write {}, lengths in metres above 0", text, kind == "ramp" ? "ramp:START:END" : kind + ":LENGTH"));
    throw Complaint(fmt::format("--falloff {}: no such kind; {}", text, app::choices(kind, kinds)));
}

}  // namespace obscura::game
