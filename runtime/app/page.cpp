#include "app/page.h"

namespace obscura::app {
namespace {

constexpr const char* kHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
)";

std::string policy(PageSource::Pictures pictures) {
    if (pictures == PageSource::Pictures::files) return "";
    const char* images = pictures == PageSource::Pictures::embedded ? " img-src data:;" : "";
    return std::string("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none';") + images +
           " style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n";
}

}  // namespace

std::string page(const PageSource& source, std::string json) {
    for (size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
    std::string html = kHead + policy(source.pictures);
    html.append("<title>").append(source.title).append("</title>\n<style>").append(source.css).append("</style>\n</head>\n<body>\n");
    html.append(source.body);
    html.append("<script type=\"application/json\" id=\"data\">").append(json).append("</script>\n");
    html.append("<script>").append(source.script).append("</script>\n</body>\n</html>\n");
    return html;
}

}  // namespace obscura::app
