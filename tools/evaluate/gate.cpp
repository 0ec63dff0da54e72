#include "gate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "app/statistics.h"
#include "scene/json_file.h"
#include "scene/json_text.h"

namespace obscura::evaluate {

namespace fs = std::filesystem;

namespace {

// The options of a baseline's measurement, with the command line's methods and device.
Options runOf(const Baseline& baseline, Options options) {
    options.scenes = baseline.scenes;
    options.cameras.clear();
    for (const std::string& camera : baseline.cameras) options.cameras.push_back(measure::cameraOf(camera));
    options.usualCameras = false;
    options.size = baseline.size;
    options.guard = baseline.guard;
    options.falloffs = measure::falloffs(baseline.falloffs);
    options.reference = {};
    for (const std::string& kind : baseline.references) (kind == "world" ? options.reference.world : options.reference.screen) = true;
    options.rays = {baseline.rays, 0.0f, baseline.seed, options.rays.cache};
    options.frames = 1;
    options.warmUp = 0;
    options.errorsOnly = true;
    measure::expectScenes(options);
    return options;
}

std::map<Cell, float> measureCells(const Options& options) {
    measure::Machine machine({options.device, options.validation, options.verbose});
    std::map<Cell, float> cells;
    measure::forEachShot(machine, options, [&](measure::Shot& shot) {
        const ShotResult result = measure(machine, shot, options);
        if (result.empty())
            throw app::Complaint(fmt::format("{} {}: {}; a baseline needs errors", result.scene, result.camera, result.remark));
        for (const Row& row : result.rows) {
            const measure::Candidate& candidate = options.candidates[result.drawn[row.drawn].candidate];
            const measure::ShotReference& reference = result.references[row.reference];
            cells[{candidate.info().id, candidate.preset, result.scene, result.camera, reference.falloff, reference.kind}] =
                row.whole().raw.eA;
        }
        fmt::print("{} {}: {} cells; frame {:.1f} s, references {:.1f} s{}, methods {:.1f} s, metrics {:.1f} s\n", result.scene,
            result.camera, result.rows.size(), result.seconds.frame, result.seconds.references,
            result.referencesFromCache ? " (cached)" : "", result.seconds.methods, result.seconds.metrics);
    });
    return cells;
}

void print(const char* title, const std::vector<std::string>& lines) {
    if (!lines.empty()) fmt::print("{}\n", title);
    for (const std::string& line : lines) fmt::print("  {}\n", line);
}

}  // namespace

std::string Cell::name() const { return fmt::format("{} {}, {} {}, {}, {}", method, preset, scene, camera, falloff, reference); }

Baseline readBaseline(const fs::path& file) {
    const scene::JsonFile json(file);
    const scene::JsonAt root = json.root();
    root.only({"about", "size", "guard", "rays", "seed", "relative", "absolute", "scenes", "cameras", "falloffs", "references", "cells"});
    Baseline baseline;
    root.at("size").expectNumbers(2);
    baseline.size = {root.at("size").at(size_t(0)).whole(16, 8192), root.at("size").at(1).whole(16, 8192)};
    baseline.guard = float(root.at("guard").number(0.0, 0.5));
    baseline.rays = uint32_t(root.at("rays").whole(32, 1u << 20));
    baseline.seed = uint32_t(root.at("seed").whole(0, ~0u));
    baseline.relative = float(root.at("relative").number(0.0, 10.0));
    baseline.absolute = float(root.at("absolute").number(0.0, 1.0));
    baseline.scenes = scene::texts(root.at("scenes"));
    baseline.cameras = scene::texts(root.at("cameras"));
    baseline.falloffs = scene::texts(root.at("falloffs"));
    baseline.references = scene::texts(root.at("references"));
    for (size_t i = 0; i < baseline.references.size(); ++i)
        if (baseline.references[i] != "world" && baseline.references[i] != "screen")
            root.at("references").at(i).fail("must be \"world\" or \"screen\"");
    const scene::JsonAt cells = root.at("cells").expectArray();
    for (size_t i = 0; i < cells.size(); ++i) {
        const scene::JsonAt at = cells.at(i);
        at.only({"method", "preset", "scene", "camera", "falloff", "reference", "eA"});
        baseline.cells[{at.at("method").text(), at.at("preset").text(), at.at("scene").text(), at.at("camera").text(),
            at.at("falloff").text(), at.at("reference").text()}] = float(at.at("eA").number(0.0, 1.0));
    }
    return baseline;
}

std::string baselineText(const Baseline& baseline) {
    // Not dumped by the JSON library: one line per cell keeps diffs readable.
    Json head;
    head["about"] =
        "Mean absolute error of visibility. A cell may not worsen by more than `relative` of itself and `absolute`. Renew: "
        "obscura-evaluate --renew-baseline THIS";
    head["size"] = {baseline.size.x, baseline.size.y};
    head["guard"] = app::digits(baseline.guard);
    head["rays"] = baseline.rays;
    head["seed"] = baseline.seed;
    head["relative"] = app::digits(baseline.relative);
    head["absolute"] = app::digits(baseline.absolute);
    head["scenes"] = baseline.scenes;
    head["cameras"] = baseline.cameras;
    head["falloffs"] = baseline.falloffs;
    head["references"] = baseline.references;
    std::string text = "{\n";
    for (const auto& [key, value] : head.items()) text += fmt::format("  {}: {},\n", scene::dump(Json(key)), scene::dump(value));
    text += "  \"cells\": [";
    const char* separator = "\n";
    for (const auto& [cell, eA] : baseline.cells) {
        const Json line = {{"method", cell.method}, {"preset", cell.preset}, {"scene", cell.scene}, {"camera", cell.camera},
            {"falloff", cell.falloff}, {"reference", cell.reference}, {"eA", std::round(double(eA) * 1e5) / 1e5}};
        text += separator + ("    " + scene::dump(line));
        separator = ",\n";
    }
    return text + "\n  ]\n}\n";
}

Verdict judge(const Baseline& baseline, const std::map<Cell, float>& measured) {
    Verdict verdict;
    for (const auto& [cell, eA] : measured) {
        const auto held = baseline.cells.find(cell);
        if (held == baseline.cells.end()) {
            verdict.missing.push_back(fmt::format("{}: eA {:.5f}", cell.name(), eA));
            continue;
        }
        const float change = eA - held->second, allowed = std::max(baseline.absolute, baseline.relative * held->second);
        const std::string line = fmt::format("{}: eA {:.5f}, was {:.5f} ({:+.1f} %)", cell.name(), eA, held->second,
            held->second > 0.0f ? 100.0f * change / held->second : 0.0f);
        if (change > allowed) verdict.worse.push_back(line);
        if (change < -allowed) verdict.better.push_back(line);
    }
    for (const auto& [cell, eA] : baseline.cells)
        if (!measured.count(cell)) verdict.gone.push_back(cell.name());
    return verdict;
}

int checkBaseline(const Options& wanted) {
    const Baseline baseline = readBaseline(wanted.baseline);
    const Options options = runOf(baseline, wanted);
    const std::map<Cell, float> measured = measureCells(options);
    const Verdict verdict = judge(baseline, measured);
    print("worse than the baseline:", verdict.worse);
    print("not in the baseline:", verdict.missing);
    print("better than the baseline (renew it to keep the improvement):", verdict.better);
    // Cells only in the baseline are reported only if all methods were measured.
    if (wanted.candidates.size() == measure::candidates({"all"}, {"all"}, {}).size()) print("in the baseline only:", verdict.gone);
    const std::string renew = fmt::format("obscura-evaluate --renew-baseline {}", wanted.baseline.string());
    if (!verdict.passes())
        fmt::print("failed: {} of {} cells are worse, {} are not in the baseline. If this change is intended: {}\n", verdict.worse.size(),
            measured.size(), verdict.missing.size(), renew);
    else
        fmt::print(
            "passed: {} cells, none worse by more than {:g} % and {:g}\n", measured.size(), 100.0f * baseline.relative, baseline.absolute);
    return verdict.passes() ? 0 : app::kFailed;
}

int renewBaseline(const Options& wanted) {
    app::expectWritable(wanted.baseline);
    std::error_code ignored;
    Baseline baseline;
    if (fs::is_regular_file(wanted.baseline, ignored)) baseline = readBaseline(wanted.baseline);
    else {
        baseline.scenes = {"toasters", "atrium"};
        baseline.cameras = {"own", "scene:0"};
        baseline.falloffs = {"quadratic:2", "exponential:1"};
        baseline.references = {"world", "screen"};
    }
    const std::map<Cell, float> measured = measureCells(runOf(baseline, wanted));
    // Replaces all cells, or those of the selected methods only.
    if (wanted.candidates.size() == measure::candidates({"all"}, {"all"}, {}).size()) baseline.cells.clear();
    for (const auto& [cell, eA] : measured) baseline.cells[cell] = eA;
    app::writeFile(wanted.baseline, baselineText(baseline));
    fmt::print("{}: {} cells, {} measured now\n", wanted.baseline.string(), baseline.cells.size(), measured.size());
    return 0;
}

}  // namespace obscura::evaluate
