#include "gallery.h"

#include "app/files.h"
#include "app/page.h"
#include "measure/false_colour.h"
#include "page.h"
#include "scene/json_text.h"

namespace obscura::evaluate {

namespace {

std::string dataUri(const truth::Plane& visibility) {
    return "data:image/png;base64," + app::base64(app::encodePng(measure::greyPicture(visibility)));
}

Json methodsJson(const Options& options) {
    Json list = Json::array();
    const ao::MethodInfo* last = nullptr;
    for (const measure::Candidate& candidate : options.candidates) {
        if (&candidate.info() == last) continue;
        last = &candidate.info();
        list.push_back({{"id", last->id}, {"title", last->title}, {"paper", last->paper}, {"sentence", last->sentence}});
    }
    return list;
}

// A row for the page; `label` and `drawn` select its picture.
Json shotJson(const ShotResult& shot, const Options& options, const About& about) {
    Json json;
    json["scene"] = shot.scene;
    json["camera"] = shot.camera;
    json["time"] = shot.time;
    json["size"] = {shot.size.x, shot.size.y};
    json["remark"] = shot.remark;
    json["references"] = Json::array();
    for (const measure::ShotReference& reference : shot.references)
        json["references"].push_back({{"kind", reference.kind}, {"falloff", reference.falloff}, {"rays", reference.rays},
            {"error", reference.error}, {"picture", dataUri(reference.visibility)}});
    json["drawn"] = Json::array();
    for (const Drawn& drawn : shot.drawn) {
        const measure::Candidate& candidate = options.candidates[drawn.candidate];
        json["drawn"].push_back({{"method", candidate.info().id}, {"label", candidate.label()},
            {"falloff", options.falloffs[drawn.falloff].text}, {"picture", dataUri(drawn.visibility)}});
    }
    json["rows"] = Json::array();
    for (const Row& row : shot.rows) {
        Json line = rowJson(shot, row, options, about);
        line["drawn"] = row.drawn;
        line["label"] = options.candidates[shot.drawn[row.drawn].candidate].label();
        json["rows"].push_back(std::move(line));
    }
    return json;
}

}  // namespace

std::string galleryPage(const std::vector<ShotResult>& shots, const Options& options, const About& about) {
    Json data;
    data["device"] = about.device;
    data["frames"] = about.frames;
    data["errorRange"] = measure::kErrorRange;
    data["methods"] = methodsJson(options);
    data["shots"] = Json::array();
    for (const ShotResult& shot : shots) data["shots"].push_back(shotJson(shot, options, about));

    return app::page({"Obscura: accuracy gallery", app::PageSource::Pictures::embedded, kPageHtml, kPageCss, kPageJs}, scene::dump(data));
}

}  // namespace obscura::evaluate
