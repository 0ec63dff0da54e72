#include "report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "ao/settings_text.h"
#include "app/files.h"
#include "scene/json_text.h"

namespace obscura::game {

namespace {

std::string escape(const std::string& text) {
    std::string out;
    for (const char c : scene::utf8(text)) {
        if (c == '<') out += "&lt;";
        else if (c == '>') out += "&gt;";
        else if (c == '&') out += "&amp;";
        else if (c == '"') out += "&quot;";
        else out += c;
    }
    return out;
}

std::string image(const app::Picture& picture, const std::string& caption) {
    // Halved to at most 1000 px of width, which keeps the page small; frames in full size are separate files.
    app::Picture shown = picture;
    while (shown.width > 1000) shown = shown.half();
    return fmt::format("<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        escape(caption), app::base64(app::encodePng(shown)));
}

constexpr const char* kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:72em;padding:0 1em;color:#222;background:#fff}"
    "figure{margin:0}.pair{display:grid;grid-template-columns:1fr 1fr;gap:.6em;margin-bottom:.6em}img{width:100%;display:block}"
    "figcaption{color:#666;font-size:.85em}table{border-collapse:collapse}td,th{padding:.15em 1em .15em 0;text-align:right}"
    "td:first-child,th:first-child{text-align:left}.bar{display:inline-block;height:.7em;background:#4a7fb5}"
    "dl{display:grid;grid-template-columns:max-content 1fr;gap:.1em 1em}dt{color:#666}dd{margin:0}";

std::string row(const app::Series& series, double longest) {
    const double median = series.median();
    return fmt::format(
        "<tr><td>{}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td style=\"text-align:left\"><span class=\"bar\" "
        "style=\"width:{:.1f}em\"></span></td></tr>\n",
        escape(series.name), median, series.p95(), series.worst(), longest > 0.0 ? 16.0 * median / longest : 0.0);
}

nlohmann::ordered_json numbers(const app::Series& series) {
    return {{"name", series.name}, {"median", series.median()}, {"p95", series.p95()}, {"worst", series.worst()}};
}

nlohmann::ordered_json parametersOf(const ao::Values& values) {
    nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
    for (const ao::Parameter& parameter : values.info().parameters) parameters[parameter.id] = values[parameter.id];
    return parameters;
}

std::string settingsText(const ao::Values& values) {
    std::string text = values.info().id;
    for (const ao::Parameter& parameter : values.info().parameters) text += fmt::format(" {}={:g}", parameter.id, values[parameter.id]);
    return text;
}

}  // namespace

std::string voxelFacts(const voxel::Voxels& voxels, const app::Statistics& times) {
    const voxel::Statistics v = voxels.statistics();
    const double mebi = 1.0 / (1024.0 * 1024.0);
    const auto spent = [&](std::string_view ending) {
        double sum = 0.0;
        bool any = false;
        for (const app::Series& pass : times.passes())
            if (pass.name.ends_with(ending)) sum += pass.median(), any = true;
        return any ? fmt::format("{:.2f} ms", sum) : std::string("none");
    };
    const std::string window = voxels.options().nano ? fmt::format("NanoVDB grid of {:.2f} MiB on the GPU", double(v.windowBytes) * mebi)
                                                     : fmt::format("{} levels of {} cells a side, {:.1f} MiB on the GPU",
                                                           voxels.options().levels, voxels.options().cells, double(v.windowBytes) * mebi);
    if (!voxels.options().bits)
        return fmt::format("voxels: {}, voxelized there every frame\nclear {}, rasterise {}, trace {}", window, spent("voxels.clear"),
            spent("voxels.rasterise"), spent(".trace"));
    const std::string rest =
        v.progress < 1.0f
            ? fmt::format("building, {:.0f} %", 100.0f * v.progress)
            : fmt::format("{} static cells in {:.2f} MiB of OpenVDB, {} in {:.0f} ms", v.resting.cells, double(v.resting.bytes) * mebi,
                  v.resting.fromCache > 0 && v.resting.rasterised == 0 ? "read from the cache" : "built", v.resting.milliseconds);
    return fmt::format(
        "voxels: {}\n{} moving objects of {} cells in {:.2f} MiB, {} rebuilt; worker {:.2f} ms, waited {:.2f} (worst {:.2f}), {} late\n{}, "
        "{:.1f} KiB in the last upload\n"
        "upload {}, trace {}",
        rest, v.objects, v.objectCells, double(v.objectBytes) * mebi, v.redone, v.workerMilliseconds, v.waitMilliseconds, v.worstWait,
        v.late, window, double(v.changedBytes) / 1024.0, spent("voxels.upload"), spent(".trace"));
}

std::string Report::table() const {
    size_t width = 20;
    for (const app::Series& pass : statistics.passes()) width = std::max(width, pass.name.size());
    std::string text = fmt::format(
        "{:<{}} {:>10} {:>10} {:>10}   ms, {} frames\n", "pass", width, "median", "p95", "worst", statistics.gpu().values.size());
    const auto line = [&](const app::Series& s, const std::string& name) {
        text += fmt::format("{:<{}} {:>10.3f} {:>10.3f} {:>10.3f}\n", name, width, s.median(), s.p95(), s.worst());
    };
    for (const app::Series& pass : statistics.passes()) line(pass, pass.name);
    line(statistics.gpu(), "= gpu frame");
    line(statistics.cpu(), "cpu, recording");
    line(statistics.frame(), "frame to frame");
    if (const voxel::Voxels* voxels = engine.renderer().voxels()) text += voxelFacts(*voxels, statistics) + "\n";
    return text;
}

void Report::write(const std::filesystem::path& folder) const {
    const render::SceneFacts facts = engine.renderer().facts();
    const gpu::Caps& caps = engine.device().caps();
    const double mebi = 1.0 / (1024.0 * 1024.0);
    const Choice& choice = options.choice;
    nlohmann::ordered_json passes = nlohmann::ordered_json::array();
    for (const app::Series& pass : statistics.passes()) passes.push_back(numbers(pass));
    nlohmann::ordered_json timings{
        {"device", caps.deviceName},
        {"software", caps.software},
        {"timestamps", caps.timestamps},
        {"scene", stage.info.name},
        {"method", choice.info().id},
        {"parameters", parametersOf(choice.values())},
        {"falloff", ao::falloffText(choice.falloff)},
        {"width", options.size.width},
        {"height", options.size.height},
        {"guard", options.guard},
        {"frames", frames},
        {"measured", statistics.gpu().values.size()},
        {"unit", "ms"},
        {"passes", passes},
        {"gpu", numbers(statistics.gpu())},
        {"cpu", numbers(statistics.cpu())},
        {"frame", numbers(statistics.frame())},
        {"memoryBytes", engine.device().memoryUse()},
        {"startSeconds", {{"device", engine.started.device}, {"scene", engine.started.scene}, {"pipelines", engine.started.pipelines},
                             {"warmUp", engine.started.warmUp}, {"pipelineCacheFound", engine.started.cacheFound}}},
    };
    if (options.compare)
        timings["compare"] = {
            {"method", options.compare->info().id}, {"parameters", parametersOf(options.compare->values())}, {"split", options.split}};
    app::writeFile(folder / "timings.json", scene::dump(timings, 2) + "\n");

    std::string page = fmt::format(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Obscura: {0}, {1}</title><style>{2}</style>\n<h1>{0}, {3}</h1>\n",
        escape(stage.info.title), choice.info().id, kStyle, escape(choice.info().title));
    for (const ReportPicture& picture : pictures) {
        page += "<div class=\"pair\">\n" + image(picture.final, fmt::format("frame {}, {:.2f} s", picture.frame, picture.time));
        page += image(picture.visibility, "visibility") + "</div>\n";
    }
    page += "<h2>Times</h2>\n<table><tr><th>pass</th><th>median</th><th>p95</th><th>worst, ms</th><th></th></tr>\n";
    double longest = 0.0;
    for (const app::Series& pass : statistics.passes()) longest = std::max(longest, pass.median());
    for (const app::Series& pass : statistics.passes()) page += row(pass, longest);
    for (const app::Series* total : {&statistics.gpu(), &statistics.cpu(), &statistics.frame()}) page += row(*total, 0.0);
    page += fmt::format(
        "</table>\n<p>gpu: first to last timestamp of a frame; cpu: recording and submitting; frame: from one to the next, writing "
        "of pictures included. {} frames, the first {} not timed.</p>\n<h2>Facts</h2>\n<dl>\n",
        frames, dropped);
    const std::pair<const char*, std::string> rows[] = {
        {"device", caps.deviceName},
        {"picture", fmt::format("{} x {}, guard band {:g}", options.size.width, options.size.height, options.guard)},
        {"method", settingsText(choice.values())},
        {"right of the divider", options.compare ? settingsText(options.compare->values()) : "no second method"},
        {"falloff", ao::falloffText(choice.falloff)},
        {"scene", stage.file},
        {"triangles", fmt::format("{} ({} drawn, {} draws)", facts.triangles, facts.drawn, facts.draws)},
        {"instances", fmt::format("{} ({} dropped toasters)", facts.instances, stage.toys->dropped())},
        {"memory", fmt::format("{:.1f} MiB on the device; textures {:.1f}, geometry {:.1f}", double(engine.device().memoryUse()) * mebi,
                       double(facts.textureBytes) * mebi, double(facts.geometryBytes) * mebi)},
        {"start", fmt::format("{:.2f} s: device {:.2f}, scene {:.2f}, pipelines {:.2f}, warm-up {:.2f}; pipeline cache {}",
                      engine.started.total(), engine.started.device, engine.started.scene, engine.started.pipelines, engine.started.warmUp,
                      engine.started.cacheFound ? "found" : "not found")},
        {"command", options.commandLine},
    };
    for (const auto& [term, text] : rows) page += fmt::format("<dt>{}</dt><dd>{}</dd>\n", term, escape(text));
    page += "</dl>\n</html>\n";
    app::writeFile(folder / "summary.html", page);
}

}  // namespace obscura::game
