// Data of the benchmark's page as JSON.
#include "app/page.h"
#include "front.h"
#include "page.h"
#include "scaling.h"
#include "scene/json_text.h"

namespace obscura::bench {

std::string benchPage(const Results& results) {
    Json data = Json::parse(jsonText(results));
    for (size_t i = 0; i < results.rows.size(); ++i) data["rows"][i]["label"] = results.rows[i].label();
    data["fronts"] = Json::array();
    for (const Front& front : fronts(results)) {
        Json line{{"scene", front.scene}, {"camera", front.camera}, {"falloff", front.falloff}, {"reference", front.reference},
            {"size", {front.width, front.height}}, {"rows", front.rows}, {"line", front.line}, {"both", front.both},
            {"gaps", Json::array()}};
        for (const Gap& gap : front.gaps) line["gaps"].push_back(gapText(gap, results, front.reference));
        data["fronts"].push_back(std::move(line));
    }
    data["fits"] = Json::array();
    for (const Fit& fit : fits(results))
        data["fits"].push_back({{"axis", fit.axis}, {"label", fit.label}, {"where", fit.where}, {"x", fit.x}, {"y", fit.y},
            {"exponent", fit.exponent}, {"error", fit.error}, {"factor", fit.factor}});
    return app::page({"Obscura: error against cost", app::PageSource::Pictures::none, kPageHtml, kPageCss, kPageJs}, scene::dump(data));
}

}  // namespace obscura::bench
