// The report's page/ files, embedded by the build (page.cpp is generated), and the page they make.
#pragma once

#include <string>

#include "results.h"

namespace obscura::bench {

extern const char* const kPageHtml;  // with the marks /*STYLE*/, /*SCRIPT*/ and /*DATA*/
extern const char* const kPageCss;
extern const char* const kPageJs;

// Fronts and scaling as one self-contained HTML file.
std::string benchPage(const Results& results);

}  // namespace obscura::bench
