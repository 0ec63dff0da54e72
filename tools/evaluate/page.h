// The gallery's page/ files, embedded by the build (page.cpp is generated).
#pragma once

namespace obscura::evaluate {

extern const char* const kPageHtml;  // the body; app/page.h adds the head
extern const char* const kPageCss;
extern const char* const kPageJs;

}  // namespace obscura::evaluate
