#include "scaling.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

namespace obscura::bench {

namespace {

// A row's value on an axis, and label and shared properties that select its line. An empty label: the row is not on this axis.
struct At {
    std::string label, where;
    double x = 0.0;
};

std::string size(const Row& r) { return fmt::format("{}x{}", r.width, r.height); }
std::string kind(const Row& r) { return r.falloff.substr(0, r.falloff.find(':')); }
// "balls-10000" -> "balls": generated scenes look alike at every number of triangles.
bool generated(const Row& r) { return r.scene.starts_with("balls-"); }

// The label without the varied parameters.
std::string bare(const Row& r) {
    std::string text = r.method;
    if (r.preset != "default") text += " " + r.preset;
    for (size_t at = 0; at < r.settings.size();) {
        const size_t end = std::min(r.settings.find(' ', at), r.settings.size());
        const std::string setting = r.settings.substr(at, end - at), name = setting.substr(0, setting.find('='));
        if ((" " + r.varied + " ").find(" " + name + " ") == std::string::npos) text += " " + setting;
        at = end + 1;
    }
    return text;
}

At onPixels(const Row& r) { return {r.label(), fmt::format("{} {} {}", r.scene, r.camera, r.falloff), double(r.width) * r.height}; }
At onRadius(const Row& r) { return {r.label(), fmt::format("{} {} {} {}", r.scene, r.camera, size(r), kind(r)), r.reach}; }
At onTriangles(const Row& r) {
    return {generated(r) ? r.label() : "", fmt::format("balls {} {} {}", r.camera, size(r), r.falloff), double(r.triangles)};
}
At onSamples(const Row& r) {
    return {r.samples > 0.0 ? bare(r) : "", fmt::format("{} {} {} {}", r.scene, r.camera, size(r), r.falloff), r.samples};
}

}  // namespace

void fit(Fit& line) {
    const double n = double(line.x.size());
    double mx = 0.0, my = 0.0, xx = 0.0, xy = 0.0, rest = 0.0;
    for (size_t i = 0; i < line.x.size(); ++i) mx += std::log(line.x[i]) / n, my += std::log(line.y[i]) / n;
    for (size_t i = 0; i < line.x.size(); ++i) {
        const double dx = std::log(line.x[i]) - mx;
        xx += dx * dx, xy += dx * (std::log(line.y[i]) - my);
    }
    line.exponent = xy / xx;
    line.factor = std::exp(my - line.exponent * mx);
    for (size_t i = 0; i < line.x.size(); ++i) {
        const double miss = std::log(line.y[i]) - my - line.exponent * (std::log(line.x[i]) - mx);
        rest += miss * miss;
    }
    line.error = std::sqrt(rest / (n - 2.0) / xx);
}

std::vector<Fit> fits(const Results& results) {
    const struct {
        const char* axis;
        At (*at)(const Row&);
    } axes[] = {{"pixels", onPixels}, {"radius", onRadius}, {"triangles", onTriangles}, {"samples", onSamples}};
    std::vector<Fit> list;
    for (const auto& axis : axes) {
        std::map<std::pair<std::string, std::string>, std::map<double, std::pair<double, double>>> lines;  // x -> sum of log y, count
        std::map<std::string, std::string> varied;
        for (const Row& row : results.rows) {
            const At at = axis.at(row);
            if (at.label.empty() || !row.drawsObscurance() || !(row.median > 0.0) || !(at.x > 0.0)) continue;
            auto& [sum, count] = lines[{at.where, at.label}][at.x];
            sum += std::log(row.median), count += 1.0;
            varied[at.label] = row.varied;
        }
        for (const auto& [key, points] : lines) {
            if (points.size() < 3) continue;
            Fit line;
            line.axis = axis.at == onSamples ? varied[key.second] : axis.axis;
            std::replace(line.axis.begin(), line.axis.end(), ' ', 'x');
            line.where = key.first, line.label = key.second;
            for (const auto& [x, sum] : points) line.x.push_back(x), line.y.push_back(std::exp(sum.first / sum.second));
            fit(line);
            list.push_back(std::move(line));
        }
    }
    return list;
}

}  // namespace obscura::bench
