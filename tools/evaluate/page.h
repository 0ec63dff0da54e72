// The gallery's page/ files, embedded by the build (page.cpp is generated).
#pragma once

namespace obscura::evaluate {

extern const char* const kPageHtml;  // contains the placeholders /*STYLE*/, /*SCRIPT*/ and /*DATA*/
extern const char* const kPageCss;
extern const char* const kPageJs;

}  // namespace obscura::evaluate
