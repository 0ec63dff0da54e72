#include "compare.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/statistics.h"

namespace obscura::bench {

using app::percentile;

namespace {

using Rounds = std::vector<double>;

struct Pair {
    const Row* before;
    const Row* now;
    Rounds old, fresh;  // the compared values, one per round
    double ratio() const { return percentile(fresh, 0.5) / percentile(old, 0.5); }
};

// A scene's rounds as shares of their geometric mean over the rows.
void share(std::vector<Pair*>& rows, Rounds Pair::* side) {
    size_t rounds = ~size_t(0);
    for (const Pair* row : rows) rounds = std::min(rounds, (row->*side).size());
    for (size_t round = 0; round < rounds; ++round) {
        double mean = 0.0;
        for (const Pair* row : rows) mean += std::log((row->*side)[round]) / double(rows.size());
        for (Pair* row : rows) (row->*side)[round] /= std::exp(mean);
    }
    for (Pair* row : rows) (row->*side).resize(rounds);
}

Rounds drawn(const Rounds& rounds, std::mt19937& random) {
    Rounds sample(rounds.size());
    for (double& value : sample) value = rounds[random() % rounds.size()];
    return sample;
}

std::string dearestPass(const Row& before, const Row& now) {
    double most = 0.0;
    std::string text;
    for (const PassTime& pass : now.passes) {
        const auto was = std::find_if(before.passes.begin(), before.passes.end(), [&](const PassTime& p) { return p.name == pass.name; });
        const double old = was == before.passes.end() ? 0.0 : was->median;
        if (pass.median - old <= most) continue;
        most = pass.median - old;
        text = fmt::format("{} {:.3g} -> {:.3g} ms", pass.name, old, pass.median);
    }
    return text;
}

void expectAlike(const Results& before, const Results& now) {
    if (before.device != now.device)
        throw app::Complaint(fmt::format(
            "--compare: the old run used {}, this one {}; times are comparable only on the same device", before.device, now.device));
    for (const Results* side : {&before, &now})
        for (const Row& row : side->rows)
            if (row.rounds.size() < 3)
                throw app::Complaint(fmt::format(
                    "--compare: {} has {} rounds; a confidence interval needs 3 or more (--rounds)", row.name(), row.rounds.size()));
}

}  // namespace

bool Comparison::passes() const {
    return worse.empty() && missing.empty() && std::none_of(times.begin(), times.end(), [](const TimeChange& t) { return t.worse; });
}

Comparison compare(const Results& before, const Results& now, const Tolerances& tolerances) {
    expectAlike(before, now);
    Comparison result;
    std::vector<Pair> pairs;
    std::map<std::string, const Row*> fresh;
    for (const Row& row : now.rows) fresh[row.name()] = &row;
    for (const Row& row : before.rows) {
        const auto found = fresh.find(row.name());
        if (found == fresh.end()) result.missing.push_back(row.name());
        else pairs.push_back({&row, found->second, row.rounds, found->second->rounds});
    }
    if (pairs.empty())
        throw app::Complaint("--compare: the two runs have no row in common; run the command that bench.json names in \"command\"");
    result.added = now.rows.size() - pairs.size();

    for (const Pair& pair : pairs) {
        const std::string name = pair.now->name();
        const auto worse = [&](const std::string& what, double was, double is, double relative, double floor) {
            if (is - was > std::max(relative * was, floor))
                result.worse.push_back(fmt::format("{}: {} {:.5g}, was {:.5g}", name, what, is, was));
        };
        for (const ErrorRow& was : pair.before->errors)
            if (const ErrorRow* is = pair.now->against(was.reference))
                worse("eA against " + was.reference, was.eA, is->eA, tolerances.error, tolerances.errorFloor);
        if (pair.before->flicker && pair.now->flicker)
            worse(
                "flicker of error", pair.before->flicker->ofError, pair.now->flicker->ofError, tolerances.flicker, tolerances.flickerFloor);
        worse("MB of memory", double(pair.before->bytes) * 1e-6, double(pair.now->bytes) * 1e-6, tolerances.memory, 0.0);
    }

    std::erase_if(
        pairs, [](const Pair& pair) { return !pair.now->drawsObscurance() || !(pair.before->median > 0.0) || !(pair.now->median > 0.0); });
    std::vector<double> all;
    std::map<std::string, std::vector<Pair*>> scenes;
    for (Pair& pair : pairs) {
        all.push_back(pair.ratio());
        scenes[pair.now->scene].push_back(&pair);
    }
    result.drift = all.empty() ? 1.0 : percentile(all, 0.5);
    std::map<std::string, double> centre;
    for (auto& [scene, rows] : scenes) {
        centre[scene] = 1.0;
        if (tolerances.absolute || rows.size() < 2) continue;
        share(rows, &Pair::old);
        share(rows, &Pair::fresh);
        std::vector<double> ratios;
        for (const Pair* row : rows) ratios.push_back(row->ratio());
        centre[scene] = percentile(ratios, 0.5);
    }
    std::mt19937 random(1);
    for (const Pair& pair : pairs) {
        TimeChange change;
        change.name = pair.now->name();
        change.ratio = pair.ratio() / centre[pair.now->scene];
        std::vector<double> ratios;
        for (uint32_t i = 0; i < tolerances.resamples; ++i)
            ratios.push_back(
                percentile(drawn(pair.fresh, random), 0.5) / percentile(drawn(pair.old, random), 0.5) / centre[pair.now->scene]);
        change.low = percentile(ratios, 0.5 - 0.5 * tolerances.confidence);
        change.high = percentile(ratios, 0.5 + 0.5 * tolerances.confidence);
        change.worse = change.low > 1.0 + tolerances.time;
        change.better = change.high < 1.0 / (1.0 + tolerances.time);
        if (change.worse) change.dearest = dearestPass(*pair.before, *pair.now);
        result.times.push_back(std::move(change));
    }
    return result;
}

std::string comparisonText(const Comparison& c, const Tolerances& tolerances) {
    std::string text = fmt::format("time over the old run's, {}, {:g} % interval over rounds:\n",
        tolerances.absolute ? "in milliseconds" : "as shares of each scene's rounds", 100.0 * tolerances.confidence);
    size_t worse = 0;
    for (const TimeChange& t : c.times) {
        worse += t.worse;
        text += fmt::format("  {:6.3f}  [{:.3f}, {:.3f}]  {}{}\n", t.ratio, t.low, t.high, t.name,
            t.worse    ? fmt::format("  SLOWER{}", t.dearest.empty() ? "" : ": " + t.dearest)
            : t.better ? "  faster"
                       : "");
    }
    text += fmt::format("  {:6.3f}  all rows in milliseconds: speed of the machine, or passes that all methods share\n", c.drift);
    for (const std::string& line : c.worse) text += "  WORSE  " + line + "\n";
    for (const std::string& line : c.missing) text += "  MISSING  " + line + "\n";
    if (c.added) text += fmt::format("  {} rows are new\n", c.added);
    text += c.passes() ? fmt::format("passed: {} rows, none slower by more than {:g} % beyond noise, none worse\n", c.times.size(),
                             100.0 * tolerances.time)
                       : fmt::format("failed: {} of {} rows slower, {} worse in error, flicker or memory, {} missing\n", worse,
                             c.times.size(), c.worse.size(), c.missing.size());
    return text;
}

}  // namespace obscura::bench
