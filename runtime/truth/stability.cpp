#include "truth/stability.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace obscura::truth {

namespace {

constexpr float kDepthTolerance = 0.02f;    // fraction of the depth, for stayed()
constexpr float kPlaneTolerance = 0.05f;    // fraction of a pixel's width on the surface
constexpr float kNormalTolerance = 0.906f;  // cos 25 degrees
constexpr float kChanged = 0.1f;            // visibility, for lag()

float bilinear(const Plane& plane, glm::vec2 at) {
    const glm::vec2 corner = glm::floor(at), part = at - corner;
    const auto pixel = [&](int x, int y) {
        return plane.at(uint32_t(std::clamp(x, 0, int(plane.width) - 1)), uint32_t(std::clamp(y, 0, int(plane.height) - 1)));
    };
    const int x = int(corner.x), y = int(corner.y);
    return glm::mix(glm::mix(pixel(x, y), pixel(x + 1, y), part.x), glm::mix(pixel(x, y + 1), pixel(x + 1, y + 1), part.x), part.y);
}

void expectPlanes(std::initializer_list<const Plane*> planes, uint32_t width, uint32_t height) {
    for (const Plane* plane : planes)
        if (plane->width != width || plane->height != height)
            throw scene::Error(
                fmt::format("stability: an image is {} x {} px, the others {} x {}", plane->width, plane->height, width, height));
}

}  // namespace

float Correspondence::share() const {
    size_t known = 0, surfaces = 0;
    for (size_t i = 0; i < same.size(); ++i) {
        known += same[i];
        surfaces += at[i].x > -1e8f;
    }
    return surfaces ? float(known) / float(surfaces) : 0.0f;
}

Correspondence correspond(const CapturedFrame& now, const CapturedFrame& before, std::span<const glm::vec2> motion) {
    if (now.size != before.size || now.guard != before.guard || motion.size() != now.depth.size())
        throw scene::Error("stability: both frames and the motion must have the same size and guard band");
    if (!now.camera || !before.camera || !now.hasNormals() || !before.hasNormals())
        throw scene::Error("stability: both frames must have a camera and normals");
    const glm::mat4 previousFromEye = before.camera->view() * now.worldFromEye();
    const glm::uvec2 visible = now.visible();
    const shared::View lens = now.view(), lensBefore = before.view();
    const auto onRay = [](const shared::View& view, glm::vec2 pixelCentre, float depth) {
        const float scale = view.orthographic > 0.5f ? 1.0f : depth;
        return glm::vec3((pixelCentre.x * view.unproject.x + view.unproject.z) * scale,
            (pixelCentre.y * view.unproject.y + view.unproject.w) * scale, -depth);
    };
    const glm::vec2 guard = glm::vec2(now.guard) + 0.5f;
    Correspondence way{visible.x, visible.y, std::vector<glm::vec2>(size_t(visible.x) * visible.y, glm::vec2(-1e9f)),
        Mask(size_t(visible.x) * visible.y), Mask(size_t(visible.x) * visible.y)};
    for (uint32_t y = 0; y < visible.y; ++y)
        for (uint32_t x = 0; x < visible.x; ++x) {
            const size_t source = now.visibleIndex(x, y), target = size_t(y) * visible.x + x;
            if (now.isSky(source)) continue;
            const glm::vec2 at = glm::vec2(x, y) + motion[source];
            way.at[target] = at;
            const glm::vec3 expected(previousFromEye * glm::vec4(onRay(lens, glm::vec2(x, y) + guard, now.depth[source]), 1.0f));
            const glm::vec3 facing = glm::mat3(previousFromEye) * now.normals[source];
            // For a moving surface, camera motion alone does not give last frame's position: the plane passes through the pixel at `at`.
            const glm::vec3 anchor = onRay(lensBefore, at + guard, -expected.z);
            const float tolerance = kPlaneTolerance * (lensBefore.orthographic > 0.5f ? 1.0f : -expected.z) / lensBefore.pixelsPerMetre;
            int agree = 0, tested = 0;
            const glm::ivec2 corner(glm::floor(at));
            const glm::vec2 part = at - glm::floor(at);
            for (int k = 0; k < 4; ++k) {
                const glm::ivec2 q = corner + glm::ivec2(k & 1, k >> 1);
                if ((k & 1 ? part.x : 1.0f - part.x) * (k >> 1 ? part.y : 1.0f - part.y) < 1e-3f) continue;  // negligible weight
                ++tested;
                if (q.x < 0 || q.y < 0 || q.x >= int(visible.x) || q.y >= int(visible.y)) continue;
                const size_t there = before.visibleIndex(uint32_t(q.x), uint32_t(q.y));
                if (before.isSky(there)) continue;
                const float off = std::fabs(glm::dot(onRay(lensBefore, glm::vec2(q) + guard, before.depth[there]) - anchor, facing));
                agree += off <= tolerance && glm::dot(before.normals[there], facing) >= kNormalTolerance;
            }
            way.same[target] = agree == tested;
            way.disoccluded[target] = agree == 0;
        }
    return way;
}

Change change(const Correspondence& way, const Plane& now, const Plane& before, const Traced& referenceNow, const Traced& referenceBefore) {
    expectPlanes({&now, &before, &referenceNow.visibility, &referenceBefore.visibility}, way.width, way.height);
    // Variance of a bilinear sample of last frame: four independent pixels, weighted.
    const auto variance = [](const Traced& traced, glm::vec2 at) {
        if (traced.error.values.empty()) return 0.0;
        const glm::vec2 corner = glm::floor(at), part = at - corner;
        double sum = 0.0;
        for (int k = 0; k < 4; ++k) {
            const double w = double(k & 1 ? part.x : 1.0f - part.x) * double(k >> 1 ? part.y : 1.0f - part.y);
            const uint32_t x = uint32_t(std::clamp(int(corner.x) + (k & 1), 0, int(traced.error.width) - 1));
            const uint32_t y = uint32_t(std::clamp(int(corner.y) + (k >> 1), 0, int(traced.error.height) - 1));
            sum += w * w * double(traced.error.at(x, y)) * double(traced.error.at(x, y));
        }
        return sum;
    };
    double a = 0.0, e = 0.0;
    std::vector<float> truth(way.same.size(), 0.0f);  // squared change less its variance
    Change result;
    for (size_t i = 0; i < way.same.size(); ++i) {
        if (!way.same[i]) continue;
        const double da = double(now.values[i]) - double(bilinear(before, way.at[i]));
        const double dr = double(referenceNow.visibility.values[i]) - double(bilinear(referenceBefore.visibility, way.at[i]));
        const double own = referenceNow.error.values.empty() ? 0.0 : double(referenceNow.error.values[i]);
        const double noise = own * own + variance(referenceBefore, way.at[i]);
        a += std::fabs(da);
        e += (da - dr) * (da - dr) - noise;
        truth[i] = float(dr * dr - noise);
        ++result.pixels;
    }
    if (result.pixels == 0) return result;
    double r = 0.0, square = 0.0;
    for (const float change : truth) square += double(change);
    for (uint32_t y = 0; y < way.height; ++y)
        for (uint32_t x = 0; x < way.width; ++x) {
            if (!way.same[size_t(y) * way.width + x]) continue;
            double sum = 0.0, count = 0.0;
            for (uint32_t v = y ? y - 1 : 0; v <= std::min(y + 1, way.height - 1); ++v)
                for (uint32_t u = x ? x - 1 : 0; u <= std::min(x + 1, way.width - 1); ++u) {
                    const size_t i = size_t(v) * way.width + u;
                    sum += truth[i];
                    count += way.same[i];
                }
            r += std::sqrt(std::max(0.0, sum / count));
        }
    const double count = double(result.pixels);
    result.difference = float(a / count);
    result.referenceDifference = float(r / count);
    result.flickerOfError = float(std::sqrt(std::max(0.0, e / count)));
    result.referenceFlicker = float(std::sqrt(std::max(0.0, square / count)));
    return result;
}

void StaticNoise::add(const Plane& visibility) {
    if (m_frames == 0) {
        m_mean.assign(visibility.pixels(), 0.0);
        m_squares.assign(visibility.pixels(), 0.0);
    }
    if (m_mean.size() != visibility.pixels()) throw scene::Error("stability: images of different sizes");
    ++m_frames;
    for (size_t i = 0; i < m_mean.size(); ++i) {  // [Welford 1962]
        const double value = visibility.values[i], step = value - m_mean[i];
        m_mean[i] += step / double(m_frames);
        m_squares[i] += step * (value - m_mean[i]);
    }
}

StaticNoise::Result StaticNoise::over(const Mask& valid) const {
    std::vector<float> deviations;
    double sum = 0.0;
    for (size_t i = 0; i < m_squares.size(); ++i) {
        if (!valid.empty() && !valid[i]) continue;
        deviations.push_back(float(std::sqrt(m_squares[i] / double(m_frames))));
        sum += deviations.back();
    }
    if (deviations.empty()) return {};
    const size_t rank = std::min(deviations.size() - 1, size_t(0.99 * double(deviations.size())));
    std::nth_element(deviations.begin(), deviations.begin() + ptrdiff_t(rank), deviations.end());
    return {float(sum / double(deviations.size())), deviations[rank]};
}

Lag lag(const Plane& before, std::span<const Plane> after, const Plane& referenceBefore, const Plane& referenceAfter, const Mask& stayed) {
    Lag result;
    if (after.empty()) return result;
    for (const Plane& plane : after) expectPlanes({&plane, &before, &referenceBefore, &referenceAfter}, before.width, before.height);
    const Plane& settled = after.back();
    std::vector<size_t> changed, lighter;
    for (size_t i = 0; i < stayed.size(); ++i) {
        const float step = referenceAfter.values[i] - referenceBefore.values[i];
        if (!stayed[i] || std::fabs(step) <= kChanged) continue;
        changed.push_back(i);
        if (step > 0.0f) lighter.push_back(i);
    }
    result.pixels = changed.size();
    if (changed.empty()) return result;

    const auto away = [&](const Plane& plane) {
        double sum = 0.0;
        for (const size_t i : changed) sum += std::fabs(double(plane.values[i]) - double(settled.values[i]));
        return sum / double(changed.size());
    };
    const double step = away(before);
    result.t90 = 1;
    for (size_t t = 0; t < after.size(); ++t) {
        if (away(after[t]) > 0.1 * step) result.t90 = uint32_t(t) + 2;
        double excess = 0.0;
        for (const size_t i : lighter)
            excess += std::max(
                0.0f, std::fabs(after[t].values[i] - referenceAfter.values[i]) - std::fabs(settled.values[i] - referenceAfter.values[i]));
        if (!lighter.empty()) result.ghost += float(excess / double(lighter.size()));
    }
    return result;
}

Mask stayed(const CapturedFrame& before, const CapturedFrame& after) {
    const glm::uvec2 visible = after.visible();
    Mask mask(size_t(visible.x) * visible.y);
    for (uint32_t y = 0; y < visible.y; ++y)
        for (uint32_t x = 0; x < visible.x; ++x) {
            const size_t i = after.visibleIndex(x, y);
            mask[size_t(y) * visible.x + x] =
                !after.isSky(i) && !before.isSky(i) && std::fabs(before.depth[i] - after.depth[i]) <= kDepthTolerance * after.depth[i];
        }
    return mask;
}

}  // namespace obscura::truth
