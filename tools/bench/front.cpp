#include "front.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace obscura::bench {

namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

void fill(Front& front, const Results& results) {
    const auto time = [&](size_t row) { return results.rows[row].median; };
    const auto error = [&](size_t row) { return row == Gap::kNone ? kEndless : results.rows[row].against(front.reference)->eA; };
    std::stable_sort(front.rows.begin(), front.rows.end(),
        [&](size_t a, size_t b) { return time(a) < time(b) || (time(a) == time(b) && error(a) < error(b)); });
    size_t best = Gap::kNone, ours = Gap::kNone, baseline = Gap::kNone;
    size_t baselines = 0;
    for (size_t i = 0; i < front.rows.size(); ++i) {
        const size_t row = front.rows[i];
        if (error(row) < error(best)) front.line.push_back(best = row);
        baselines += results.rows[row].baseline;
        size_t& side = results.rows[row].baseline ? baseline : ours;
        if (error(row) < error(side)) side = row;
        const double next = i + 1 < front.rows.size() ? time(front.rows[i + 1]) : kEndless;
        if (next == time(row) || !(error(baseline) < error(ours))) continue;
        if (!front.gaps.empty() && front.gaps.back().to == time(row) && front.gaps.back().baseline == baseline &&
            front.gaps.back().ours == ours)
            front.gaps.back().to = next;
        else front.gaps.push_back({time(row), next, baseline, ours});
    }
    front.both = baselines > 0 && baselines < front.rows.size();
    if (!front.both) front.gaps.clear();
}

}  // namespace

std::string Front::title() const { return fmt::format("{} {} {}x{} {}, {}", scene, camera, width, height, falloff, reference); }

std::vector<Front> fronts(const Results& results) {
    std::vector<Front> list;
    for (size_t i = 0; i < results.rows.size(); ++i) {
        const Row& row = results.rows[i];
        if (!row.drawsObscurance() || !(row.median > 0.0)) continue;
        for (const ErrorRow& error : row.errors) {
            auto front = std::find_if(list.begin(), list.end(), [&](const Front& f) {
                return f.scene == row.scene && f.camera == row.camera && f.falloff == row.falloff && f.reference == error.reference &&
                       f.width == row.width && f.height == row.height;
            });
            if (front == list.end())
                front = list.insert(
                    list.end(), {row.scene, row.camera, row.falloff, error.reference, row.width, row.height, {}, {}, {}, false});
            front->rows.push_back(i);
        }
    }
    for (Front& front : list) fill(front, results);
    return list;
}

std::string gapText(const Gap& gap, const Results& results, const std::string& reference) {
    const auto what = [&](size_t row) {
        return fmt::format(
            "{} ({:.4f} in {:.2f} ms)", results.rows[row].label(), results.rows[row].against(reference)->eA, results.rows[row].median);
    };
    const std::string budget =
        std::isinf(gap.to) ? fmt::format("from {:.2f} ms on", gap.from) : fmt::format("from {:.2f} to {:.2f} ms", gap.from, gap.to);
    return fmt::format("{} {} is ahead of {}", budget, what(gap.baseline),
        gap.ours == Gap::kNone ? std::string("all of ours: none is within budget") : what(gap.ours));
}

}  // namespace obscura::bench
