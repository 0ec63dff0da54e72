#include "gpu_cost_job.h"

#include <cstdio>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "app/progress.h"
#include "gpu_cost/report.h"

namespace obscura::bench {
namespace {

std::vector<gpu_cost::Wanted::Candidate> candidatesOf(const Options& options) {
    std::vector<gpu_cost::Wanted::Candidate> candidates;
    for (const measure::Candidate& candidate : options.what.candidates)
        if (candidate.info().needs)
            candidates.push_back({candidate.values, candidate.preset, fmt::format("{}", fmt::join(candidate.settings, " "))});
    return candidates;
}

gpu_cost::Wanted wantedOf(const Options& options) {
    gpu_cost::Wanted wanted;
    std::vector<std::string> known;
    for (const gpu_cost::Chip& chip : gpu_cost::chips()) known.push_back(chip.id);
    for (const std::string& id : options.gpuCost) {
        const gpu_cost::Chip* chip = gpu_cost::findChip(id);
        if (!chip) throw app::Complaint(fmt::format("--gpu-cost {}: {}", id, app::choices(id, known)));
        wanted.chips.push_back(chip);
    }
    if (options.sizes.size() != 1 || options.what.falloffs.size() != 1)
        throw app::Complaint("--gpu-cost: takes one --size and one --falloff");
    wanted.falloff = options.what.falloffs.front().falloff;
    wanted.falloffText = options.what.falloffs.front().text;
    wanted.width = options.sizes.front().x;
    wanted.height = options.sizes.front().y;
    wanted.candidates = candidatesOf(options);
    return wanted;
}

void print(const char* what, const std::vector<std::string>& lines) {
    if (lines.empty()) return;
    fmt::print("{}:\n", what);
    for (const std::string& line : lines) fmt::print("  {}\n", line);
}

}  // namespace

void addGpuCosts(const Options& options, gpu::Device& device, Results& results) {
    constexpr const char* kChip = "navi21";
    gpu_cost::Wanted wanted;
    wanted.chips = {gpu_cost::findChip(kChip)};
    std::string error;
    if (!gpu_cost::compilerOf(*wanted.chips[0], error)) {
        fmt::print("GPU costs are left out: {}\n", error);
        return;
    }
    wanted.candidates = candidatesOf(options);
    app::Progress bar("gpu cost", options.what.falloffs.size() * wanted.candidates.size());
    size_t before = 0;
    for (const measure::FalloffChoice& falloff : options.what.falloffs) {
        wanted.falloff = falloff.falloff;
        wanted.falloffText = falloff.text;
        const gpu_cost::Table table = gpu_cost::measure(device, wanted, [&](size_t done, size_t) { bar.at(before + done); })[0];
        before += wanted.candidates.size();
        results.gpu = fmt::format("{} ({})", table.chip, wanted.chips[0]->product);
        results.gpuCompiler = table.driver;
        for (const gpu_cost::Row& counted : table.rows) {
            for (Row& row : results.rows)
                if (row.falloff == falloff.text && row.method == counted.method && row.preset == counted.preset &&
                    row.settings == counted.settings)
                    row.gpu = GpuCost{counted.cost.cycles, counted.cost.arithmeticMs, counted.cost.memoryMs, counted.cost.registers,
                        counted.cost.waves, counted.cost.loops, counted.geometry};
        }
    }
}

int countGpuCost(const Options& options) {
    const gpu_cost::Wanted wanted = wantedOf(options);
    if (!options.out.empty()) app::expectFolder(options.out);
    if (!options.renewGpuCost.empty()) app::expectWritable(options.renewGpuCost);
    std::string error;
    gpu::DeviceOptions how;
    how.name = options.what.device;
    const std::unique_ptr<gpu::Device> device = gpu::Device::create(how, error);
    if (!device) throw app::Complaint(fmt::format("no device: {}", app::oneLine(error)), app::kFailed);
    std::vector<gpu_cost::Table> tables;
    if (!options.checkGpuCost.empty())
        for (const gpu_cost::Chip* chip : wanted.chips)
            if (!gpu_cost::compilerOf(*chip, error)) {
                fmt::print("skipped: {}\n", error);
                return kNothingCompared;
            }
    {
        app::Progress bar("gpu cost", wanted.chips.size() * wanted.candidates.size());
        tables = gpu_cost::measure(*device, wanted, [&](size_t done, size_t) { bar.at(done); });
    }
    if (!options.renewGpuCost.empty()) {
        app::writeFile(options.renewGpuCost, gpu_cost::baselineText(tables));
        return 0;
    }
    if (!options.checkGpuCost.empty()) {
        const gpu_cost::Verdict verdict = gpu_cost::compare(tables, options.checkGpuCost);
        if (!verdict.incomparable.empty()) {
            fmt::print("skipped: {}\n", verdict.incomparable);
            return kNothingCompared;
        }
        print("cheaper than the baseline (renew it to keep that)", verdict.better);
        print("not in the baseline", verdict.missing);
        print("worse", verdict.worse);
        const std::string renew = fmt::format("obscura-bench --renew-gpu-cost {}", options.checkGpuCost.string());
        if (!verdict.passes()) fmt::print("failed. If this change is intended: {}\n", renew);
        else fmt::print("{} passes cost what the baseline says\n", verdict.compared);
        return verdict.passes() ? 0 : app::kFailed;
    }
    std::string text;
    for (const gpu_cost::Table& table : tables) text += gpu_cost::markdown(table) + "\n";
    app::writeFile(options.out / "gpu_cost.json", gpu_cost::jsonText(tables));
    app::writeFile(options.out / "gpu_cost.csv", gpu_cost::csv(tables));
    app::writeFile(options.out / "gpu_cost.md", text);
    std::fputs(text.c_str(), stdout);
    fmt::print("{}\n", (options.out / "gpu_cost.csv").string());
    return 0;
}

}  // namespace obscura::bench
