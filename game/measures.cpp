#include "measures.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include <glm/gtc/packing.hpp>

namespace obscura::game {

namespace {

constexpr uint32_t kMaxPixels = 256 * 256;
constexpr uint32_t kLargestStep = 31;
constexpr size_t kKeptReadings = 600;

bool sameWorld(const Measures::Frame& a, const Measures::Frame& b) {
    return a.animated == b.animated && a.instances == b.instances && (!a.animated || a.time == b.time);
}

}  // namespace

uint32_t measuredStep(VkExtent2D size) {
    const auto fits = [&](uint32_t step) { return uint64_t(size.width / step) * (size.height / step) <= kMaxPixels; };
    uint32_t smallest = 0;
    for (uint32_t step = 1; step <= kLargestStep; step += 2) {
        if (!fits(step)) continue;
        if (size.width % step == 0 && size.height % step == 0) return step;
        if (!smallest) smallest = step;
    }
    return smallest ? smallest : kLargestStep;
}

// The previous frame, kept by the worker.
struct Measures::Previous {
    struct Decoded {
        truth::CapturedFrame captured;
        std::vector<glm::vec2> motion;
        truth::Mask visible;
        std::vector<truth::Plane> sides;
        std::optional<truth::Traced> reference;
    };
    static Decoded decode(const Frame& frame, const std::vector<uint32_t>& texels);
    std::optional<Frame> frame;
    Decoded decoded;
    size_t still = 0;  // frames in a row with unchanged camera, world and settings
    std::vector<truth::StaticNoise> noise;
};

// Unpacks the texels of one frame.
Measures::Previous::Decoded Measures::Previous::decode(const Frame& frame, const std::vector<uint32_t>& texels) {
    const glm::uvec2 size(frame.visible.width / frame.step, frame.visible.height / frame.step);
    Decoded decoded;
    decoded.captured = truth::emptyFrame(size, {0, 0}, frame.camera.fovY, frame.camera.nearPlane, frame.camera);
    if (frame.visible.width % frame.step || frame.visible.height % frame.step) {
        // Blocks that the picture's edge cuts off are left out, so the projection is cropped: x' = scale x + (scale - 1) w in clip space.
        const glm::vec2 whole(float(frame.visible.width), float(frame.visible.height)),
            scale = whole / (glm::vec2(size) * float(frame.step));
        glm::mat4 crop(1.0f);
        crop[0][0] = scale.x, crop[3][0] = scale.x - 1.0f;
        crop[1][1] = scale.y, crop[3][1] = scale.y - 1.0f;
        decoded.captured.projection = crop * frame.camera.projection(whole, whole);
    }
    decoded.sides.assign(frame.sides.size(), truth::Plane(size.x, size.y));
    decoded.motion.resize(decoded.captured.depth.size());
    for (size_t i = 0; i < decoded.captured.depth.size(); ++i) {
        const uint32_t* texel = &texels[4 * i];
        const glm::vec2 visibility = glm::unpackHalf2x16(texel[0]);
        for (size_t side = 0; side < decoded.sides.size(); ++side) decoded.sides[side].values[i] = side == 0 ? visibility.x : visibility.y;
        float depth;
        std::memcpy(&depth, &texel[1], sizeof depth);
        decoded.captured.depth[i] = std::min(depth, decoded.captured.skyDepth);
        if (!decoded.captured.isSky(i)) decoded.captured.normals[i] = truth::unpackNormal(texel[2]);
        decoded.motion[i] = glm::unpackHalf2x16(texel[3]) / float(frame.step);
    }
    decoded.visible = decoded.captured.visibleMask();
    return decoded;
}

Measures::Measures(size_t maxPending) : m_maxPending(maxPending), m_worker([this] { work(); }) {}

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
        if (m_maxPending && m_jobs.size() >= m_maxPending) {
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
    Previous previous;
    std::unique_lock lock(m_mutex);
    while (true) {
        m_changed.wait(lock, [this] { return m_end || !m_jobs.empty(); });
        if (m_end) return;
        Job job = std::move(m_jobs.front());
        m_jobs.pop_front();
        m_busy = true;
        lock.unlock();
        const auto begun = std::chrono::steady_clock::now();
        const bool sameSettings =
            previous.frame && previous.frame->sides == job.frame.sides && previous.frame->step == job.frame.step && !job.frame.cut;
        Reading reading;
        try {
            reading = measure(job, previous);
        } catch (const scene::Error& error) {
            reading.problem = error.what();
            previous = {};
        }
        reading.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
        lock.lock();
        m_sameSettings = sameSettings ? m_sameSettings + 1 : 1;
        m_readings.push_back(std::move(reading));
        if (m_maxPending && m_readings.size() > kKeptReadings) m_readings.pop_front();
        m_busy = false;
        m_changed.notify_all();
    }
}

Measures::Reading Measures::measure(const Job& job, Previous& previous) const {
    const Frame& frame = job.frame;
    Previous::Decoded decoded = Previous::decode(frame, job.texels);
    Reading reading{.number = frame.number, .time = frame.time, .size = decoded.captured.size, .step = frame.step};
    reading.sides.resize(frame.sides.size());
    const bool follows = previous.frame && !frame.cut && previous.frame->number + 1 == frame.number &&
                         previous.decoded.captured.size == decoded.captured.size && previous.frame->sides.size() == frame.sides.size();
    const bool unchanged = follows && previous.frame->sides == frame.sides && previous.frame->falloff == frame.falloff;
    previous.still = unchanged && sameWorld(frame, *previous.frame) && frame.camera == previous.frame->camera ? previous.still + 1 : 0;
    if (previous.still <= kSettling) previous.noise.assign(frame.sides.size(), {});
    reading.settling = std::min(previous.still, kSettling);

    if (const std::optional<truth::Reference> found = m_cache.find(frame.viewKey);
        found && found->channels[0].obscurance.width == decoded.captured.size.x &&
        found->channels[0].obscurance.height == decoded.captured.size.y) {
        decoded.reference = truth::Traced{found->channels[0].obscurance, found->channels[0].error};
        for (float& v : decoded.reference->visibility.values) v = 1.0f - v;
        const auto surfaces = std::count(decoded.visible.begin(), decoded.visible.end(), 1);
        if (surfaces) reading.rays = float(double(found->totalRays) / double(surfaces));
    }
    std::optional<truth::Correspondence> correspondence;
    if (unchanged) correspondence = truth::correspond(decoded.captured, previous.decoded.captured, decoded.motion);
    if (correspondence) reading.share = correspondence->share();
    const truth::Traced nothing{truth::Plane(decoded.captured.size.x, decoded.captured.size.y), {}};
    const bool hasReferences = decoded.reference && previous.decoded.reference;
    const truth::Traced &now = hasReferences ? *decoded.reference : nothing,
                        &before = hasReferences ? *previous.decoded.reference : nothing;
    for (size_t i = 0; i < decoded.sides.size(); ++i) {
        Side& side = reading.sides[i];
        if (decoded.reference) side.errors = truth::errors(decoded.sides[i], decoded.reference->visibility, decoded.visible);
        if (correspondence) {
            const truth::Change change = truth::change(*correspondence, decoded.sides[i], previous.decoded.sides[i], now, before);
            if (change.pixels) side.change = change.difference;
            if (change.pixels && hasReferences) side.excess = change.excess(), side.flickerOfError = change.flickerOfError;
        }
        if (previous.still <= kSettling) continue;
        previous.noise[i].add(decoded.sides[i]);
        side.noise = previous.noise[i].over(decoded.visible);
        reading.stillFrames = previous.noise[i].frames();
    }
    previous.frame = frame;
    previous.decoded = std::move(decoded);
    return reading;
}

std::optional<Measures::Reading> Measures::means() const {
    const std::lock_guard lock(m_mutex);
    if (m_readings.empty()) return std::nullopt;
    Reading mean = m_readings.back();
    const size_t count = std::min({m_readings.size(), m_sameSettings, kMeans});
    // Averages over the readings that have a value.
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
