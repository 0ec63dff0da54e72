// The methods there are, in the order keys and menus show them. A new one is one line in each of the two lists.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <iterator>

#include "ao/method.h"
#include "ao/resolve.h"

namespace obscura::ao {

MethodEntry noneEntry();
MethodEntry hbaoEntry();
MethodEntry horizonSplitEntry();
MethodEntry multiResolutionEntry();
MethodEntry statisticalEntry();
MethodEntry farFieldEntry();
MethodEntry mipmapEntry();
MethodEntry hybridEntry();
MethodEntry layeredEntry();
MethodEntry gtaoEntry();
MethodEntry visibilityBitmaskEntry();
MethodEntry ssaoEntry();
MethodEntry volumetricEntry();
MethodEntry scalableEntry();

namespace {

// What every method has beside its own: the library puts the shared temporal pass behind it.
const Parameter kShared[] = {
    {"temporal", "", 0, 0.98f, 0, false, {}, "Most weight the past gets, reprojected by motion vectors; 0: none. Samples then rotate over frames."},
    {"temporal_clip", "sd", 0, 8, TemporalSettings{}.clip, false, {}, "The past is drawn into so many standard deviations of the present around; 0 lets moved occluders trail."},
};

const Setting kRaw[] = {{"denoise", 0}, {"blur", 0}, {"filter", 0}, {"temporal", 0}};
const Setting kSpatial[] = {{"temporal", 0}};
const Setting kTemporal[] = {{"temporal", 0.92f}};
const Preset kResolves[] = {
    {"raw", "Samples as they are.", {kRaw, std::size(kRaw)}},
    {"spatial", "The method's own blur.", {kSpatial, std::size(kSpatial)}},
    {"temporal", "The method's own blur, samples that rotate, and a history that averages them.", {kTemporal, std::size(kTemporal)}},
};

// And what every method has that looks at the screen alone: the off-screen pass, before the temporal one.
const char* const kOffScreen[] = {"off", "offscreen", "hidden"};
const Parameter kUnseen[] = {
    {"offscreen", "", 0, 2, 0, true, {kOffScreen, 3}, "Occluders from voxels of the world that the picture does not show: those outside of it, or those hidden in it as well."},
    {"offscreen_rays", "", 4, 64, 16, true, {}, "Rays through the voxels, for a quarter of the pixels; cost grows with rays x reach / stride."},
    {"offscreen_stride", "cells", 0.5f, 8, 1.25f, false, {}, "How far such a ray steps; longer ones miss walls, which are a cell thick where they lie along the grid."},
};

bool seesTheScreenAlone(const MethodInfo& info) { return info.needs && !(info.needs & kVolume); }

// A method's own table with the shared ones behind it.
struct Composed {
    std::vector<Parameter> parameters;
    MethodInfo info;
    explicit Composed(const MethodInfo& own) : info(own) {
        parameters.assign(own.parameters.begin(), own.parameters.end());
        if (seesTheScreenAlone(own)) parameters.insert(parameters.end(), std::begin(kUnseen), std::end(kUnseen));
        if (own.needs) parameters.insert(parameters.end(), std::begin(kShared), std::end(kShared));
        info.parameters = {parameters.data(), parameters.size()};
    }
};

}  // namespace

std::span<const MethodEntry> registry() {
    static const std::vector<MethodEntry> kEntries = [] {
        std::vector<MethodEntry> entries{noneEntry(), hbaoEntry(), horizonSplitEntry(), multiResolutionEntry(), statisticalEntry(), farFieldEntry(), mipmapEntry(), hybridEntry(), layeredEntry(),
                                         gtaoEntry(), visibilityBitmaskEntry(), ssaoEntry(), volumetricEntry(), scalableEntry()};
        static std::vector<std::unique_ptr<Composed>> composed;
        for (MethodEntry& entry : entries) entry.info = &composed.emplace_back(std::make_unique<Composed>(*entry.info))->info;
        return entries;
    }();
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

List<Preset> resolvePresets() { return {kResolves, std::size(kResolves)}; }

const Preset* findResolvePreset(const char* id) {
    for (const Preset& preset : kResolves)
        if (id && std::strcmp(preset.id, id) == 0) return &preset;
    return nullptr;
}

uint32_t needs(const Values& values) {
    const MethodInfo& info = values.info();
    uint32_t result = info.needs;
    if (values.has("offscreen") && values["offscreen"] > 0.0f) result |= kVolume;
    for (const MethodEntry& entry : registry())
        if (entry.info == &info && entry.needs) result |= entry.needs(values);
    return result;
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
    return std::any_of(m_info->parameters.begin(), m_info->parameters.end(), [id](const Parameter& parameter) { return std::strcmp(parameter.id, id) == 0; });
}

float Values::operator[](const char* id) const {
    for (size_t i = 0; i < m_values.size(); ++i)
        if (std::strcmp(m_info->parameters[i].id, id) == 0) return m_values[i];
    assert(!"a method asked for a parameter that its table does not have");
    return 0.0f;
}

LayerUse layersOf(const Values& values) { return values.has("depth_layers") ? LayerUse(values.count("depth_layers")) : LayerUse::none; }

}  // namespace obscura::ao
