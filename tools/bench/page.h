// The HTML report: files of page/, embedded by the build (page.cpp is generated), and the page made from them.
#pragma once

#include <string>

#include "results.h"

namespace obscura::bench {

extern const char* const kPageHtml;  // the body; app/page.h adds the head
extern const char* const kPageCss;
extern const char* const kPageJs;

// Fronts and scaling as one self-contained HTML file.
std::string benchPage(const Results& results);

}  // namespace obscura::bench
