// Builds a self-contained HTML report: page, style, script and JSON data in one file.
#pragma once

#include <string>

namespace obscura::app {

// `html` has the placeholders /*STYLE*/, /*SCRIPT*/ and /*DATA*/ once each. '<' is escaped in the JSON, so that it cannot end the script.
std::string page(std::string html, const std::string& css, const std::string& script, std::string json);

}  // namespace obscura::app
