#include "app/page.h"

namespace obscura::app {
namespace {

void put(std::string& page, const std::string& mark, const std::string& content) {
    const size_t at = page.find(mark);
    if (at != std::string::npos) page.replace(at, mark.size(), content);
}

}  // namespace

std::string page(std::string html, const std::string& css, const std::string& script, std::string json) {
    for (size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
    put(html, "/*STYLE*/", css);
    put(html, "/*SCRIPT*/", script);
    put(html, "/*DATA*/", json);
    return html;
}

}  // namespace obscura::app
