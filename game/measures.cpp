#include "measures.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include <glm/gtc/packing.hpp>

namespace obscura::game {

namespace {

constexpr uint32_t kMostPixels = 256 * 256;
constexpr uint32_t kLargestStep = 31;
constexpr size_t kKept = 600;

bool sameCamera(const scene::Camera& a, const scene::Camera& b) {
    return a.eye == b.eye && a.target == b.target && a.up == b.up && a.fovY == b.fovY && a.orthoHalfHeight == b.orthoHalfHeight;
}

bool sameWorld(const Measures::Frame& a, const Measures::Frame& b) {
    return a.animated == b.animated && a.instances == b.instances && (!a.animated || a.time == b.time);
}

}  // namespace

uint32_t measuredStep(VkExtent2D size) {
    const auto few = [&](uint32_t step) { return uint64_t(size.width / step) * (size.height / step) <= kMostPixels; };
    uint32_t least = 0;
    for (uint32_t step = 1; step <= kLargestStep; step += 2) {
        if (!few(step)) continue;
        if (size.width % step == 0 && size.height % step == 0) return step;
        if (!least) least = step;
    }
    return least ? least : kLargestStep;
}

// The frame before, as the worker keeps it.
struct Measures::Past {
    struct Seen {
        truth::CapturedFrame captured;
        std::vector<glm::vec2> motion;
        truth::Mask visible;
        std::vector<truth::Plane> sides;
        std::optional<truth::Traced> reference;
    };
    static Seen decode(const Frame& frame, const std::vector<uint32_t>& texels);
    std::optional<Frame> frame;
    Seen seen;
    size_t still = 0;  // frames like the one before them
    std::vector<truth::StaticNoise> noise;
};

// What one frame's texels say.
Measures::Past::Seen Measures::Past::decode(const Frame& frame, const std::vector<uint32_t>& texels) {
    const glm::uvec2 size(frame.visible.width / frame.step, frame.visible.height / frame.step);
    Seen seen;
    seen.captured = truth::emptyFrame(size, {0, 0}, frame.camera.fovY, frame.camera.nearPlane, frame.camera);
    if (frame.visible.width % frame.step || frame.visible.height % frame.step) {
        // The rest of the last blocks is cut off, from the lens of the whole picture: x' = part x + (part - 1) w in clip space.
        const glm::vec2 whole(float(frame.visible.width), float(frame.visible.height)), part = whole / (glm::vec2(size) * float(frame.step));
        glm::mat4 crop(1.0f);
        crop[0][0] = part.x, crop[3][0] = part.x - 1.0f;
        crop[1][1] = part.y, crop[3][1] = part.y - 1.0f;
        seen.captured.projection = crop * frame.camera.projection(whole, whole);
    }
    seen.sides.assign(frame.sides.size(), truth::Plane(size.x, size.y));
    seen.motion.resize(seen.captured.depth.size());
    for (size_t i = 0; i < seen.captured.depth.size(); ++i) {
        const uint32_t* texel = &texels[4 * i];
        const glm::vec2 visibility = glm::unpackHalf2x16(texel[0]);
        for (size_t side = 0; side < seen.sides.size(); ++side) seen.sides[side].values[i] = side == 0 ? visibility.x : visibility.y;
        float depth;
        std::memcpy(&depth, &texel[1], sizeof depth);
        seen.captured.depth[i] = std::min(depth, seen.captured.skyDepth);
        if (!seen.captured.isSky(i)) seen.captured.normals[i] = truth::unpackNormal(texel[2]);
        seen.motion[i] = glm::unpackHalf2x16(texel[3]) / float(frame.step);
    }
    seen.visible = seen.captured.visibleMask();
    return seen;
}

Measures::Measures(size_t most) : m_most(most), m_worker([this] { work(); }) {}

Measures::~Measures() {
    {
        const std::lock_guard lock(m_mutex);
        m_end = true;
        m_jobs.clear();
    }
    m_changed.notify_all();
    m_worker.join();
}

void Measures::add(Frame frame, std::span<const std::byte> texels) {
    Job job{std::move(frame), std::vector<uint32_t>(texels.size() / 4)};
    std::memcpy(job.texels.data(), texels.data(), texels.size());
    {
        const std::lock_guard lock(m_mutex);
        if (m_most && m_jobs.size() >= m_most) {
            ++m_leftOut;
            return;
        }
        m_jobs.push_back(std::move(job));
    }
    m_changed.notify_all();
}

void Measures::finish() {
    std::unique_lock lock(m_mutex);
    m_changed.wait(lock, [this] { return m_jobs.empty() && !m_busy; });
}

void Measures::work() {
    Past past;
    std::unique_lock lock(m_mutex);
    while (true) {
        m_changed.wait(lock, [this] { return m_end || !m_jobs.empty(); });
        if (m_end) return;
        Job job = std::move(m_jobs.front());
        m_jobs.pop_front();
        m_busy = true;
        lock.unlock();
        const auto begun = std::chrono::steady_clock::now();
        const bool sameSettings = past.frame && past.frame->sides == job.frame.sides && past.frame->step == job.frame.step && !job.frame.cut;
        Reading reading;
        try {
            reading = measure(job, past);
        } catch (const scene::Error& error) {
            reading.problem = error.what();
            past = {};
        }
        reading.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
        lock.lock();
        m_sameSettings = sameSettings ? m_sameSettings + 1 : 1;
        m_readings.push_back(std::move(reading));
        if (m_most && m_readings.size() > kKept) m_readings.pop_front();
        m_busy = false;
        m_changed.notify_all();
    }
}

Measures::Reading Measures::measure(const Job& job, Past& past) const {
    const Frame& frame = job.frame;
    Past::Seen seen = Past::decode(frame, job.texels);
    Reading reading{.number = frame.number, .time = frame.time, .size = seen.captured.size, .step = frame.step};
    reading.sides.resize(frame.sides.size());
    const bool follows = past.frame && !frame.cut && past.frame->number + 1 == frame.number && past.seen.captured.size == seen.captured.size &&
                         past.frame->sides.size() == frame.sides.size();
    const bool unchanged = follows && past.frame->sides == frame.sides && past.frame->falloff == frame.falloff;
    past.still = unchanged && sameWorld(frame, *past.frame) && sameCamera(frame.camera, past.frame->camera) ? past.still + 1 : 0;
    if (past.still <= kSettling) past.noise.assign(frame.sides.size(), {});
    reading.settling = std::min(past.still, kSettling);

    if (const std::optional<truth::Reference> found = m_cache.find(frame.viewKey);
        found && found->channels[0].obscurance.width == seen.captured.size.x && found->channels[0].obscurance.height == seen.captured.size.y) {
        seen.reference = truth::Traced{found->channels[0].obscurance, found->channels[0].error};
        for (float& v : seen.reference->visibility.values) v = 1.0f - v;
        const auto surfaces = std::count(seen.visible.begin(), seen.visible.end(), 1);
        if (surfaces) reading.rays = float(double(found->totalRays) / double(surfaces));
    }
    std::optional<truth::Correspondence> way;
    if (unchanged) way = truth::correspond(seen.captured, past.seen.captured, seen.motion);
    if (way) reading.share = way->share();
    const truth::Traced nothing{truth::Plane(seen.captured.size.x, seen.captured.size.y), {}};
    const bool judged = seen.reference && past.seen.reference;
    const truth::Traced &now = judged ? *seen.reference : nothing, &before = judged ? *past.seen.reference : nothing;
    for (size_t i = 0; i < seen.sides.size(); ++i) {
        Side& side = reading.sides[i];
        if (seen.reference) side.errors = truth::errors(seen.sides[i], seen.reference->visibility, seen.visible);
        if (way) {
            const truth::Change change = truth::change(*way, seen.sides[i], past.seen.sides[i], now, before);
            if (change.pixels) side.change = change.difference;
            if (change.pixels && judged) side.excess = change.excess(), side.flickerOfError = change.flickerOfError;
        }
        if (past.still <= kSettling) continue;
        past.noise[i].add(seen.sides[i]);
        side.noise = past.noise[i].over(seen.visible);
        reading.stillFrames = past.noise[i].frames();
    }
    past.frame = frame;
    past.seen = std::move(seen);
    return reading;
}

std::optional<Measures::Reading> Measures::means() const {
    const std::lock_guard lock(m_mutex);
    if (m_readings.empty()) return std::nullopt;
    Reading mean = m_readings.back();
    const size_t count = std::min({m_readings.size(), m_sameSettings, kMeans});
    // Each over the readings that have it.
    const auto average = [&](size_t side, auto of) {
        double sum = 0.0;
        size_t known = 0;
        for (size_t k = m_readings.size() - count; k < m_readings.size(); ++k)
            if (side < m_readings[k].sides.size())
                if (const std::optional<float> value = of(m_readings[k].sides[side])) sum += double(*value), ++known;
        return known ? std::optional<float>(float(sum / double(known))) : std::nullopt;
    };
    for (size_t i = 0; i < mean.sides.size(); ++i) {
        mean.sides[i].change = average(i, [](const Side& s) { return s.change; });
        mean.sides[i].excess = average(i, [](const Side& s) { return s.excess; });
        mean.sides[i].flickerOfError = average(i, [](const Side& s) { return s.flickerOfError; });
    }
    return mean;
}

std::vector<Measures::Reading> Measures::all() const {
    const std::lock_guard lock(m_mutex);
    return {m_readings.begin(), m_readings.end()};
}

size_t Measures::leftOut() const {
    const std::lock_guard lock(m_mutex);
    return m_leftOut;
}

}  // namespace obscura::game
