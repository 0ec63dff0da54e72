#include "app/statistics.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace obscura::app {

double percentile(std::vector<double> values, double rank) {
    if (values.empty()) return 0.0;
    const size_t index = std::min(values.size() - 1, size_t(rank * double(values.size())));
    std::nth_element(values.begin(), values.begin() + long(index), values.end());
    return values[index];
}

double digits(double value, int count) {
    if (value == 0.0 || !std::isfinite(value)) return 0.0;
    const double scale = std::pow(10.0, count - 1 - std::floor(std::log10(std::fabs(value))));
    return std::round(value * scale) / scale;
}

Series& named(std::vector<Series>& all, const std::string& name) {
    const auto known = std::find_if(all.begin(), all.end(), [&](const Series& s) { return s.name == name; });
    return known != all.end() ? *known : all.emplace_back(Series{name, {}});
}

void Statistics::push(Series& series, double value) const {
    if (series.values.size() >= m_keep) series.values.erase(series.values.begin());
    series.values.push_back(value);
}

bool Statistics::isSpike(const Series& series, double value) {
    constexpr size_t kKnown = 16;   // values that make a median
    constexpr double kLeast = 0.5;  // ms above the median
    if (series.values.size() < kKnown) return false;
    const double median = series.median();
    return value > 1.5 * median && value > median + kLeast;
}

void Statistics::add(Spike spike) {
    constexpr size_t kSpikes = 6;
    if (m_spikes.size() == kSpikes) m_spikes.pop_front();
    m_spikes.push_back(std::move(spike));
}

void Statistics::add(const graph::Timings& timings) {
    if (timings.passes.empty() || timings.frame == m_last) return;
    m_last = timings.frame;
    std::optional<Spike> spike;
    if (isSpike(m_gpu, timings.milliseconds)) spike = {timings.milliseconds, m_gpu.median(), "", 0.0};
    push(m_gpu, timings.milliseconds);
    std::vector<Series> passes;
    for (const gpu::PassTime& time : timings.passes) {
        // A pass may be declared several times in a frame (mip chains): their times add up.
        const auto again = std::find_if(passes.begin(), passes.end(), [&](const Series& s) { return s.name == time.name; });
        if (again != passes.end()) {
            again->values.back() += time.milliseconds;
            continue;
        }
        const auto known = std::find_if(m_passes.begin(), m_passes.end(), [&](const Series& s) { return s.name == time.name; });
        passes.push_back(known != m_passes.end() ? std::move(*known) : Series{time.name, {}});
        push(passes.back(), time.milliseconds);
    }
    if (spike) {
        for (const Series& pass : passes) {
            const double growth = pass.values.back() - (pass.values.size() > 1 ? pass.median() : 0.0);
            if (growth > spike->growth) spike->growth = growth, spike->cause = pass.name;
        }
        add(std::move(*spike));
    }
    m_passes = std::move(passes);
}

void Statistics::addCpu(double recording, double frame) {
    if (isSpike(m_cpu, recording)) add({recording, m_cpu.median(), "recording", recording - m_cpu.median()});
    push(m_cpu, recording);
    push(m_frame, frame);
}

double Statistics::total(std::string_view prefix) const {
    double sum = 0.0;
    for (const Series& pass : m_passes)
        if (pass.name.starts_with(prefix)) sum += pass.median();
    return sum;
}

void Statistics::clear() {
    m_passes.clear();
    m_gpu.values.clear();
    m_cpu.values.clear();
    m_frame.values.clear();
    m_spikes.clear();
}

}  // namespace obscura::app
