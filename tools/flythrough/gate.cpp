#include "gate.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/complaint.h"
#include "app/files.h"
#include "report.h"
#include "scene/json_file.h"
#include "scene/json_text.h"

namespace obscura::flythrough {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

std::map<FlickerKey, FlickerRow> measureRows(const FlickerBaseline& baseline, const Options& options) {
    Settings settings;
    settings.size = baseline.size;
    settings.length = settings.end = baseline.length;
    settings.rays = baseline.rays;
    settings.pictures = false;
    settings.cache = options.settings.cache;
    measure::Machine machine({options.device, options.validation, options.verbose});
    std::map<FlickerKey, FlickerRow> rows;
    for (const std::string& name : baseline.flythroughs) {
        Flight flight(machine, findScript(name), settings);
        for (const measure::Candidate& candidate : options.candidates)
            for (const ao::Preset& filter : ao::resolvePresets()) {
                if (!candidate.info().needs) continue;  // `none` cannot flicker
                if (std::find(baseline.filters.begin(), baseline.filters.end(), filter.id) == baseline.filters.end()) continue;
                const Chunk chunk = flight.measure(candidate, filter);
                const Summary summary = summarize(chunk);
                if (summary.frames == 0) throw app::Complaint(fmt::format("{}: shows only sky; a baseline needs surfaces", name));
                rows[{chunk.method, chunk.preset, chunk.flythrough, chunk.filter}] = {
                    summary.flickerOfError, summary.noiseMean, summary.t90};
            }
    }
    return rows;
}

std::string name(const FlickerKey& key) {
    return fmt::format("{} {}, {}, {}", std::get<0>(key), std::get<1>(key), std::get<2>(key), std::get<3>(key));
}

}  // namespace

FlickerBaseline readBaseline(const fs::path& file) {
    const scene::JsonFile json(file);
    const scene::JsonAt root = json.root();
    root.only({"about", "size", "length", "rays", "relative", "absolute", "flythroughs", "filters", "rows"});
    FlickerBaseline baseline;
    root.at("size").expectNumbers(2);
    baseline.size = {root.at("size").at(size_t(0)).whole(16, 8192), root.at("size").at(1).whole(16, 8192)};
    baseline.length = uint32_t(root.at("length").whole(2, 100000));
    baseline.rays = uint32_t(root.at("rays").whole(32, 65536));
    baseline.relative = root.at("relative").number(0.0, 10.0);
    baseline.absolute = root.at("absolute").number(0.0, 1.0);
    baseline.flythroughs = scene::texts(root.at("flythroughs"));
    baseline.filters = scene::texts(root.at("filters"));
    const scene::JsonAt rows = root.at("rows").expectArray();
    for (size_t i = 0; i < rows.size(); ++i) {
        const scene::JsonAt at = rows.at(i);
        at.only({"method", "preset", "flythrough", "filter", "flickerOfError", "noise", "t90"});
        baseline.rows[{at.at("method").text(), at.at("preset").text(), at.at("flythrough").text(), at.at("filter").text()}] = {
            at.at("flickerOfError").number(0.0, 1.0), at.at("noise").number(0.0, 1.0), uint32_t(at.at("t90").whole(0, 100000))};
    }
    return baseline;
}

std::string baselineText(const FlickerBaseline& baseline) {
    // Not dumped by the JSON library: one line per row keeps diffs readable.
    const Json head{{"about",
                        "Flicker of error, static noise and lag (frames). A row may not worsen by more than `relative` of itself and "
                        "`absolute`. Renew: "
                        "obscura-flythrough --renew-baseline THIS"},
        {"size", {baseline.size.x, baseline.size.y}}, {"length", baseline.length}, {"rays", baseline.rays}, {"relative", baseline.relative},
        {"absolute", baseline.absolute}, {"flythroughs", baseline.flythroughs}, {"filters", baseline.filters}};
    std::string text = "{\n";
    for (const auto& [key, value] : head.items()) text += fmt::format("  {}: {},\n", scene::dump(Json(key)), scene::dump(value));
    text += "  \"rows\": [";
    const char* separator = "\n";
    for (const auto& [key, row] : baseline.rows) {
        const auto rounded = [](double v) { return std::round(v * 1e6) / 1e6; };
        const Json line{{"method", std::get<0>(key)}, {"preset", std::get<1>(key)}, {"flythrough", std::get<2>(key)},
            {"filter", std::get<3>(key)}, {"flickerOfError", rounded(row.flickerOfError)}, {"noise", rounded(row.noise)}, {"t90", row.t90}};
        text += separator + ("    " + scene::dump(line));
        separator = ",\n";
    }
    return text + "\n  ]\n}\n";
}

std::vector<std::string> judge(const FlickerBaseline& baseline, const std::map<FlickerKey, FlickerRow>& measured) {
    std::vector<std::string> lines;
    const auto worse = [&](double now, double was) { return now - was > std::max(baseline.absolute, baseline.relative * was); };
    for (const auto& [key, row] : measured) {
        const auto found = baseline.rows.find(key);
        if (found == baseline.rows.end()) {
            lines.push_back(fmt::format("{}: not in the baseline (flicker of error {:.5f}, noise {:.5f}, T90 {})", name(key),
                row.flickerOfError, row.noise, row.t90));
            continue;
        }
        const FlickerRow& was = found->second;
        if (worse(row.flickerOfError, was.flickerOfError))
            lines.push_back(fmt::format("{}: flicker of error {:.5f}, was {:.5f}", name(key), row.flickerOfError, was.flickerOfError));
        if (worse(row.noise, was.noise)) lines.push_back(fmt::format("{}: noise {:.5f}, was {:.5f}", name(key), row.noise, was.noise));
        if (double(row.t90) > double(was.t90) * (1.0 + baseline.relative))
            lines.push_back(fmt::format("{}: T90 {} frames, was {}", name(key), row.t90, was.t90));
    }
    return lines;
}

int checkBaseline(const Options& options) {
    const FlickerBaseline baseline = readBaseline(options.baseline);
    const std::map<FlickerKey, FlickerRow> measured = measureRows(baseline, options);
    const std::vector<std::string> lines = judge(baseline, measured);
    for (const std::string& line : lines) fmt::print("  {}\n", line);
    if (lines.empty()) fmt::print("passed: {} rows, none worse by more than {:g} %\n", measured.size(), 100.0 * baseline.relative);
    else
        fmt::print("failed: {} of {} rows. If this change is intended: obscura-flythrough --renew-baseline {}\n", lines.size(),
            measured.size(), options.baseline.string());
    return lines.empty() ? 0 : app::kFailed;
}

int renewBaseline(const Options& options) {
    app::expectWritable(options.baseline);
    std::error_code ignored;
    FlickerBaseline baseline;
    if (fs::is_regular_file(options.baseline, ignored)) baseline = readBaseline(options.baseline);
    const std::map<FlickerKey, FlickerRow> measured = measureRows(baseline, options);
    // Replaces all rows, or those of the selected methods only.
    if (options.candidates.size() == measure::candidates({"all"}, {"default"}, {}).size()) baseline.rows.clear();
    for (const auto& [key, row] : measured) baseline.rows[key] = row;
    app::writeFile(options.baseline, baselineText(baseline));
    fmt::print("{}: {} rows, {} measured now\n", options.baseline.string(), baseline.rows.size(), measured.size());
    return 0;
}

}  // namespace obscura::flythrough
