// The measurements of a search: short flights through scenes, one per place and falloff (a leg), all loaded at once.
#pragma once

#include <memory>

#include "clock.h"
#include "flight.h"

namespace obscura::tune {

// Where a flight begins: "atrium@4", a scene and a time on its flythrough, or "FILE.json@4", a recorded path.
struct Place {
    std::string script;  // of flythrough::findScript()
    std::string text;
};
Place placeOf(const std::string& text, const char* option);  // throws app::Complaint

struct Leg {                         // measurements of one flight
    double eA = 0.0, flicker = 0.0;  // means over its frames
    double time = 0.0, bytes = 0.0;  // ms, sum of the passes' medians, bytes 0; or GPU cycles, bytes a pixel
};

class Course {
public:
    Course(measure::Machine& machine, const std::vector<Place>& places, const std::vector<measure::FalloffChoice>& falloffs,
        const flythrough::Settings& settings,
        CycleClock* clock = nullptr);              // clock: null for milliseconds; it and `falloffs` must outlive this
    bool countsCycles() const { return m_clock; }  // then the same candidate has the same time
    size_t size() const { return m_flights.size(); }
    const std::string& name(size_t leg) const { return m_names[leg]; }  // "atrium@4 quadratic:2"
    Leg fly(size_t leg, const measure::Candidate& candidate);
    std::string keyOf(const measure::Candidate& candidate) const;  // hash of everything that determines fly() except time

private:
    std::vector<std::unique_ptr<flythrough::Flight>> m_flights;
    std::vector<std::string> m_names;
    std::vector<const measure::FalloffChoice*> m_falloffs;  // of each flight
    CycleClock* m_clock;
};

// Ratios of a candidate to the hand-set preset, below 1 is better. Milliseconds of both are measured in turns, leg by leg. With cycles as
// the clock, bytes guard: what they grow by beyond 5 % counts as time.
struct Score {
    double error = 1.0, flicker = 1.0, time = 1.0;
    std::vector<double> errors, times;  // of each leg
};
Score score(Course& course, const measure::Candidate& candidate, const measure::Candidate& hand, const std::vector<Leg>& handLegs);

// The objective that a search minimises: error, with penalties for time and flicker above the limits (ratios to the hand-set preset).
struct Limits {
    double time = 1.0, flicker = 1.05;
};
double objective(const Score& score, const Limits& limits);

}  // namespace obscura::tune
