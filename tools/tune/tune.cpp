#include "tune.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/files.h"
#include "app/progress.h"
#include "app/statistics.h"
#include "measure/draw.h"
#include "scene/hash.h"
#include "scene/json_text.h"
#include "search.h"
#include "space.h"

namespace obscura::tune {

using Json = nlohmann::ordered_json;
using app::digits;

namespace {

// A winner is real if its error is below kGain on the mean and nowhere above kLoss; kNoise: tolerance of times.
constexpr double kGain = 0.98, kLoss = 1.02, kNoise = 1.03;

std::string settingsOf(const measure::Candidate& candidate, const measure::Candidate& hand) {
    return fmt::format("{}", fmt::join(candidate.settings.begin() + ptrdiff_t(hand.settings.size()), candidate.settings.end(), " "));
}

Json toJson(const Score& score) {
    return {{"error", score.error}, {"flicker", score.flicker}, {"time", score.time}, {"errors", score.errors}, {"times", score.times}};
}
Score scoreOf(const Json& json) {
    return {json.at("error"), json.at("flicker"), json.at("time"), json.at("errors").get<std::vector<double>>(),
        json.at("times").get<std::vector<double>>()};
}

// All scores of a search by name, saved to a file, from which an interrupted search resumes.
class Log {
public:
    Log(std::filesystem::path file, std::string key, bool again) : m_file(std::move(file)), m_key(std::move(key)) {
        std::ifstream in(m_file, std::ios::binary);
        if (!in || again) return;
        try {
            const Json json = Json::parse(std::string(std::istreambuf_iterator<char>(in), {}));
            if (json.at("key") != m_key) return;
            for (const Json& line : json.at("scores")) m_scores.push_back({line.at("of"), scoreOf(line)});
        } catch (const Json::exception&) {
            m_scores.clear();
        }  // not a log of this program
    }
    const Score* find(const std::string& of) const {
        for (const auto& [name, score] : m_scores)
            if (name == of) return &score;
        return nullptr;
    }
    const Score& get(const std::string& of, const std::function<Score()>& measure) {
        if (const Score* known = find(of)) return *known;
        m_scores.push_back({of, measure()});
        Json json{{"key", m_key}, {"scores", Json::array()}};
        for (const auto& [name, score] : m_scores) {
            Json line{{"of", name}};
            line.update(toJson(score));
            json["scores"].push_back(std::move(line));
        }
        app::writeFile(m_file, scene::dump(json) + "\n");
        return m_scores.back().second;
    }

private:
    std::filesystem::path m_file;
    std::string m_key;
    std::vector<std::pair<std::string, Score>> m_scores;
};

std::vector<Leg> legsOf(Course& course, const measure::Candidate& hand) {
    std::vector<Leg> legs;
    for (size_t i = 0; i < course.size(); ++i) legs.push_back(course.fly(i, hand));  // warms up as well
    return legs;
}

// Errors and flicker are deterministic; times are medians over rounds.
Score again(Log& log, const std::string& what, Course& course, const measure::Candidate& candidate, const measure::Candidate& hand,
    const std::vector<Leg>& legs, uint32_t rounds, std::vector<double>* times = nullptr) {
    Score result;
    std::vector<double> all;
    for (uint32_t round = 0; round < rounds; ++round) {
        result = log.get(
            fmt::format("{} {}: {}", what, round, settingsOf(candidate, hand)), [&] { return score(course, candidate, hand, legs); });
        all.push_back(result.time);
    }
    result.time = app::percentile(all, 0.5);
    if (times) *times = all;
    return result;
}

}  // namespace

bool Tuned::real(const Limits& limits) const {
    std::map<std::string, std::pair<double, double>> scenes;  // sum of logarithms, count
    for (size_t i = 0; i < legs.size(); ++i) {
        auto& [sum, count] = scenes[legs[i].substr(0, legs[i].find('@'))];
        sum += std::log(std::max(heldOut.errors[i], 1e-6)), count += 1.0;
    }
    const bool nowhereWorse = std::all_of(
        scenes.begin(), scenes.end(), [](const auto& scene) { return std::exp(scene.second.first / scene.second.second) <= kLoss; });
    return nowhereWorse && heldOut.error <= kGain && heldOut.time <= limits.time * kNoise && heldOut.flicker <= limits.flicker * kNoise;
}

Tuned tune(const Options& options, const measure::Candidate& hand, Course& training, Course& heldOut) {
    Tuned result{hand, hand, {}, {}, {}, 1.0, 1.0, {}};
    const Space space(hand, options.parameters);
    scene::Hash key;
    key.add(training.keyOf(hand)).add(heldOut.keyOf(hand)).add(fmt::format("{}", fmt::join(options.parameters, ",")));
    Log log(options.out / (hand.fileName() + ".log.json"), key.hex(), options.again);

    const std::vector<Leg> legs = legsOf(training, hand);
    std::map<std::string, measure::Candidate> seen;
    {
        app::Progress progress("searching " + hand.label(), options.evaluations);
        search(space.start(), options.evaluations, options.seed, [&](const std::vector<double>& point) -> Answer {
            const measure::Candidate candidate = space.at(point);
            const std::string settings = settingsOf(candidate, hand);
            const Score found = log.get("trial: " + settings, [&] { return score(training, candidate, hand, legs); });
            const bool fresh = seen.try_emplace(settings, candidate).second;
            const double value = objective(found, options.limits);
            if (fresh) result.trials.push_back({settings, found, value});
            progress.at(result.trials.size(), settings);
            return {value, fresh};
        });
    }

    // Times are noisy, so the best settings and the hand-set preset are measured again.
    std::vector<const Trial*> order;
    for (const Trial& trial : result.trials) order.push_back(&trial);
    std::stable_sort(order.begin(), order.end(), [](const Trial* a, const Trial* b) { return a->objective < b->objective; });
    if (order.size() > options.finalists) order.resize(options.finalists);
    result.training.objective = objective({}, options.limits);
    for (const Trial* trial : order) {
        if (trial->settings.empty()) continue;
        const measure::Candidate& candidate = seen.at(trial->settings);
        const Score found = again(log, "final", training, candidate, hand, legs, options.rounds);
        const double value = objective(found, options.limits);
        if (value >= result.training.objective) continue;
        result.training = {trial->settings, found, value};
        result.best = candidate;
    }

    for (size_t i = 0; i < heldOut.size(); ++i) result.legs.push_back(heldOut.name(i));
    result.heldOut.errors.assign(heldOut.size(), 1.0);
    if (result.training.settings.empty()) return result;  // the hand-set preset is the best
    const std::vector<Leg> away = legsOf(heldOut, hand);
    std::vector<double> times;
    result.heldOut = again(log, "held out", heldOut, result.best, hand, away, options.rounds, &times);
    std::mt19937 random(options.seed);
    std::vector<double> medians;
    for (int i = 0; i < 2000; ++i) {
        std::vector<double> sample;
        for (size_t k = 0; k < times.size(); ++k) sample.push_back(times[random() % times.size()]);
        medians.push_back(app::percentile(sample, 0.5));
    }
    result.timeLow = app::percentile(medians, 0.025);
    result.timeHigh = app::percentile(medians, 0.975);
    return result;
}

std::string presetText(const measure::Candidate& candidate) {
    std::string text;
    for (const ao::Parameter& parameter : candidate.info().parameters) {
        const float value = candidate.values[parameter.id];
        if (value == parameter.initial) continue;
        text += fmt::format("{}{{\"{}\", {:g}{}}}", text.empty() ? "" : ", ", parameter.id, value, value == std::round(value) ? "" : "f");
    }
    return text;
}

std::string markdown(const Options& options, const std::vector<Tuned>& results) {
    std::string text = fmt::format(
        "# Searched settings\n\n    {}\n\nRatios to the hand-set preset, {}, geometric means; below 1 is better. A winner "
        "is *real* with at least 2 % less error on\n"
        "held-out places, nowhere 2 % more, at most {:g} times the time and {:g} times the flicker.\n\n"
        "| preset | trials | error, training | error, held out | time, held out | 95 % of it | flicker, held out | real | settings over "
        "the preset |\n"
        "|---|--:|--:|--:|--:|--:|--:|---|---|\n",
        options.command, options.cycles ? "time in GPU cycles" : "measured in turns", options.limits.time, options.limits.flicker);
    for (const Tuned& r : results)
        text += r.training.settings.empty()
                    ? fmt::format("| {} | {} | | | | | | no | nothing better found |\n", r.hand.label(), r.trials.size())
                    : fmt::format("| {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} to {:.3f} | {:.3f} | {} | {} |\n", r.hand.label(),
                          r.trials.size(), r.training.score.error, r.heldOut.error, r.heldOut.time, r.timeLow, r.timeHigh,
                          r.heldOut.flicker, r.real(options.limits) ? "yes" : "no", r.training.settings);
    text += "\nError of each held-out place:\n\n| preset |";
    if (!results.empty()) {
        std::string rule = "\n|---|";
        for (const std::string& leg : results.front().legs) text += fmt::format(" {} |", leg), rule += "--:|";
        text += rule + "\n";
    }
    for (const Tuned& r : results) {
        text += fmt::format("| {} |", r.hand.label());
        for (const double error : r.heldOut.errors) text += fmt::format(" {:.3f} |", error);
        text += "\n";
    }
    text += "\nAs presets:\n\n";
    for (const Tuned& r : results)
        if (r.real(options.limits)) text += fmt::format("    {}: {}\n", r.hand.label(), presetText(r.best));
    return text;
}

std::string jsonText(const Options& options, const std::vector<Tuned>& results) {
    Json json{{"command", options.command}, {"results", Json::array()}};
    for (const Tuned& r : results) {
        Json line{{"preset", r.hand.label()}, {"settings", r.training.settings}, {"values", presetText(r.best)},
            {"real", r.real(options.limits)}};
        line["training"] = toJson(r.training.score);
        line["heldOut"] = toJson(r.heldOut);
        line["heldOut"]["time95"] = {digits(r.timeLow), digits(r.timeHigh)};
        line["legs"] = r.legs;
        line["trials"] = Json::array();
        for (const Trial& t : r.trials)
            line["trials"].push_back({{"settings", t.settings}, {"error", digits(t.score.error)}, {"flicker", digits(t.score.flicker)},
                {"time", digits(t.score.time)}, {"objective", digits(t.objective)}});
        json["results"].push_back(std::move(line));
    }
    return scene::dump(json, 1) + "\n";
}

}  // namespace obscura::tune
