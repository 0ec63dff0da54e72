// Results as Markdown: for a terminal, for bench.md, and for the README between its markers.
#pragma once

#include <filesystem>

#include "results.h"

namespace obscura::bench {

// Markers of a file's tables: of briefTable() and of costTable().
struct Markers {
    const char *begin, *end;
};
inline constexpr Markers kTimes{"<!-- bench: begin -->", "<!-- bench: end -->"},
    kCosts{"<!-- gpu cost: begin -->", "<!-- gpu cost: end -->"};

// A table per size and falloff: one row per candidate, fastest first, one column of errors per scene.
std::string markdown(const Results& results);
// The whole report: tables, budgets at which baseline methods are ahead, exponents.
std::string report(const Results& results);
// "Bavoil, Sainz, Dimitrov 2008" of "Bavoil, Sainz, Dimitrov: Image-Space Horizon-Based Ambient Occlusion, SIGGRAPH Talks 2008"; of
// several, each.
std::string citation(const std::string& paper);
// The table of the first size and falloff: default presets and settings of the Pareto front of time and mean error, with a legend, and with
// papers and inputs from the registry.
std::string briefTable(const Results& results);
// The same by cycles on a GPU, cheapest first, with floors, registers and waves instead of times and memory.
std::string costTable(const Results& results);
// Cycles, error and flicker of every preset without own settings, of the first size and falloff, as JSON: what the game's menu shows.
std::string summary(const Results& results);
// `text` with the tables between its markers replaced; results: null to check it only. Throws app::Complaint if it has no markers, or those
// of costs and the results have none.
std::string withTables(const std::string& text, const Results* results, const std::filesystem::path& file);

}  // namespace obscura::bench
