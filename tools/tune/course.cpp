#include "course.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/arguments.h"
#include "app/complaint.h"
#include "app/content.h"
#include "scene/hash.h"
#include "scene/json_text.h"

namespace obscura::tune {

Place placeOf(const std::string& text, const char* option) {
    const size_t mark = text.rfind('@');
    const std::vector<float> at = mark == std::string::npos ? std::vector<float>() : app::numbers(text.substr(mark + 1), ',');
    if (at.size() != 1 || at[0] < 0.0f)
        throw app::Complaint(
            fmt::format("{} {}: write SCENE@SECONDS, a time on the scene's flythrough, or FILE.json@SECONDS", option, text));
    if (text.find(".json@") != std::string::npos) {
        flythrough::findScript(text);
        return {text, scene::utf8(text)};
    }
    const app::SceneFile file = app::expectScene(text.substr(0, mark));
    if (!file.flythrough) throw app::Complaint(fmt::format("{} {}: {} has no flythrough", option, text, file.info.name));
    return {fmt::format("{}@{:g}", file.flythrough->string(), at[0]), text};
}

Course::Course(measure::Machine& machine, const std::vector<Place>& places, const std::vector<measure::FalloffChoice>& falloffs,
    const flythrough::Settings& settings, CycleClock* clock)
    : m_clock(clock) {
    for (const Place& place : places)
        for (const measure::FalloffChoice& falloff : falloffs) {
            flythrough::Settings with = settings;
            with.falloff = falloff;
            m_flights.push_back(std::make_unique<flythrough::Flight>(machine, flythrough::findScript(place.script), with));
            if (!m_flights.back()->showsSurface())
                throw app::Complaint(fmt::format("{}: shows only sky, so there is no error to search by; name another place", place.text));
            m_names.push_back(place.text + " " + falloff.text);
            m_falloffs.push_back(&falloff);
        }
}

Leg Course::fly(size_t leg, const measure::Candidate& candidate) {
    const flythrough::Summary summary = summarize(m_flights[leg]->measure(candidate, flythrough::ownFilter(candidate)));
    if (!m_clock) return {summary.eA, summary.flickerOfError, summary.milliseconds, 0.0};
    const gpu_cost::MethodCost& cost = m_clock->costOf(candidate, *m_falloffs[leg]);
    return {summary.eA, summary.flickerOfError, cost.cycles, cost.bytes};
}

std::string Course::keyOf(const measure::Candidate& candidate) const {
    scene::Hash hash;
    hash.add(m_clock ? "cycles" : "ms");
    for (const auto& flight : m_flights) hash.add(flight->keyOf(candidate, *ao::findResolvePreset("spatial")));
    return hash.hex();
}

Score score(Course& course, const measure::Candidate& candidate, const measure::Candidate& hand, const std::vector<Leg>& handLegs) {
    Score result;
    constexpr double kBytes = 1.05;
    double logError = 0.0, logTime = 0.0, flicker = 0.0, handFlicker = 0.0;
    for (size_t leg = 0; leg < course.size(); ++leg) {
        const Leg &was = handLegs[leg], is = course.fly(leg, candidate),
                  then = course.countsCycles() ? was : course.fly(leg, hand);  // timed again, because the machine's speed drifts
        result.errors.push_back(is.eA / std::max(was.eA, 1e-6));
        result.times.push_back(std::max(is.time / std::max(then.time, 1e-6), then.bytes > 0.0 ? is.bytes / (then.bytes * kBytes) : 0.0));
        logError += std::log(std::max(result.errors.back(), 1e-6));
        logTime += std::log(std::max(result.times.back(), 1e-6));
        flicker += is.flicker, handFlicker += was.flicker;
    }
    const double legs = double(course.size());
    result.error = std::exp(logError / legs);
    result.time = std::exp(logTime / legs);
    constexpr double kFloor = 1e-4;  // F_e below this is invisible
    result.flicker = (flicker / legs + kFloor) / (handFlicker / legs + kFloor);
    return result;
}

double objective(const Score& score, const Limits& limits) {
    constexpr double kTimeWeight = 4.0, kFlickerWeight = 4.0;
    return score.error * (1.0 + kTimeWeight * std::max(0.0, score.time / limits.time - 1.0)) *
           (1.0 + kFlickerWeight * std::max(0.0, score.flicker / limits.flicker - 1.0));
}

}  // namespace obscura::tune
