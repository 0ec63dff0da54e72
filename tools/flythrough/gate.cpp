#include "gate.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/complaint.h"
#include "app/files.h"
#include "report.h"
#include "scene/json_file.h"

namespace obscura::flythrough {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

std::map<CalmKey, CalmRow> measureRows(const Calm& calm, const Options& options) {
    Settings settings;
    settings.size = calm.size;
    settings.length = settings.end = calm.length;
    settings.rays = calm.rays;
    settings.pictures = false;
    settings.cache = options.settings.cache;
    measure::Machine machine({options.device, options.validation, options.verbose});
    std::map<CalmKey, CalmRow> rows;
    for (const std::string& name : calm.flythroughs) {
        Flight flight(machine, findScript(name), settings);
        for (const measure::Candidate& candidate : options.candidates)
            for (const ao::Preset& filter : ao::resolvePresets()) {
                if (!candidate.info().needs) continue;  // `none` cannot flicker
                if (std::find(calm.filters.begin(), calm.filters.end(), filter.id) == calm.filters.end()) continue;
                const Part part = flight.measure(candidate, filter);
                const Summary summary = summarize(part);
                rows[{part.method, part.preset, part.flythrough, part.filter}] = {summary.flickerOfError, summary.noiseMean, summary.t90};
            }
    }
    return rows;
}

std::string name(const CalmKey& key) {
    return fmt::format("{} {}, {}, {}", std::get<0>(key), std::get<1>(key), std::get<2>(key), std::get<3>(key));
}

}  // namespace

Calm readCalm(const fs::path& file) {
    const scene::JsonFile json(file);
    const scene::JsonAt root = json.root();
    root.only({"about", "size", "length", "rays", "relative", "absolute", "flythroughs", "filters", "rows"});
    Calm calm;
    root.at("size").expectNumbers(2);
    calm.size = {root.at("size").at(size_t(0)).whole(16, 8192), root.at("size").at(1).whole(16, 8192)};
    calm.length = uint32_t(root.at("length").whole(2, 100000));
    calm.rays = uint32_t(root.at("rays").whole(32, 65536));
    calm.relative = root.at("relative").number(0.0, 10.0);
    calm.absolute = root.at("absolute").number(0.0, 1.0);
    calm.flythroughs = scene::texts(root.at("flythroughs"));
    calm.filters = scene::texts(root.at("filters"));
    const scene::JsonAt rows = root.at("rows").expectArray();
    for (size_t i = 0; i < rows.size(); ++i) {
        const scene::JsonAt at = rows.at(i);
        at.only({"method", "preset", "flythrough", "filter", "flickerOfError", "noise", "t90"});
        calm.rows[{at.at("method").text(), at.at("preset").text(), at.at("flythrough").text(), at.at("filter").text()}] = {
            at.at("flickerOfError").number(0.0, 1.0), at.at("noise").number(0.0, 1.0), uint32_t(at.at("t90").whole(0, 100000))};
    }
    return calm;
}

std::string calmText(const Calm& calm) {
    // Not dumped by the JSON library: one line per row keeps diffs readable.
    const Json head{{"about",
                        "Flicker of error, static noise and lag (frames). A row may not worsen by more than `relative` of itself and "
                        "`absolute`. Renew: "
                        "obscura-flythrough --renew-baseline THIS"},
        {"size", {calm.size.x, calm.size.y}}, {"length", calm.length}, {"rays", calm.rays}, {"relative", calm.relative},
        {"absolute", calm.absolute}, {"flythroughs", calm.flythroughs}, {"filters", calm.filters}};
    std::string text = "{\n";
    for (const auto& [key, value] : head.items()) text += fmt::format("  {}: {},\n", Json(key).dump(), value.dump());
    text += "  \"rows\": [";
    const char* separator = "\n";
    for (const auto& [key, row] : calm.rows) {
        const auto rounded = [](double v) { return std::stod(fmt::format("{:.6f}", v)); };
        const Json line{{"method", std::get<0>(key)}, {"preset", std::get<1>(key)}, {"flythrough", std::get<2>(key)},
            {"filter", std::get<3>(key)}, {"flickerOfError", rounded(row.flickerOfError)}, {"noise", rounded(row.noise)}, {"t90", row.t90}};
        text += separator + ("    " + line.dump());
        separator = ",\n";
    }
    return text + "\n  ]\n}\n";
}

std::vector<std::string> judge(const Calm& held, const std::map<CalmKey, CalmRow>& measured) {
    std::vector<std::string> lines;
    const auto worse = [&](double now, double was) { return now - was > std::max(held.absolute, held.relative * was); };
    for (const auto& [key, row] : measured) {
        const auto found = held.rows.find(key);
        if (found == held.rows.end()) {
            lines.push_back(fmt::format("{}: not in the baseline (flicker of error {:.5f}, noise {:.5f}, T90 {})", name(key),
                row.flickerOfError, row.noise, row.t90));
            continue;
        }
        const CalmRow& was = found->second;
        if (worse(row.flickerOfError, was.flickerOfError))
            lines.push_back(fmt::format("{}: flicker of error {:.5f}, was {:.5f}", name(key), row.flickerOfError, was.flickerOfError));
        if (worse(row.noise, was.noise)) lines.push_back(fmt::format("{}: noise {:.5f}, was {:.5f}", name(key), row.noise, was.noise));
        if (double(row.t90) > double(was.t90) * (1.0 + held.relative))
            lines.push_back(fmt::format("{}: T90 {} frames, was {}", name(key), row.t90, was.t90));
    }
    return lines;
}

int checkBaseline(const Options& options) {
    const Calm held = readCalm(options.baseline);
    const std::map<CalmKey, CalmRow> measured = measureRows(held, options);
    const std::vector<std::string> lines = judge(held, measured);
    for (const std::string& line : lines) fmt::print("  {}\n", line);
    if (lines.empty()) fmt::print("passed: {} rows, none worse by more than {:g} %\n", measured.size(), 100.0 * held.relative);
    else
        fmt::print("failed: {} of {} rows. If this change is intended: obscura-flythrough --renew-baseline {}\n", lines.size(),
            measured.size(), options.baseline.string());
    return lines.empty() ? 0 : app::kFailed;
}

int renewBaseline(const Options& options) {
    app::expectWritable(options.baseline);
    std::error_code ignored;
    Calm calm;
    if (fs::is_regular_file(options.baseline, ignored)) calm = readCalm(options.baseline);
    const std::map<CalmKey, CalmRow> measured = measureRows(calm, options);
    // Replaces all rows, or those of the selected methods only.
    if (options.candidates.size() == measure::candidates({"all"}, {"default"}, {}).size()) calm.rows.clear();
    for (const auto& [key, row] : measured) calm.rows[key] = row;
    app::writeFile(options.baseline, calmText(calm));
    fmt::print("{}: {} rows, {} measured now\n", options.baseline.string(), calm.rows.size(), measured.size());
    return 0;
}

}  // namespace obscura::flythrough
