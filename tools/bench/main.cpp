// Entry point of obscura-bench: parses the command line, runs the job, writes the results; a failure is one line and an exit code.
#include <cstdio>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "bench.h"
#include "compare.h"
#include "gpu_cost_job.h"
#include "page.h"
#include "tables.h"

namespace obscura::bench {
namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw app::Complaint(fmt::format(
            "--table {}: no such file; name a Markdown file with the lines {} and {}", file.string(), kTimes.begin, kTimes.end));
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

int run(int argc, char** argv) {
    const auto options = parseOptions(argc, argv);
    if (!options) return 0;
    if (!options->gpuCost.empty()) return countGpuCost(*options);
    // Files are checked before anything is measured.
    if (!options->table.empty()) withTables(textOf(options->table), nullptr, options->table), app::expectWritable(options->table);
    if (!options->summary.empty()) app::expectWritable(options->summary);
    std::optional<Results> before;
    if (!options->compare.empty()) before = readResults(options->compare);

    int code = 0;
    Results results;
    if (!options->from.empty()) {
        results = readResults(options->from);
    } else {
        measure::expectScenes(options->what);
        app::expectFolder(options->out);
        measure::Machine machine({options->what.device, options->what.validation, options->what.verbose});
        results = measure(*options, machine);
        if (options->withGpuCost) addGpuCosts(*options, machine.device(), results);
        if (machine.device().validationMessages()) code = app::kInvalidUse;
    }
    if (!options->out.empty()) {
        app::expectFolder(options->out);
        app::writeFile(options->out / "bench.json", jsonText(results));
        app::writeFile(options->out / "bench.csv", csv(results));
        app::writeFile(options->out / "passes.csv", passesCsv(results));
        app::writeFile(options->out / "bench.md", report(results));
        app::writeFile(options->out / "bench.html", benchPage(results));
        std::fputs(markdown(results).c_str(), stdout);
        fmt::print("{}\n", (options->out / "bench.html").string());
    }
    if (!options->table.empty()) app::writeFile(options->table, withTables(textOf(options->table), &results, options->table));
    if (!options->summary.empty()) app::writeFile(options->summary, summary(results));
    if (before) {
        Tolerances tolerances;
        tolerances.time = options->tolerance;
        tolerances.absolute = options->absolute;
        const Comparison comparison = compare(*before, results, tolerances);
        std::fputs(comparisonText(comparison, tolerances).c_str(), stdout);
        if (!comparison.passes()) code = app::kFailed;
    }
    return code;
}

}  // namespace
}  // namespace obscura::bench

int main(int argc, char** argv) {
    return obscura::app::guarded("obscura-bench", [&] { return obscura::bench::run(argc, argv); });
}
