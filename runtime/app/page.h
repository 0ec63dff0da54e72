// Builds a self-contained HTML report: head, body, style, script and JSON data in one file.
#pragma once

#include <string>
#include <string_view>

namespace obscura::app {

struct PageSource {
    const char* title;
    // Where the page's pictures come from. The content security policy allows nothing else; it cannot name files of a folder that is opened
    // from disk, so a page with such files has none.
    enum class Pictures { none, embedded, files } pictures = Pictures::none;
    std::string_view body, css, script;  // what <body>, <style> and the last <script> contain
};

// The script finds `json` in the element with id "data". '<' is escaped in it, so that it cannot end that element.
std::string page(const PageSource& source, std::string json);

}  // namespace obscura::app
