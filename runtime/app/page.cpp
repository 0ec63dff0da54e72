#include "app/page.h"

namespace obscura::app {
namespace {

void fill(std::string& page, const std::string& placeholder, const std::string& content) {
    const size_t at = page.find(placeholder);
    if (at != std::string::npos) page.replace(at, placeholder.size(), content);
}

}  // namespace

std::string page(std::string html, const std::string& css, const std::string& script, std::string json) {
    for (size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
    fill(html, "/*STYLE*/", css);
    fill(html, "/*SCRIPT*/", script);
    fill(html, "/*DATA*/", json);
    return html;
}

}  // namespace obscura::app
