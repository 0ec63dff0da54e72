#include "voxel/voxels.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

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
    explicit Impl(Options o);

    const Options options;

    // Owned by the worker between post() and done(), else by the caller.
    scene::World world;
    float time = 0.0f;
    glm::vec3 eye{0.0f};
    bool waitForBuilds = false;
    Objects objects;
    std::vector<Window> windows;  // by level
    Picked picked;
    NanoGrid grid;  // all windows' bricks; with options.nano
    std::vector<std::string> lines;
    std::atomic<float> progress{1.0f};
    Resting resting;
    double stepMilliseconds = 0.0;

    // Owned by the caller.
    Change change;
    bool resendAll = false;
    Statistics statistics;
    bool reportedEnd = true;  // of building, to options.progress
    Worker worker;            // last member: its thread ends before the others are destroyed

    void reportProgress();
    void updateWindows(const std::vector<glm::ivec3>& changed, bool all);
    void updateGrid();
    void step();
    void collect();
};

Voxels::Impl::Impl(Options o)
    : options(std::move(o)),
      windows(options.levels, Window(options.cells)),
      picked{options.masked},
      resting({.cells = options.cells,
          .levels = options.levels,
          .cellSize = options.cellSize,
          .picked = picked,
          .shell = options.shell,
          .bits = options.bits,
          .cache = options.cache,
          .mostBricks = options.mostBricks,
          .say = [this](const std::string& line) { lines.push_back(line); },
          .progress = &progress}) {}

void Voxels::Impl::reportProgress() {
    const float now = progress;
    if (options.progress && (now < 1.0f || !reportedEnd)) options.progress(now);
    reportedEnd = now >= 1.0f;
}

// `changed`: places of level 0, which may have duplicates.
void Voxels::Impl::updateWindows(const std::vector<glm::ivec3>& changed, bool all) {
    const glm::ivec3 centre = centreBrick(resting.cellSize(), eye);
    std::vector<glm::ivec3> places = changed;
    sortUnique(places);
    for (uint32_t k = 0; k < windows.size(); ++k) {
        if (k > 0) toNextLevel(places);
        const glm::ivec3 origin = windowOrigin(options.cells, k, centre);
        if (!options.bits) windows[k].place(origin);
        else
            windows[k].update(origin, places, all, [&](const glm::ivec3& place, Brick& out) {
                resting.find(place, k, out);
                objects.compose(place, k, out);
            });
    }
}

void Voxels::Impl::updateGrid() {
    const uint32_t side = options.cells / kBrickSide;
    for (uint32_t k = 0; k < windows.size(); ++k)
        for (const uint32_t address : windows[k].takeChanged(false))
            grid.put({k * side + address / (side * side), address / side % side, address % side}, windows[k][address]);
}

// One frame, on the worker's thread.
void Voxels::Impl::step() {
    std::vector<glm::ivec3> changed;
    const bool isNew = resting.update(world, time, waitForBuilds, changed);
    if (isNew) objects.clear();
    const Clock::time_point begun = Clock::now();
    if (options.bits) {
        objects.begin();
        std::vector<Part> parts;
        for (const scene::Instance& instance : world.instances()) {
            if (!instance.model) continue;
            parts = partsOf(instance, picked);
            std::erase_if(parts, [&](const Part& part) { return resting.contains(instance.id, part); });
            objects.add(instance, parts);
        }
        const glm::dvec3 centre = glm::dvec3(centreBrick(resting.cellSize(), eye)) * (kBrickSide * resting.cellSize());
        const double half = 0.5 * double(options.cells) * std::exp2(double(options.levels - 1)) * resting.cellSize();
        objects.end(time, {resting.cellSize(), options.levels, centre - half, centre + half, picked, options.shell}, changed,
            [this](const std::string& line) { lines.push_back(line); });
    }
    updateWindows(changed, isNew);
    if (options.nano) updateGrid();
    stepMilliseconds = millisecondsSince(begun);
}

void Voxels::Impl::collect() {
    for (const std::string& line : lines)
        if (options.say) options.say(line);
    lines.clear();
    change.addresses.clear();
    change.bricks.clear();
    change.gridRanges.clear();
    change.grid.clear();
    change.cells = resting.cellSize() == 0.0 ? 0 : options.cells;
    if (change.cells == 0) return;
    change.levels = options.levels;
    change.cellSize = resting.cellSize();
    change.origin = windows[0].origin() * kBrickSide;
    if (options.nano) {
        change.gridBytes = grid.bytes();
        change.gridRanges = grid.takeChanged();
        if (resendAll) change.gridRanges = {{0, grid.bytes()}};
        for (const NanoGrid::Range& range : change.gridRanges) {
            const auto words = grid.words().subspan(range.offset / 4, range.bytes / 4);
            change.grid.insert(change.grid.end(), words.begin(), words.end());
        }
    } else {
        const uint32_t bricks = uint32_t(change.bytes() / change.levels / sizeof(Brick));
        for (uint32_t k = 0; k < windows.size(); ++k)
            for (const uint32_t address : windows[k].takeChanged(resendAll)) {
                change.addresses.push_back(k * bricks + address);
                change.bricks.push_back(windows[k][address]);
            }
    }
    resendAll = false;

    statistics.resting = resting.facts();
    statistics.objects = objects.count();
    statistics.redone = objects.redone();
    statistics.objectCells = objects.cells();
    statistics.objectBytes = objects.bytes();
    statistics.windowBytes = options.nano ? grid.bytes() : change.bytes();
    statistics.changedBytes = change.bricks.size() * sizeof(Brick) + change.grid.size() * sizeof(uint32_t);
    statistics.workerMilliseconds = stepMilliseconds;
}

Voxels::Voxels(Options options) {
    options.cells = std::bit_ceil(std::clamp(options.cells, 64u, 512u));
    options.levels = std::clamp(options.levels, 1u, kMostLevels);
    m_impl = std::make_unique<Impl>(std::move(options));
}
Voxels::~Voxels() = default;

const Change& Voxels::update(const scene::World& world, float time, const glm::vec3& eye, Wait wait) {
    Impl& impl = *m_impl;
    const auto post = [&] {
        impl.world = world;
        impl.time = time;
        impl.eye = eye;
        impl.waitForBuilds = wait == Wait::exact;
        impl.worker.post([&impl] { impl.step(); });
    };
    const Clock::time_point begun = Clock::now();
    if (wait != Wait::latest) {
        impl.worker.wait();
        post();
        while (!impl.worker.done(kProgressInterval)) impl.reportProgress();
        impl.reportProgress();
        impl.collect();
    } else if (impl.worker.done(impl.progress < 1.0f ? std::chrono::microseconds(0) : kMaxWait)) {  // a build takes every core
        impl.reportProgress();
        impl.collect();
        post();
    } else {
        impl.reportProgress();
        ++impl.statistics.late;
        impl.statistics.changedBytes = 0;
        impl.change.addresses.clear();
        impl.change.bricks.clear();
        impl.change.gridRanges.clear();
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
