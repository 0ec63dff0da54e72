// Frame and pass times of the last frames, for the overlay's plots and for reports.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "graph/graph.h"

namespace obscura::app {

// The value below which the fraction `rank` of the values lies (0.5: median); 0 without values.
double percentile(std::vector<double> values, double rank);
// Rounded to that many significant digits; six is the precision of float errors. Not finite: 0.
double digits(double value, int count = 6);

struct Series {
    std::string name;
    std::vector<double> values;  // milliseconds, oldest first
    double median() const { return percentile(values, 0.5); }
    double p95() const { return percentile(values, 0.95); }
    double worst() const { return percentile(values, 1.0); }
};
// The series of that name, appended if missing. Valid until another series is appended.
Series& named(std::vector<Series>& all, const std::string& name);

class Statistics {
public:
    explicit Statistics(size_t keep) : m_keep(keep) {}
    // Adds the timings of a frame; the same frame again is ignored.
    void add(const graph::Timings& timings);
    void addCpu(double recording, double frame);  // milliseconds
    void clear();

    // A frame that took far longer than the median before it, and the pass (or "recording", on the CPU) that grew most.
    struct Spike {
        double milliseconds = 0.0, median = 0.0;  // of the GPU's frame, or of recording
        std::string cause;
        double growth = 0.0;  // ms above the cause's own median
    };
    const std::deque<Spike>& spikes() const { return m_spikes; }  // the last ones, oldest first

    const std::vector<Series>& passes() const { return m_passes; }  // of the newest frame, in its order
    double total(std::string_view prefix) const;                    // sum of the medians of passes whose names start with `prefix`
    const Series& gpu() const { return m_gpu; }                     // first to last timestamp
    const Series& cpu() const { return m_cpu; }                     // recording and submitting
    const Series& frame() const { return m_frame; }                 // from one frame's begin to the next one's

private:
    void push(Series& series, double value) const;
    static bool isSpike(const Series& series, double value);
    void add(Spike spike);
    size_t m_keep;
    uint64_t m_last = 0;
    std::vector<Series> m_passes;
    std::deque<Spike> m_spikes;
    Series m_gpu{"gpu", {}}, m_cpu{"cpu", {}}, m_frame{"frame", {}};
};

}  // namespace obscura::app
