#include "tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <utility>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/statistics.h"
#include "front.h"
#include "obscura/ao.h"
#include "scaling.h"
#include "scene/json_text.h"

namespace obscura::bench {

namespace {

template <class T>
void addNew(std::vector<T>& list, const T& value) {
    if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
}

// One candidate over all shots of a size with a falloff.
struct Line {
    std::string label, method, preset;
    bool plain = false, baseline = false, best = false;  // default preset; best: on the Pareto front
    double logTime = 0.0, p95 = 0.0, bytes = 0.0, world = 0.0, screen = 0.0, flicker = 0.0;
    size_t rows = 0, worlds = 0, screens = 0, flickers = 0;
    bool timed = true;
    std::optional<GpuCost> gpu;
    std::vector<std::string> scenes;  // cells, in the order of the columns
    double milliseconds() const { return timed ? std::exp(logTime / double(rows)) : 0.0; }
};

struct Table {
    std::string size, falloff;
    std::vector<std::string> places;  // "sponza", with camera where there are several
    std::vector<Line> lines;
};

std::vector<Table> tablesOf(const Results& results) {
    std::vector<std::string> cameras;
    for (const Row& row : results.rows) addNew(cameras, row.camera);
    const auto placeOf = [&](const Row& row) { return cameras.size() > 1 ? row.scene + " " + row.camera : row.scene; };
    std::vector<Table> tables;
    for (const Row& row : results.rows) {
        const std::string size = fmt::format("{} x {}", row.width, row.height);
        auto table = std::find_if(tables.begin(), tables.end(), [&](const Table& t) { return t.size == size && t.falloff == row.falloff; });
        if (table == tables.end()) table = tables.insert(tables.end(), {size, row.falloff, {}, {}});
        addNew(table->places, placeOf(row));
    }
    for (Table& table : tables)
        for (const Row& row : results.rows) {
            if (fmt::format("{} x {}", row.width, row.height) != table.size || row.falloff != table.falloff) continue;
            auto line = std::find_if(table.lines.begin(), table.lines.end(), [&](const Line& l) { return l.label == row.label(); });
            if (line == table.lines.end()) {
                line = table.lines.insert(table.lines.end(), Line{row.label(), row.method, row.settings.empty() ? row.preset : "",
                                                                 row.preset == "default" && row.settings.empty(), row.baseline});
                line->scenes.assign(table.places.size(), "");
            }
            ++line->rows;
            line->timed = line->timed && row.drawsObscurance() && row.median > 0.0;
            if (line->timed) line->logTime += std::log(row.median);
            line->p95 = std::max(line->p95, row.median > 0.0 ? row.p95 / row.median : 0.0);
            line->bytes = std::max(line->bytes, double(row.bytes));
            const size_t column = size_t(std::find(table.places.begin(), table.places.end(), placeOf(row)) - table.places.begin());
            if (const ErrorRow* e = row.against("world"))
                line->world += e->eA, ++line->worlds, line->scenes[column] = fmt::format("{:.4f}", e->eA);
            if (const ErrorRow* e = row.against("screen")) line->screen += e->eA, ++line->screens;
            if (row.gpu) line->gpu = row.gpu;
            if (row.flicker) line->flicker += row.flicker->ofError, ++line->flickers;
        }
    for (Table& table : tables) {
        std::stable_sort(
            table.lines.begin(), table.lines.end(), [](const Line& a, const Line& b) { return a.milliseconds() < b.milliseconds(); });
        double best = std::numeric_limits<double>::infinity();
        for (Line& line : table.lines) {
            const double error = line.worlds ? line.world / double(line.worlds) : 0.0;
            line.best = line.timed && line.worlds && error < best;
            if (line.best) best = error;
        }
    }
    return tables;
}

std::string mean(double sum, size_t count) { return count ? fmt::format("{:.4f}", sum / double(count)) : ""; }

// Required inputs, and optional ones in brackets.
std::string inputsOf(const ao::MethodInfo& info) {
    std::string text;
    const auto add = [&](const std::string& word) { text += (text.empty() ? "" : ", ") + word; };
    const struct {
        ao::Needs need;
        const char* word;
    } words[] = {
        {ao::kDepth, "depth"}, {ao::kNormals, "normals"}, {ao::kMotion, "motion"}, {ao::kLayers, "layers"}, {ao::kVolume, "voxels"}};
    for (const auto& [need, word] : words)
        if (info.needs & need) add(word);
    for (const ao::Parameter& parameter : info.parameters)
        if (parameter.id == std::string("depth_layers")) add("(layers)");
    return text;
}

// "paper | inputs" of a line; no paper beside variants of a method.
std::string originOf(const Line& line) {
    const ao::MethodInfo* info = ao::findMethod(line.method.c_str());
    return fmt::format("{} | {}",
        !info || !line.plain             ? ""
        : info->paper[0] || !info->needs ? citation(info->paper)
                                         : "our own",
        info ? inputsOf(*info) : "");
}

std::string tableText(const Table& table, bool brief) {
    std::string text = brief ? "| method | paper | inputs | ms | p95 | MB |" : "| method | ms | p95 | MB |",
                rule = brief ? "|---|---|---|--:|--:|--:|" : "|---|--:|--:|--:|";
    for (const std::string& place : table.places) text += fmt::format(" eA {} |", place), rule += "--:|";
    text += " eA screen | F_e |\n" + rule + "--:|--:|\n";
    for (const Line& line : table.lines) {
        if (brief && !line.plain && !line.best) continue;
        const std::string name = line.best ? fmt::format("**{}**", line.label) : line.label;
        text += fmt::format("| {}{} |", name, line.baseline ? " (baseline)" : "");
        if (brief) text += fmt::format(" {} |", originOf(line));
        text += fmt::format(" {:.2f} | {:.2f} | {:.1f} |", line.milliseconds(), line.p95, line.bytes * 1e-6);
        for (const std::string& cell : line.scenes) text += fmt::format(" {} |", cell);
        text += fmt::format(" {} | {} |\n", mean(line.screen, line.screens), mean(line.flicker, line.flickers));
    }
    return text;
}

// Breaks lines at spaces, so that none has more than 140 columns.
std::string wrapped(std::string text) {
    constexpr size_t kColumns = 140;
    for (size_t line = 0; text.size() - line > kColumns;) {
        const size_t space = text.rfind(' ', line + kColumns);
        if (space == std::string::npos || space <= line) break;
        text[space] = '\n';
        line = space + 1;
    }
    return text;
}

std::string legend(const Results& r) {
    std::string flicker;
    if (r.flickerFrames)
        flicker = fmt::format(" F_e: flicker of error over {} frames of each scene's flythrough at {} x {}, mean.", r.flickerFrames,
            r.flickerWidth, r.flickerHeight);
    const std::string text = fmt::format(
        "ms: median time of the method's own passes, geometric mean over the scenes, {} rounds of {} frames in turns after {} for warm-up; "
        "p95: 95th percentile over the median, the worst scene's; MB: device memory beyond the frame's own. eA: mean absolute error of "
        "visibility against rays through the scene's triangles, {} a pixel; eA screen: against rays through the depth buffer, mean over "
        "the scenes.{} Bold: no other is both faster and more accurate, on the mean of the scenes. {}; compare times only inside the "
        "table. (layers): read where `depth_layers` says so. Missing normals are reconstructed; any method but `hybrid` takes voxels with "
        "`offscreen`, and motion with `temporal`.",
        r.rounds, r.frames, r.warmUp, r.rays, flicker, r.device);
    return wrapped(text) + "\n";
}

}  // namespace

std::string citation(const std::string& paper) {
    std::string text;
    for (size_t at = 0; at < paper.size();) {
        const size_t end = std::min(paper.find(';', at), paper.size());
        std::string one = paper.substr(at, end - at);
        at = end + 1;
        one.erase(0, one.find_first_not_of(' '));
        static const std::regex kTitled("([^:]*):.*( (19|20)[0-9][0-9])\\b.*");
        std::smatch parts;
        if (std::regex_match(one, parts, kTitled)) one = parts[1].str() + parts[2].str();
        text += (text.empty() ? "" : "; ") + one;
    }
    return text;
}

std::string markdown(const Results& results) {
    std::string text;
    for (const Table& table : tablesOf(results))
        text += fmt::format("{}**{}, {} px**\n\n{}", text.empty() ? "" : "\n", table.falloff, table.size, tableText(table, false));
    return text;
}

std::string report(const Results& results) {
    std::string text = fmt::format("# Time, error, flicker and memory of ambient-obscurance methods\n\n    {}\n\n{}\n{}", results.command,
        legend(results), markdown(results));
    const char* head = "\n## Fronts\n\nTime budgets at which a baseline method has less error than the best of ours within budget.\n\n";
    for (const Front& front : fronts(results)) {
        if (!front.both) continue;
        text += std::exchange(head, "");
        if (front.gaps.empty()) text += fmt::format("- {}: none; one of ours has the least error at every budget\n", front.title());
        for (const Gap& gap : front.gaps) text += fmt::format("- {}: {}\n", front.title(), gapText(gap, results, front.reference));
    }
    const std::vector<Fit> lines = fits(results);
    if (lines.empty()) return text;
    text +=
        "\n## Scaling\n\ntime = factor x^exponent, least squares over logarithms, with the exponent's standard error.\n\n"
        "| x | from | to | method | where | exponent |\n|---|--:|--:|---|---|--:|\n";
    for (const Fit& line : lines)
        text += fmt::format("| {} | {:g} | {:g} | {} | {} | {:.2f} ± {:.2f} |\n", line.axis, line.x.front(), line.x.back(), line.label,
            line.where, line.exponent, line.error);
    return text;
}

std::string briefTable(const Results& results) {
    const std::vector<Table> tables = tablesOf(results);
    if (tables.empty()) throw app::Complaint("--table: nothing was measured, so there is no table");
    return fmt::format("{}, {} px, default presets and the best of all:\n\n{}\n{}\n    {}\n", tables.front().falloff, tables.front().size,
        tableText(tables.front(), true), legend(results), results.command);
}

std::string costTable(const Results& results) {
    std::vector<Table> tables = tablesOf(results);
    if (tables.empty() || results.gpu.empty())
        throw app::Complaint("--table: the results have no GPU costs; measure again where Mesa's RADV is installed, without --no-gpu-cost");
    Table& table = tables.front();
    std::erase_if(table.lines, [](const Line& line) { return !line.gpu; });
    std::stable_sort(table.lines.begin(), table.lines.end(), [](const Line& a, const Line& b) { return a.gpu->cycles < b.gpu->cycles; });
    std::string text = fmt::format("{}, compiled by {}, {}, default presets and the best of all:\n\n", results.gpu, results.gpuCompiler,
                           table.falloff) +
                       "| method | paper | inputs | cycles | ms, arithmetic | ms, memory | VGPRs | waves |",
                rule = "|---|---|---|--:|--:|--:|--:|--:|";
    for (const std::string& place : table.places) text += fmt::format(" eA {} |", place), rule += "--:|";
    text += " eA screen | F_e |\n" + rule + "--:|--:|\n";
    double best = std::numeric_limits<double>::infinity();
    for (const Line& line : table.lines) {
        const double error = line.worlds ? line.world / double(line.worlds) : best;
        const bool front = error < best;
        if (front) best = error;
        if (!line.plain && !front) continue;
        text += fmt::format("| {}{} | {} | {}{:.0f} | {:.2f} | {:.2f} | {:.0f} | {:.0f} |",
            front ? fmt::format("**{}**", line.label) : line.label, line.baseline ? " (baseline)" : "", originOf(line),
            line.gpu->guessed ? "~" : "", line.gpu->cycles, line.gpu->arithmeticMs, line.gpu->memoryMs, line.gpu->registers,
            line.gpu->waves);
        for (const std::string& cell : line.scenes) text += fmt::format(" {} |", cell);
        text += fmt::format(" {} | {} |\n", mean(line.screen, line.screens), mean(line.flicker, line.flickers));
    }
    return text + "\n" +
           wrapped(fmt::format(
               "cycles: of a SIMD, for 64 pixels, all compute passes; ~: with the compiler's guess of how often some loops run. ms: the "
               "least that a frame of 1920 x 1080 can take by arithmetic, and by memory if caches are perfect; a real GPU takes more. "
               "Geometry of depth layers and voxels comes on top. VGPRs, waves a SIMD: of the worst pass. eA: mean absolute error of "
               "visibility against rays through the scene's triangles, {} a pixel, at {} px; eA screen: against rays through the depth "
               "buffer, mean over the scenes. F_e: flicker of error over {} frames of each scene's flythrough. Bold: no other is both "
               "cheaper and more accurate. (layers): read where `depth_layers` says so. Missing normals are reconstructed; any method but "
               "`hybrid` takes voxels with `offscreen`, and motion with `temporal`.",
               results.rays, table.size, results.flickerFrames)) +
           "\n";
}

std::string summary(const Results& results) {
    const std::vector<Table> tables = tablesOf(results);
    if (tables.empty()) throw app::Complaint("--summary: nothing was measured");
    Table table = tables.front();
    std::sort(table.lines.begin(), table.lines.end(), [](const Line& a, const Line& b) { return a.label < b.label; });
    Json list = Json::array();
    for (const Line& line : table.lines) {
        if (line.preset.empty() || !line.worlds) continue;
        Json entry{{"method", line.method}, {"preset", line.preset}, {"eA", app::digits(line.world / double(line.worlds), 3)}};
        if (line.flickers) entry["flicker"] = app::digits(line.flicker / double(line.flickers), 3);
        if (line.gpu) entry["cycles"] = std::round(line.gpu->cycles);
        list.push_back(entry);
    }
    const Json all{{"about", "Shown by the game's menu of methods. Renew: tools/renew"}, {"scenes", table.places}, {"size", table.size},
        {"falloff", table.falloff}, {"chip", results.gpu}, {"methods", list}};
    return scene::dump(all, 1) + "\n";
}

std::string withTables(const std::string& text, const Results* results, const std::filesystem::path& file) {
    std::string made = text;
    bool found = false;
    const auto replace = [&](const Markers& markers, std::string (*table)(const Results&)) {
        const size_t begin = made.find(markers.begin), end = made.find(markers.end);
        if (begin == std::string::npos || end == std::string::npos || end < begin) return;
        found = true;
        if (results) made = made.substr(0, begin) + markers.begin + "\n" + table(*results) + made.substr(end);
    };
    replace(kTimes, briefTable);
    replace(kCosts, costTable);
    if (!found)
        throw app::Complaint(
            fmt::format("--table {}: has no markers; put the lines {} and {} where a table of times belongs, {} and {} for GPU costs",
                file.string(), kTimes.begin, kTimes.end, kCosts.begin, kCosts.end));
    return made;
}

}  // namespace obscura::bench
