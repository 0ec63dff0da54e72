// --switch-test: frame times right after a method switch, compared with steady frames.
#include <algorithm>

#include <fmt/format.h>

#include "app/progress.h"
#include "app/statistics.h"
#include "jobs.h"

namespace obscura::game {

namespace {

// Milliseconds of one frame from recording to the GPU's completion.
double wholeFrame(const Options& options, Engine& engine, Stage& stage, const ao::Values& values, float time) {
    const double begun = app::now();
    engine.expect(engine.frames().begin(engine.graph()), "testing switches");
    render::FrameOptions frame;
    frame.visible = options.size;
    frame.guard = options.guard;
    frame.camera = stage.camera(options.camera, time);
    frame.time = time;
    frame.method = &values;
    frame.falloff = options.choice.falloff;
    frame.exposure = options.exposure * stage.info.exposure;
    const render::Outputs outputs = engine.renderer().add(engine.graph(), stage.world, frame);
    engine.graph().output(outputs.color);
    engine.expect(engine.frames().end(engine.graph()), "testing switches");
    engine.expect(engine.frames().wait(), "testing switches");
    return app::now() - begun;
}

}  // namespace

void switchTest(const Options& options, Engine& engine, Stage& stage) {
    const uint32_t steady = *options.switchTest;
    const size_t methods = Choice::count();
    constexpr uint32_t kRounds = 4;
    std::vector<std::vector<double>> own(methods);  // steady frames
    std::vector<std::vector<double>> at(methods);   // frames at a switch
    std::vector<double> first(methods);             // first frames at this size, which allocate
    std::vector<ao::Values> values;
    for (const ao::MethodInfo* info : ao::methods()) values.emplace_back(*info);
    float time = options.time;
    {
        app::Progress progress("switching methods", methods * (steady + 2 + kRounds));
        size_t done = 0;
        for (size_t m = 0; m < methods; ++m)
            for (uint32_t i = 0; i < steady + 2; ++i, time += options.step) {
                const double ms = wholeFrame(options, engine, stage, values[m], time);
                if (i >= 2) own[m].push_back(ms);
                else first[m] = std::max(first[m], ms);
                progress.at(++done, values[m].info().id);
            }
        for (uint32_t round = 0; round < kRounds; ++round)
            for (size_t m = 0; m < methods; ++m, time += options.step) {
                at[m].push_back(wholeFrame(options, engine, stage, values[m], time));
                progress.at(++done, values[m].info().id);
            }
    }
    fmt::print("{:<20} {:>12} {:>12} {:>16} {:>12}\n", "method", "median, ms", "first", "worst at switch", "excess");
    std::vector<double> allSteady, allSwitches, excess;
    for (size_t m = 0; m < methods; ++m) {
        const double median = app::percentile(own[m], 0.5), worst = app::percentile(at[m], 1.0);
        fmt::print("{:<20} {:>12.3f} {:>12.3f} {:>16.3f} {:>12.3f}\n", values[m].info().id, median, first[m], worst, worst - median);
        allSteady.insert(allSteady.end(), own[m].begin(), own[m].end());
        allSwitches.insert(allSwitches.end(), at[m].begin(), at[m].end());
        excess.push_back(worst - median);
    }
    fmt::print("worst frame at a switch {:.3f} ms, median frame {:.3f} ms; at most {:.3f} ms over the method's own median\n",
        app::percentile(allSwitches, 1.0), app::percentile(allSteady, 0.5), app::percentile(excess, 1.0));
}

}  // namespace obscura::game
