// Results as one self-contained HTML page: pictures against references with a slider, error pictures, a sortable table,
// charts. Needs no network and no other file.
#pragma once

#include "report.h"

namespace obscura::evaluate {

std::string galleryPage(const std::vector<ShotResult>& shots, const Options& options, const About& about);

}  // namespace obscura::evaluate
