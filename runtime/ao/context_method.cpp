// setMethod(): method, preset, settings and falloff from their names.
#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "ao/context.h"

namespace obscura::ao {
namespace {

const char* orNull(const char* text) { return text ? text : "(null)"; }

// "hbao, gtao": the ids of a list, for messages.
template <class List, class IdOf>
std::string listed(const List& list, IdOf idOf) {
    std::string result;
    for (const auto& item : list) result += (result.empty() ? "" : ", ") + std::string(idOf(item));
    return result;
}

const Preset* find(const List<Preset>& presets, const char* id) {
    for (const Preset& preset : presets)
        if (id && std::strcmp(preset.id, id) == 0) return &preset;
    return nullptr;
}

Status choose(Context& context, const char* id, const MethodSettings& settings) {
    const auto invalid = [&](const std::string& line) { return refuse(context, Status::invalid, line); };
    const auto idOf = [](const auto& item) { return item.id; };
    const MethodInfo* info = findMethod(id);
    if (!info)
        return invalid(fmt::format(
            "there is no method '{}'; there are {}", orNull(id), listed(methods(), [](const MethodInfo* method) { return method->id; })));
    const Preset* preset = find(info->presets, settings.preset);
    if (!preset)
        return invalid(fmt::format("{} has no preset '{}'; it has {}", info->id, orNull(settings.preset), listed(info->presets, idOf)));
    Values values(*info);
    values.apply(*preset);
    if (settings.resolve) {
        const Preset* resolve = findResolvePreset(settings.resolve);
        if (!resolve)
            return invalid(fmt::format("there is no resolve preset '{}'; there are {}", settings.resolve, listed(resolvePresets(), idOf)));
        values.resolve(*resolve);
    }
    if (settings.settings.count && !settings.settings.items) return invalid("MethodSettings::settings has a count but no items");
    for (const Setting& setting : settings.settings)
        if (!setting.id || !values.set(setting.id, setting.value))
            return invalid(
                fmt::format("{} has no parameter '{}'; it has {}", info->id, orNull(setting.id), listed(info->parameters, idOf)));
    const Falloff& falloff = settings.falloff;
    if (size_t(falloff.kind) >= falloffKinds().size())
        return invalid(fmt::format("MethodSettings::falloff.kind is {}; there are {}", uint32_t(falloff.kind),
            listed(falloffKinds(), [](const char* kind) { return kind; })));
    if (!(falloff.length > 0.0f) || !std::isfinite(reach(falloff)))
        return invalid(fmt::format("MethodSettings::falloff.length is {}; it must be finite and above 0", falloff.length));
    if (falloff.kind == FalloffKind::ramp && !(falloff.end > falloff.length))
        return invalid(fmt::format("MethodSettings::falloff.end is {}; a ramp ends beyond its length, {}", falloff.end, falloff.length));
    if (settings.bentNormals && !info->bentNormals)
        return invalid(fmt::format("MethodSettings::bentNormals: {} has none; {} do", info->id, bentNormalsFrom()));
    values.bentNormals = settings.bentNormals;
    if (!context.library->prepare(values, falloff.kind)) return statusOf(context.device->failure());
    context.capacity.clear();
    context.values = std::move(values);
    context.falloff = falloff;
    return Status::ok;
}

}  // namespace

Status setMethod(Context* context, const char* id, const MethodSettings& settings) noexcept {
    return context ? guarded(context->log, [&] { return choose(*context, id, settings); }) : Status::invalid;
}

}  // namespace obscura::ao
