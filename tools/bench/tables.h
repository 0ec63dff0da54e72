// Results as Markdown: for a terminal, for bench.md, and for the README between its markers.
#pragma once

#include <filesystem>

#include "results.h"

namespace obscura::bench {

inline constexpr const char* kTableBegin = "<!-- bench: begin -->";
inline constexpr const char* kTableEnd = "<!-- bench: end -->";

// A table for each size and falloff: a row a candidate, cheapest first, a column of errors a scene.
std::string markdown(const Results& results);
// Everything: tables, where yardsticks are ahead, exponents.
std::string report(const Results& results);
// "Bavoil, Sainz, Dimitrov 2008" of "Bavoil, Sainz, Dimitrov: Image-Space Horizon-Based Ambient Occlusion, SIGGRAPH Talks 2008"; of several, each.
std::string citation(const std::string& paper);
// The first size's and falloff's, of default presets and of those that no other beats in both time and mean error; with what was measured,
// and with paper and inputs as the methods' registry tells them.
std::string briefTable(const Results& results);
// `text` with what stands between the markers replaced. Throws app::Complaint where it lacks them.
std::string withTable(const std::string& text, const std::string& table, const std::filesystem::path& file);

}  // namespace obscura::bench
