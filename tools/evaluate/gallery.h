// Results as one self-contained HTML page: pictures and references with a slider, error pictures, a sortable table, charts.
// It loads no other file.
#pragma once

#include "report.h"

namespace obscura::evaluate {

std::string galleryPage(const std::vector<ShotResult>& shots, const Options& options, const About& about);

}  // namespace obscura::evaluate
