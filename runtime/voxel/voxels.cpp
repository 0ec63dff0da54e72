#include "voxel/voxels.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <exception>

#include "voxel/objects.h"
#include "voxel/window.h"
#include "voxel/worker.h"

namespace obscura::voxel {
namespace {

using Clock = std::chrono::steady_clock;
double millisecondsSince(Clock::time_point start) { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }

constexpr std::chrono::microseconds kMaxWait(900);  // 100 us of the promised 1 ms are left for waking up
constexpr std::chrono::milliseconds kProgressInterval(100);

}  // namespace

struct Voxels::Impl {
    explicit Impl(Options o) : options(std::move(o)), window(options.cells), picked{options.masked} {}

    const Options options;

    // Owned by the worker between post() and done(), else by the caller.
    scene::World world;
    float time = 0.0f;
    glm::vec3 eye{0.0f};
    Resting resting;
    Objects objects;
    Window window;
    Picked picked;
    Sparse composed;             // static geometry and objects; with options.nano
    std::vector<uint32_t> grid;  // of `composed`
    bool failed = false;         // static geometry could not be built: logged once, tried again when it changes
    std::vector<std::string> lines;
    double stepMilliseconds = 0.0;

    // Owned by the caller.
    Change change;
    bool resendAll = false;
    uint64_t sentGrid = 0;  // bytes of the newest grid
    Statistics statistics;
    std::atomic<float> progress{1.0f};
    bool reportedEnd = true;  // of building, to options.progress
    Worker worker;            // last member: its thread ends before the others are destroyed

    void reportProgress();
    void composeGrid(std::span<const glm::ivec3> changed, bool all, const Window::Compose& compose);
    void step();
    void collect();
};

void Voxels::Impl::reportProgress() {
    const float now = progress;
    if (options.progress && (now < 1.0f || !reportedEnd)) options.progress(now);
    reportedEnd = now >= 1.0f;
}

void Voxels::Impl::composeGrid(std::span<const glm::ivec3> changed, bool all, const Window::Compose& compose) {
    if (all) composed = resting.sparse().copy();
    bool differs = all;
    for (const glm::ivec3& place : changed) {
        Brick brick;
        compose(place, brick);
        differs = composed.put(place, brick) || differs;
    }
    if (differs) grid = composed.nano();
}

// One frame, on the worker's thread.
void Voxels::Impl::step() {
    bool rebuilt = false;
    if (!resting.holds(world, picked)) {
        Resting::Options build;
        build.cells = options.cells;
        build.cellSize = options.cellSize;
        build.picked = picked;
        build.shell = options.shell;
        build.bits = options.bits;
        build.cache = options.cache;
        build.mostBricks = options.mostBricks;
        build.say = [this](const std::string& line) { lines.push_back(line); };
        build.progress = &progress;
        progress = 0.0f;
        failed = false;
        try {
            resting.build(world, time, build);
        } catch (const std::exception& error) {
            failed = true;
            lines.push_back(error.what());
        }
        progress = 1.0f;
        objects.clear();
        rebuilt = true;
    }
    if (failed) return;
    const scene::Bounds& bounds = resting.bounds();
    const glm::ivec3 origin = windowOrigin(options.cells, resting.cellSize(), bounds.min, bounds.max, eye);
    if (!options.bits) return window.place(origin);
    const Clock::time_point begun = Clock::now();
    std::vector<glm::ivec3> changed;
    objects.begin();
    std::vector<Part> parts;
    for (const scene::Instance& instance : world.instances()) {
        if (!instance.model) continue;
        parts = partsOf(instance, picked);
        std::erase_if(parts, [&](const Part& part) { return resting.contains(instance.id, part); });
        objects.add(instance, parts);
    }
    objects.end(time, resting.cellSize(), picked, options.shell, changed, [this](const std::string& line) { lines.push_back(line); });
    const auto compose = [this](const glm::ivec3& place, Brick& out) {
        resting.sparse().find(place, out);
        objects.compose(place, out);
    };
    if (options.nano) {
        window.place(origin);
        composeGrid(changed, rebuilt, compose);
    } else {
        window.update(origin, changed, rebuilt, compose);
    }
    stepMilliseconds = millisecondsSince(begun);
}

void Voxels::Impl::collect() {
    for (const std::string& line : lines)
        if (options.say) options.say(line);
    lines.clear();
    change.addresses.clear();
    change.bricks.clear();
    change.cells = failed || resting.cellSize() == 0.0 ? 0 : options.cells;
    if (change.cells == 0) return;
    change.cellSize = resting.cellSize();
    change.origin = window.origin() * kBrickSide;
    change.grid.clear();
    if (options.nano) {
        if (!grid.empty()) sentGrid = grid.size() * sizeof(uint32_t);
        change.grid.swap(grid);
    } else {
        change.addresses = window.takeChanged(resendAll);
    }
    change.bricks.reserve(change.addresses.size());
    for (const uint32_t address : change.addresses) change.bricks.push_back(window[address]);
    resendAll = false;

    statistics.resting = resting.facts();
    statistics.objects = objects.count();
    statistics.redone = objects.redone();
    statistics.objectCells = objects.cells();
    statistics.objectBytes = objects.bytes();
    statistics.windowBytes = options.nano ? sentGrid : uint64_t(options.cells) * options.cells * options.cells / 8;
    statistics.changedBytes = change.bricks.size() * sizeof(Brick) + change.grid.size() * sizeof(uint32_t);
    statistics.workerMilliseconds = stepMilliseconds;
}

Voxels::Voxels(Options options) {
    options.cells = std::bit_ceil(std::clamp(options.cells, 64u, 512u));
    m_impl = std::make_unique<Impl>(std::move(options));
}
Voxels::~Voxels() = default;

const Change& Voxels::update(const scene::World& world, float time, const glm::vec3& eye, Wait wait) {
    Impl& impl = *m_impl;
    const auto post = [&] {
        impl.world = world;
        impl.time = time;
        impl.eye = eye;
        impl.worker.post([&impl] { impl.step(); });
    };
    const Clock::time_point begun = Clock::now();
    if (wait == Wait::exact) {
        impl.worker.wait();
        post();
        while (!impl.worker.done(kProgressInterval)) impl.reportProgress();
        impl.reportProgress();
        impl.collect();
    } else if (impl.worker.done(kMaxWait)) {
        impl.reportProgress();
        impl.collect();
        post();
    } else {
        impl.reportProgress();
        ++impl.statistics.late;
        impl.statistics.changedBytes = 0;
        impl.change.addresses.clear();
        impl.change.bricks.clear();
        impl.change.grid.clear();
    }
    impl.statistics.waitMilliseconds = millisecondsSince(begun);
    impl.statistics.worstWait = std::max(impl.statistics.worstWait, impl.statistics.waitMilliseconds);
    return impl.change;
}

void Voxels::resend() { m_impl->resendAll = true; }

Statistics Voxels::statistics() const {
    Statistics statistics = m_impl->statistics;
    statistics.progress = m_impl->progress;
    return statistics;
}

const Options& Voxels::options() const { return m_impl->options; }

}  // namespace obscura::voxel
