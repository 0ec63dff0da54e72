#include "gpu_cost/report.h"

#include <cstdio>
#include <fstream>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/complaint.h"
#include "app/statistics.h"
#include "scene/json_text.h"

namespace obscura::gpu_cost {
namespace {

using Json = nlohmann::ordered_json;
using app::digits;

std::string geometryOf(const ao::Values& values) {
    const char* const kLayers[] = {"", "thickness", "thickness, second layer at half size", "thickness, second layer"};
    std::string text = kLayers[size_t(ao::layerModeOf(values))];
    if (values.info().needs & ao::kVolume) text += text.empty() ? "voxels" : ", voxels";
    return text;
}

}  // namespace

std::string Row::label() const { return fmt::format("{} {}{}{}", method, preset, settings.empty() ? "" : " ", settings); }

std::vector<Table> measure(gpu::Device& device, const Wanted& wanted, const std::function<void(size_t, size_t)>& progress) {
    gpu::ShaderLibrary shaders;
    shaders.add(ao::shaders());
    std::vector<Table> tables;
    size_t done = 0;
    for (const Chip* chip : wanted.chips) {
        std::string error;
        const std::unique_ptr<gpu::Device> compiler = compilerOf(*chip, error);
        if (!compiler) throw app::Complaint(fmt::format("--gpu-cost {}: {}", chip->id, error), app::kFailed);
        CostModel model(*compiler, *chip, shaders);
        Table table{chip->id, driverOf(*compiler), wanted.falloffText, wanted.width, wanted.height, {}};
        for (const Wanted::Candidate& c : wanted.candidates) {
            const Workload load = workloadOf(device, shaders, c.values, wanted.falloff, wanted.width, wanted.height);
            table.rows.push_back(
                {c.values.info().id, c.preset, c.settings, geometryOf(c.values), c.values.info().baseline, model.costOf(load)});
            progress(++done, wanted.chips.size() * wanted.candidates.size());
        }
        tables.push_back(std::move(table));
    }
    return tables;
}

std::string markdown(const Table& table) {
    const Chip& chip = *findChip(table.chip);
    std::string text = fmt::format(
        "{} ({}), compiled by {}, {}, {} x {} px:\n\n| method | preset | cycles | fetches | bytes | VGPRs | waves | spills | ms, "
        "arithmetic "
        "| ms, memory | geometry besides |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|---|\n",
        table.chip, chip.product, table.driver, table.falloff, table.width, table.height);
    for (const Row& row : table.rows) {
        double spills = 0;
        for (const PassCost& pass : row.cost.passes) spills += pass.spills;
        text += fmt::format("| {}{} | {} | {}{:.0f} | {:.1f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {:.3f} | {:.3f} | {} |\n", row.method,
            row.baseline ? " (baseline)" : "", row.preset + (row.settings.empty() ? "" : " " + row.settings), row.cost.loops ? "~" : "",
            row.cost.cycles, row.cost.fetches, row.cost.bytes, row.cost.registers, row.cost.waves, spills, row.cost.arithmeticMs,
            row.cost.memoryMs, row.geometry);
    }
    return text +
           "\ncycles: of a SIMD, for 64 pixels; ~: a loop is left whose count depends on the picture, and its weight is the compiler's "
           "guess. fetches, bytes: of a pixel. VGPRs and waves a SIMD: of the worst pass. ms: floors at the chip's data sheet.\n";
}

std::string csv(const std::vector<Table>& tables) {
    std::string text = "chip,driver,method,preset,settings,pass,shader,cycles,fetches,bytes,vgprs,spills,waves,lds_bytes,guessed,fitted\n";
    for (const Table& table : tables)
        for (const Row& row : table.rows)
            for (const PassCost& p : row.cost.passes)
                text += fmt::format("{},{},{},{},\"{}\",\"{}\",\"{}\",{:.1f},{:.2f},{:.2f},{:.0f},{:.0f},{:.0f},{:.0f},{},{}\n", table.chip,
                    table.driver, row.method, row.preset, row.settings, p.name, p.shader, p.cycles, p.fetches, p.bytes, p.registers,
                    p.spills, p.waves, p.sharedBytes, p.loops ? 1 : 0, p.fitted ? 1 : 0);
    return text;
}

std::string jsonText(const std::vector<Table>& tables) {
    Json all = Json::array();
    for (const Table& table : tables) {
        Json rows = Json::array();
        for (const Row& row : table.rows) {
            Json passes = Json::array();
            for (const PassCost& p : row.cost.passes)
                passes.push_back({{"name", p.name}, {"shader", p.shader}, {"cycles", digits(p.cycles, 5)},
                    {"fetches", digits(p.fetches, 5)}, {"bytes", digits(p.bytes, 5)}, {"vgprs", p.registers}, {"spills", p.spills},
                    {"waves", p.waves}, {"lds_bytes", p.sharedBytes}, {"guessed", p.loops}, {"fitted", p.fitted}});
            rows.push_back({{"method", row.method}, {"preset", row.preset}, {"settings", row.settings}, {"baseline", row.baseline},
                {"geometry", row.geometry}, {"cycles", digits(row.cost.cycles, 5)}, {"fetches", digits(row.cost.fetches, 5)},
                {"bytes", digits(row.cost.bytes, 5)}, {"vgprs", row.cost.registers}, {"waves", row.cost.waves},
                {"ms_arithmetic", digits(row.cost.arithmeticMs, 5)}, {"ms_memory", digits(row.cost.memoryMs, 5)}, {"passes", passes}});
        }
        all.push_back({{"chip", table.chip}, {"driver", table.driver}, {"falloff", table.falloff}, {"size", {table.width, table.height}},
            {"rows", rows}});
    }
    return scene::dump(all, 1) + "\n";
}

std::string baselineText(const std::vector<Table>& tables) {
    std::string text =
        "{\"about\": \"GPU cost of each pass, counted by the chip's compiler. Renew: obscura-bench --renew-gpu-cost THIS\",\n";
    text += " \"chips\": [\n";
    for (size_t t = 0; t < tables.size(); ++t) {
        text += fmt::format("  {{\"chip\": \"{}\", \"driver\": \"{}\", \"passes\": [\n", tables[t].chip, tables[t].driver);
        std::vector<std::string> lines;
        for (const Row& row : tables[t].rows)
            for (size_t i = 0; i < row.cost.passes.size(); ++i) {
                const PassCost& p = row.cost.passes[i];
                lines.push_back(
                    fmt::format("   {{\"row\": \"{}\", \"pass\": \"{} {}\", \"cycles\": {:.1f}, \"vgprs\": {:.0f}, \"waves\": {:.0f}, "
                                "\"spills\": {:.0f}}}",
                        row.label(), i, p.name, p.cycles, p.registers, p.waves, p.spills));
            }
        text += fmt::format("{}\n  ]}}{}\n", fmt::join(lines, ",\n"), t + 1 < tables.size() ? "," : "");
    }
    return text + " ]}\n";
}

Verdict compare(const std::vector<Table>& tables, const std::filesystem::path& baseline) {
    constexpr double kGrowth = 1.03, kLeast = 2.0;
    Verdict verdict;
    std::ifstream in(baseline, std::ios::binary);
    if (!in) throw app::Complaint(fmt::format("--check-gpu-cost {}: no such file", baseline.string()));
    try {
        const Json stored = Json::parse(in);
        for (const Table& table : tables) {
            const Json* of = nullptr;
            for (const Json& chip : stored.at("chips"))
                if (chip.at("chip") == table.chip) of = &chip;
            if (!of || of->at("driver") != table.driver) {
                verdict.incomparable = fmt::format("the baseline has {} of {}, this machine {}; other versions count differently",
                    table.chip, of ? of->at("driver").get<std::string>() : "nothing", table.driver);
                continue;
            }
            std::map<std::string, Json> known;
            for (const Json& pass : of->at("passes"))
                known[pass.at("row").get<std::string>() + ", " + pass.at("pass").get<std::string>()] = pass;
            for (const Row& row : table.rows)
                for (size_t i = 0; i < row.cost.passes.size(); ++i) {
                    const PassCost& p = row.cost.passes[i];
                    const std::string key = fmt::format("{}, {} {}", row.label(), i, p.name), name = fmt::format("{}: {}", table.chip, key);
                    if (!known.count(key)) {
                        verdict.missing.push_back(name);
                        continue;
                    }
                    ++verdict.compared;
                    const double cycles = known[key].at("cycles"), waves = known[key].at("waves"), spills = known[key].at("spills");
                    if (p.cycles > cycles * kGrowth && p.cycles > cycles + kLeast)
                        verdict.worse.push_back(fmt::format("{}: {:.0f} cycles, were {:.0f}", name, p.cycles, cycles));
                    if (p.waves < waves) verdict.worse.push_back(fmt::format("{}: {:.0f} waves a SIMD, were {:.0f}", name, p.waves, waves));
                    if (p.spills > spills)
                        verdict.worse.push_back(fmt::format("{}: spills {:.0f} registers, were {:.0f}", name, p.spills, spills));
                    if (p.cycles < cycles / kGrowth && p.cycles < cycles - kLeast)
                        verdict.better.push_back(fmt::format("{}: {:.0f} cycles, were {:.0f}", name, p.cycles, cycles));
                }
        }
    } catch (const Json::exception& e) {
        throw app::Complaint(fmt::format("--check-gpu-cost {}: not a baseline of GPU costs: {}", baseline.string(), e.what()));
    }
    return verdict;
}

}  // namespace obscura::gpu_cost
