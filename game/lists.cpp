// --list-methods, --list-scenes and --list-devices.
#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/complaint.h"
#include "jobs.h"
#include "scene/json_text.h"

namespace obscura::game {

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> needsOf(const ao::MethodInfo& info) {
    constexpr std::pair<ao::Needs, const char*> kNames[] = {
        {ao::kDepth, "depth"}, {ao::kNormals, "normals"}, {ao::kMotion, "motion"}, {ao::kLayers, "layers"}, {ao::kVolume, "volume"}};
    std::vector<std::string> names;
    for (const auto& [bit, name] : kNames)
        if (info.needs & bit) names.emplace_back(name);
    return names;
}

Json jsonOf(const ao::MethodInfo& info) {
    Json parameters = Json::array(), presets = Json::array();
    for (const ao::Parameter& p : info.parameters) {
        Json parameter{
            {"id", p.id}, {"unit", p.unit}, {"minimum", p.minimum}, {"maximum", p.maximum}, {"initial", p.initial}, {"integer", p.integer}};
        parameter["choices"] = std::vector<std::string>(p.choices.begin(), p.choices.end());
        parameter["sentence"] = p.sentence;
        parameters.push_back(parameter);
    }
    for (const ao::Preset& p : info.presets) {
        Json settings = Json::object();
        for (const ao::Setting& setting : p.settings) settings[setting.id] = setting.value;
        presets.push_back({{"id", p.id}, {"sentence", p.sentence}, {"settings", settings}});
    }
    return {{"id", info.id}, {"title", info.title}, {"paper", info.paper}, {"sentence", info.sentence}, {"needs", needsOf(info)},
        {"parameters", parameters}, {"presets", presets}};
}

}  // namespace

int listMethods(bool json) {
    if (json) {
        Json list = Json::array();
        for (const ao::MethodInfo* info : ao::methods()) list.push_back(jsonOf(*info));
        std::puts(scene::dump(list, 2).c_str());
        return 0;
    }
    for (const ao::MethodInfo* info : ao::methods()) {
        fmt::print("{}: {}\n    {}\n", info->id, info->title, info->sentence);
        if (*info->paper) fmt::print("    {}\n", info->paper);
        fmt::print("    needs {}\n", fmt::join(needsOf(*info), ", "));
        for (const ao::Parameter& p : info->parameters) {
            std::vector<std::string> words(p.choices.begin(), p.choices.end());
            const std::string range =
                words.empty() ? fmt::format("{:g} to {:g}{}{}, {:g}", p.minimum, p.maximum, *p.unit ? " " : "", p.unit, p.initial)
                              : fmt::format("{}; {}", fmt::join(words, " | "), words[std::min(words.size() - 1, size_t(p.initial))]);
            fmt::print("    --set {}.{}=  ({})  {}\n", info->id, p.id, range, p.sentence);
        }
        for (const ao::Preset& p : info->presets) fmt::print("    --preset {}  {}\n", p.id, p.sentence);
    }
    return 0;
}

int listScenes() {
    fmt::print("{}", sceneList());
    return 0;
}

int listScene(const std::string& scene) {
    fmt::print("{}", app::contentList(*scene::loadGltf(app::expectScene(scene).file, {.loadImages = false})));
    return 0;
}

int listDevices() {
    const std::vector<std::string> devices = gpu::Device::list();
    if (devices.empty())
        throw app::Complaint("no Vulkan device found; install a driver (mesa-vulkan-drivers has a software one)", app::kFailed);
    for (const std::string& device : devices) std::puts(device.c_str());
    return 0;
}

}  // namespace obscura::game
