#include "measure/candidate.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "ao/settings_text.h"
#include "app/complaint.h"
#include "app/voxel_arguments.h"

namespace obscura::measure {

using app::Complaint;

namespace {

std::string safe(std::string text) {
    for (char& c : text)
        if (!std::isalnum((unsigned char)c) && c != '.' && c != '-') c = '_';
    return text;
}

bool isAll(const std::vector<std::string>& names) { return names.size() == 1 && names[0] == "all"; }

std::vector<const ao::MethodInfo*> methodsOf(const std::vector<std::string>& wanted) {
    std::vector<const ao::MethodInfo*> found;
    if (isAll(wanted)) return {ao::methods().begin(), ao::methods().end()};
    std::vector<std::string> ids;
    for (const ao::MethodInfo* info : ao::methods()) ids.emplace_back(info->id);
    for (const std::string& id : wanted) {
        const ao::MethodInfo* info = ao::findMethod(id.c_str());
        if (!info) throw Complaint(fmt::format("--method {}: no such method; {}, or all", id, app::choices(id, ids)));
        if (std::find(found.begin(), found.end(), info) == found.end()) found.push_back(info);
    }
    return found;
}

bool wants(const std::vector<std::string>& presets, const char* id) {
    return isAll(presets) || std::find(presets.begin(), presets.end(), id) != presets.end();
}

// A preset that only some of the methods have is accepted; one that none has is an error.
void expectKnown(const std::vector<const ao::MethodInfo*>& methods, const std::vector<std::string>& presets) {
    std::vector<std::string> names;
    for (const ao::MethodInfo* info : methods)
        for (const ao::Preset& preset : info->presets)
            if (std::find(names.begin(), names.end(), preset.id) == names.end()) names.emplace_back(preset.id);
    for (const std::string& wanted : presets)
        if (!isAll(presets) && std::find(names.begin(), names.end(), wanted) == names.end())
            throw Complaint(fmt::format("--preset {}: {} no such preset; {}, or all", wanted,
                methods.size() == 1 ? std::string(methods[0]->id) + " has" : "the chosen methods have", app::choices(wanted, names)));
}

// Voxelization settings, as parameters of the methods that trace voxels.
const ao::Parameter kVoxels[] = {
    {"voxels", "", 64, 512, 256, true, {}, ""},
    {"voxel_levels", "", 1, 8, 5, true, {}, ""},
    {"voxel_size", "m", 0, 1000, 0, false, {}, ""},
    {"voxelizer", "", 0, 1, 0, true, {app::kVoxelizerNames, 2}, ""},
    {"voxel_structure", "", 0, 1, 0, true, {app::kStructureNames, 2}, ""},
    {"voxel_shell", "", 0, 1, 0, true, {app::kShellNames, 2}, ""},
};
constexpr std::optional<float> VoxelChoice::* kVoxelMembers[] = {&VoxelChoice::cells, &VoxelChoice::levels, &VoxelChoice::cellSize,
    &VoxelChoice::voxelizer, &VoxelChoice::structure, &VoxelChoice::shell};

// Empty if the method has no such parameter.
const ao::Parameter* parameterOf(const Candidate& candidate, const std::string& name) {
    for (const ao::Parameter& parameter : candidate.info().parameters)
        if (name == parameter.id) return &parameter;
    if (ao::needs(candidate.values) & ao::kVolume)
        for (const ao::Parameter& parameter : kVoxels)
            if (name == parameter.id) return &parameter;
    return nullptr;
}

float valueOf(const std::string& assignment, const ao::Parameter& parameter, const std::string& text) {
    for (size_t i = 0; i < parameter.choices.size(); ++i)
        if (text == parameter.choices[i]) return float(i);
    float value = 0.0f;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        const std::vector<std::string> words(parameter.choices.begin(), parameter.choices.end());
        throw Complaint(words.empty() ? fmt::format("--set {}: '{}' is not a number; {} goes from {:g} to {:g}", assignment, text,
                                            parameter.id, parameter.minimum, parameter.maximum)
                                      : fmt::format("--set {}: {}", assignment, app::choices(text, words)));
    }
    if (value < parameter.minimum || value > parameter.maximum || (parameter.integer && value != std::floor(value)))
        throw Complaint(fmt::format("--set {}: {} is a {} from {:g} to {:g}", assignment, parameter.id,
            parameter.integer ? "whole number" : "number", parameter.minimum, parameter.maximum));
    return value;
}

void assign(std::vector<Candidate>& list, const std::string& assignment) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw Complaint(fmt::format("--set {}: no value; write METHOD.PARAMETER=VALUE", assignment));
    const std::string left = assignment.substr(0, equals), text = assignment.substr(equals + 1);
    const size_t dot = left.find('.');
    const std::string method = dot == std::string::npos ? "" : left.substr(0, dot),
                      name = dot == std::string::npos ? left : left.substr(dot + 1);
    bool chosen = false, used = false;
    const ao::Preset* resolve = name == "resolve" ? &resolvePreset("--set " + assignment, text) : nullptr;
    std::vector<std::string> names, ids;
    for (Candidate& candidate : list) {
        if (std::find(ids.begin(), ids.end(), candidate.info().id) == ids.end()) ids.emplace_back(candidate.info().id);
        if (!method.empty() && method != candidate.info().id) continue;
        chosen = true;
        for (const ao::Parameter& parameter : candidate.info().parameters)
            if (std::find(names.begin(), names.end(), parameter.id) == names.end()) names.emplace_back(parameter.id);
        if (resolve) {
            candidate.values.resolve(*resolve);
            candidate.settings.push_back(assignment.substr(dot == std::string::npos ? 0 : dot + 1));
            used = true;
            continue;
        }
        const ao::Parameter* parameter = parameterOf(candidate, name);
        if (!parameter) continue;
        const float value = valueOf(assignment, *parameter, text);
        if (parameter == kVoxels && value != 64.0f && value != 128.0f && value != 256.0f && value != 512.0f)
            throw Complaint(fmt::format("--set {}: a window has 64, 128, 256 or 512 cells a side", assignment));
        if (!candidate.values.set(parameter->id, value)) candidate.voxels.*kVoxelMembers[parameter - kVoxels] = value;
        candidate.settings.push_back(name + "=" + text);
        used = true;
    }
    if (!chosen) throw Complaint(fmt::format("--set {}: {} is not among the chosen methods: {}", assignment, method, fmt::join(ids, ", ")));
    if (!used) throw Complaint(fmt::format("--set {}: no parameter {}; {}", assignment, name, app::choices(name, names)));
}

}  // namespace

const ao::Preset& resolvePreset(const std::string& said, const std::string& id) {
    std::vector<std::string> names;
    for (const ao::Preset& known : ao::resolvePresets()) names.emplace_back(known.id);
    if (const ao::Preset* preset = ao::findResolvePreset(id.c_str())) return *preset;
    throw Complaint(fmt::format("{}: {}", said, app::choices(id, names)));
}

render::Voxelization VoxelChoice::over(render::Voxelization how) const {
    if (cells) how.cells = uint32_t(*cells);
    if (levels) how.levels = uint32_t(*levels);
    if (cellSize) how.cellSize = *cellSize;
    if (voxelizer) how.voxelizer = render::Voxelizer(int(*voxelizer));
    if (structure) how.structure = ao::VolumeStructure(int(*structure));
    if (shell) how.shell = voxel::Shell(int(*shell));
    return how;
}

std::string Candidate::label() const {
    std::string text = info().id;
    if (preset != "default") text += " " + preset;
    for (const std::string& setting : settings) text += " " + setting;
    return text;
}

std::string Candidate::fileName() const {
    std::string text = std::string(info().id) + "." + preset;
    for (const std::string& setting : settings) text += "." + setting;
    return safe(text);
}

std::string FalloffChoice::fileName() const { return safe(text); }

std::vector<Candidate> candidates(
    const std::vector<std::string>& methods, const std::vector<std::string>& presets, const std::vector<std::string>& sets) {
    std::vector<Candidate> list;
    const std::vector<const ao::MethodInfo*> chosen = methodsOf(methods);
    expectKnown(chosen, presets);
    for (const ao::MethodInfo* info : chosen)
        for (const ao::Preset& preset : info->presets) {
            if (!wants(presets, preset.id)) continue;
            list.push_back({ao::Values(*info), preset.id, {}});
            list.back().values.apply(preset);
        }
    for (const std::string& assignment : sets) assign(list, assignment);
    return list;
}

std::vector<Candidate> variants(
    const std::vector<std::string>& methods, const std::vector<std::string>& presets, const std::vector<std::string>& sets) {
    // Every combination of the lists' values, the last list's fastest.
    std::vector<std::vector<std::string>> combinations{{}};
    std::vector<std::string> varied;
    for (const std::string& set : sets) {
        const size_t equals = set.find('='), dot = set.rfind('.', equals);
        const bool list = equals != std::string::npos && set.find(',', equals) != std::string::npos;
        if (list) varied.push_back(set.substr(dot == std::string::npos ? 0 : dot + 1, equals - (dot == std::string::npos ? 0 : dot + 1)));
        std::vector<std::vector<std::string>> next;
        for (const std::vector<std::string>& combination : combinations)
            for (size_t at = list ? equals + 1 : 0; at <= set.size();) {
                const size_t end = list ? std::min(set.find(',', at), set.size()) : set.size();
                next.push_back(combination);
                next.back().push_back(list ? set.substr(0, equals + 1) + set.substr(at, end - at) : set);
                at = end + 1;
            }
        combinations = std::move(next);
    }
    std::vector<Candidate> all;
    for (const std::vector<std::string>& combination : combinations)
        for (Candidate& candidate : candidates(methods, presets, combination)) {
            const bool known = std::any_of(all.begin(), all.end(), [&](const Candidate& c) { return c.label() == candidate.label(); });
            if (known) continue;
            for (const std::string& name : varied)
                for (const std::string& setting : candidate.settings)
                    if (setting.starts_with(name + "=")) candidate.varied.push_back(name);
            all.push_back(std::move(candidate));
        }
    // Variants of a method are adjacent, in the order of the methods.
    std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
        const auto order = [](const Candidate& c) { return std::find(ao::methods().begin(), ao::methods().end(), &c.info()); };
        return order(a) < order(b);
    });
    return all;
}

std::vector<FalloffChoice> falloffs(const std::vector<std::string>& texts) {
    std::vector<FalloffChoice> list;
    const std::vector<std::string> kinds(ao::falloffKinds().begin(), ao::falloffKinds().end());
    for (const std::string& text : texts) {
        ao::Falloff falloff;
        if (!ao::parseFalloff(text.c_str(), falloff)) {
            const std::string kind = text.substr(0, text.find(':'));
            if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
                throw Complaint(fmt::format("--falloff {}: no such kind; {}", text, app::choices(kind, kinds)));
            throw Complaint(fmt::format(
                "--falloff {}: write {}, lengths in metres above 0", text, kind == "ramp" ? "ramp:START:END" : kind + ":LENGTH"));
        }
        // Normalized spelling, because cells and channels are found by it.
        const std::string plain = ao::falloffText(falloff);
        const bool known = std::any_of(list.begin(), list.end(), [&](const FalloffChoice& f) { return f.text == plain; });
        if (!known) list.push_back({falloff, plain});
    }
    return list;
}

}  // namespace obscura::measure
