// Synthetic results for tests.
#pragma once

#include "results.h"

namespace obscura::bench {

inline Row row(const std::string& method, const std::string& settings, double ms, double eA, bool baseline = false) {
    Row r;
    r.scene = "court", r.camera = "own", r.falloff = "quadratic:2", r.method = method, r.preset = "default", r.settings = settings;
    r.width = 320, r.height = 180, r.baseline = baseline, r.triangles = 1000, r.reach = 2.0;
    r.median = ms, r.p95 = 1.2 * ms, r.rounds = {ms, 1.01 * ms, 0.99 * ms, 1.02 * ms, 0.98 * ms};
    r.passes = {{method + ".only", ms, 1.2 * ms}};
    r.bytes = 1000000;
    r.errors = {{"world", eA, 0.01, 1.2 * eA, 3.0 * eA, 0.9}};
    r.flicker = Flicker{0.004, 0.001};
    return r;
}

inline Results results(std::vector<Row> rows) {
    Results r;
    r.device = "device", r.command = "obscura-bench", r.frames = 5, r.rounds = 5, r.rays = 64;
    r.rows = std::move(rows);
    return r;
}

}  // namespace obscura::bench
