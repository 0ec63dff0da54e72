// Results as Markdown: for a terminal, for bench.md, and for the README between its markers.
#pragma once

#include <filesystem>

#include "results.h"

namespace obscura::bench {

inline constexpr const char* kTableBegin = "<!-- bench: begin -->";
inline constexpr const char* kTableEnd = "<!-- bench: end -->";

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
// `text` with the lines between the markers replaced. Throws app::Complaint if it has no markers.
std::string withTable(const std::string& text, const std::string& table, const std::filesystem::path& file);

}  // namespace obscura::bench
