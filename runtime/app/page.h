// A report as one file that any browser opens: a page with its style, its script and its data inside.
#pragma once

#include <string>

namespace obscura::app {

// `html` holds the marks /*STYLE*/, /*SCRIPT*/ and /*DATA*/, each once. The data are JSON, escaped so that no tag in them ends the script.
std::string page(std::string html, const std::string& css, const std::string& script, std::string json);

}  // namespace obscura::app
