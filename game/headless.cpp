// Rendering without a window: pictures, times and a summary.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <span>

#include <fmt/format.h>

#include "ao/view.h"
#include "app/complaint.h"
#include "app/files.h"
#include "app/progress.h"
#include "jobs.h"
#include "measures.h"
#include "recording.h"
#include "report.h"

namespace obscura::game {

namespace fs = std::filesystem;

namespace {

constexpr uint32_t kSettling = 3;        // frames at the start that are not timed
constexpr uint32_t kReportPictures = 4;  // in summary.html

// Frames shown in summary.html: the first, the last, and evenly spaced ones between.
std::vector<uint32_t> reportFrames(uint32_t frames) {
    std::vector<uint32_t> list;
    const uint32_t count = std::min(frames, kReportPictures);
    for (uint32_t i = 0; i < count; ++i) list.push_back(count == 1 ? 0 : i * (frames - 1) / (count - 1));
    return list;
}

// A depth of render::Outputs::linearDepth is not sky.
bool hasSurface(std::span<const std::byte> depths) {
    for (size_t at = 0; at + sizeof(float) <= depths.size(); at += sizeof(float)) {
        float depth;
        std::memcpy(&depth, depths.data() + at, sizeof depth);
        if (depth < ao::kSkyDepth) return true;
    }
    return false;
}

void expectPass(const Options& options, const graph::Graph& graph) {
    if (options.view != render::View::pass) return;
    std::vector<std::string> names;
    for (const graph::Graph::Written& written : graph.written()) {
        if (written.pass == options.passView) return;
        if (std::find(names.begin(), names.end(), written.pass) == names.end()) names.push_back(written.pass);
    }
    throw app::Complaint(fmt::format("--view pass:{}: no such pass; {}", options.passView, app::choices(options.passView, names)));
}

}  // namespace

int reportValidation(const Options& options, Engine& engine) {
    if (options.validation == "off") return 0;
    const uint64_t count = engine.device().validationMessages();
    fmt::print("validation: {} message{}\n", count, count == 1 ? "" : "s");
    return count ? app::kInvalidUse : 0;
}

std::vector<const ao::MethodInfo*> preparedMethods(const Options& options) {
    if (options.switchTest) return {ao::methods().begin(), ao::methods().end()};
    return {&options.choice.info()};
}

int runHeadless(const Options& options) {
    // Outputs, scene and camera are checked before the slow start-up.
    if (!options.out.empty()) app::expectFolder(options.out);  // may hold the screenshot
    if (!options.screenshot.empty()) app::expectWritable(options.screenshot);
    Stage stage(options.scene, options.bare, options.animation);
    stage.camera(options.camera, options.time);
    const bool replay = options.camera.replay;
    const float start = replay ? options.camera.start.value_or(stage.pathOf(options.camera.file).keys.front().time) : options.time;
    const auto timeAt = [&](uint32_t frame) { return replay ? replayTime(start, frame) : start + float(frame) * options.step; };
    for (const std::string& remark : stage.remarks) fmt::print(stderr, "obscura: {}\n", remark);
    stage.dropToys(options.toys, options.time);

    Engine engine(options, nullptr);
    engine.prepare(options, stage, preparedMethods(options));
    if (options.verbose)
        fmt::print(stderr,
            "obscura: {}: started in {:.2f} s (device {:.2f}, scene {:.2f}, pipelines {:.2f}, warm-up {:.2f}; pipeline cache {})\n",
            engine.device().caps().deviceName, engine.started.total(), engine.started.device, engine.started.scene,
            engine.started.pipelines, engine.started.warmUp, engine.started.cacheFound ? "found" : "not found");
    if (options.switchTest) {
        switchTest(options, engine, stage);
        return reportValidation(options, engine);
    }

    const uint32_t frames = options.frames.value_or(replay ? replayFrames(stage.pathOf(options.camera.file), start) : 1);
    app::Statistics statistics(1u << 20);
    Report report{options, engine, stage, statistics, frames, frames > kSettling ? kSettling : 0, {}};
    const std::vector<uint32_t> shown = options.out.empty() ? std::vector<uint32_t>() : reportFrames(frames);
    for (const uint32_t frame : shown) report.pictures.push_back({frame, timeAt(frame), {}, {}});

    bool showsSurface = true;  // the first frame
    const auto measures = options.measure ? std::make_shared<Measures>(0) : nullptr;
    graph::Graph& graph = engine.graph();
    {
        app::Progress progress("rendering", frames);
        double last = app::now();
        uint64_t firstMeasured = 0;
        for (uint32_t i = 0; i < frames; ++i) {
            engine.expect(engine.frames().begin(graph), "waiting for a frame");
            engine.capture().collect();
            if (i == report.dropped) firstMeasured = engine.device().frame();
            if (i >= report.dropped && graph.timings().frame >= firstMeasured) statistics.add(graph.timings());

            const float time = timeAt(i);
            render::FrameOptions frame;
            frame.visible = options.size;
            frame.guard = options.guard;
            frame.camera = stage.camera(options.camera, time);
            frame.time = time;
            frame.method = &options.choice.values();
            frame.falloff = options.choice.falloff;
            frame.compare = options.compare ? &options.compare->values() : nullptr;
            frame.split = options.split;
            frame.differenceRange = options.differenceRange;
            frame.view = options.view;
            frame.passView = options.passView;
            frame.exposure = options.exposure * stage.info.exposure;
            frame.bentNormals = options.bentNormals;
            frame.antialiasing = options.antialiasing;
            frame.cut = i == 0;
            frame.skipMasked = options.skipMasked;
            frame.voxels = options.voxels;
            frame.sampleStep = measures ? measuredStep(options.size) : 0;
            frame.slice = options.slice;
            stage.toys->advance(time, nullptr, true);
            const render::Outputs outputs = engine.renderer().add(graph, stage.world, frame);
            if (i == 0) {
                expectPass(options, graph);
                engine.expect(engine.capture().addRaw(graph, outputs.linearDepth,
                                  [&](std::span<const std::byte> depths) { showsSurface = hasSurface(depths); }),
                    "reading depth back");
            }
            if (measures)
                engine.expect(
                    readInto(measures, engine.capture(), graph, outputs, measuredFrame(frame, stage.world, i)), "reading samples back");
            graph.output(outputs.color);

            const auto place = std::find(shown.begin(), shown.end(), i);
            ReportPicture* picture = place == shown.end() ? nullptr : &report.pictures[size_t(place - shown.begin())];
            const bool isLast = i + 1 == frames;
            if (!options.out.empty() || (isLast && !options.screenshot.empty()))
                engine.expect(engine.capture().add(graph, outputs.color,
                                  [&options, i, picture, isLast](app::Picture&& done) {
                                      if (!options.out.empty()) app::writePng(options.out / fmt::format("frame_{:04}.png", i), done);
                                      if (isLast && !options.screenshot.empty()) app::writePng(options.screenshot, done);
                                      if (picture) picture->final = std::move(done);
                                  }),
                    "reading the picture back");
            if (picture)
                engine.expect(engine.capture().add(
                                  graph, outputs.visibility, [picture](app::Picture&& done) { picture->visibility = std::move(done); }),
                    "reading visibility back");
            engine.expect(engine.frames().end(graph), "rendering");
            if (i >= report.dropped) statistics.addCpu(engine.frames().recordMilliseconds(), app::now() - last);
            last = app::now();
            progress.at(i + 1);
        }
        engine.expect(engine.frames().wait(), "finishing the last frame");
        engine.capture().collect(true);
        // A frame's timestamps are read when its slot among the frames in flight is used again.
        for (uint32_t i = 0; i < engine.device().framesInFlight(); ++i) {
            engine.expect(engine.frames().begin(graph), "finishing");
            if (graph.timings().frame >= firstMeasured) statistics.add(graph.timings());
            engine.expect(engine.frames().end(graph), "finishing");
        }
    }
    if (!showsSurface)
        fmt::print(stderr, "obscura: the first frame shows only sky; choose another view with --camera, or --eye and --target\n");
    if (measures) measures->finish();
    if (measures && !options.out.empty()) app::writeFile(options.out / "measures.csv", csv(measures->all()));
    if (!options.out.empty()) {
        report.write(options.out);
        fmt::print("{}: {} pictures, summary.html, timings.json\n", options.out.string(), frames);
    }
    const std::string methods = options.compare ? fmt::format("{} | {}", label(options.choice.values()), label(options.compare->values()))
                                                : options.choice.info().id;
    fmt::print("{}, {} at {} x {}, {}\n{}", stage.info.name, methods, options.size.width, options.size.height,
        engine.device().caps().deviceName, report.table());
    if (measures) fmt::print("{}", summary(measures->all()));
    return reportValidation(options, engine);
}

int runWithoutWindow(const Options& given, const std::string& why) {
    Options options = given;
    options.job = Job::headless;
    options.noPresent = true;
    if (options.camera.kind == CameraChoice::Kind::scene) options.camera.kind = CameraChoice::Kind::flythrough;
    constexpr uint32_t kFrames = 24;
    if (!options.frames && !options.camera.replay) {
        // 24 frames cover the whole flythrough.
        options.frames = kFrames;
        options.step = 0.4f;
    }
    if (options.out.empty()) options.out = "out";
    fmt::print(
        stderr, "obscura: {}; rendering the flythrough without a window, pictures and summary go to {}/\n", why, options.out.string());
    return runHeadless(options);
}

}  // namespace obscura::game
