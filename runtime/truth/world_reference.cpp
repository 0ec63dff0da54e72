// The world reference, by Embree 3 or 4; the only file that includes Embree.
#include "truth/world_reference.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <thread>

#if OBSCURA_EMBREE == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif
#include <fmt/format.h>

#include "truth/alpha.h"
#include "truth/estimate.h"

namespace obscura::truth {
namespace {

using Clock = std::chrono::steady_clock;

// Ray queries. Embree 3 takes the flag for incoherent rays in a context before the ray, Embree 4 in arguments after it, with another type
// for occlusion.
class Queries {
public:
    explicit Queries(RTCScene scene) : m_scene(scene) {
#if OBSCURA_EMBREE == 3
        rtcInitIntersectContext(&m_context);
        m_context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
#else
        rtcInitIntersectArguments(&m_intersect);
        rtcInitOccludedArguments(&m_occluded);
        m_intersect.flags = m_occluded.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
#endif
    }
#if OBSCURA_EMBREE == 3
    void intersect(RTCRayHit& hit) { rtcIntersect1(m_scene, &m_context, &hit); }
    void intersect(const int* valid, RTCRayHit8& hit) { rtcIntersect8(valid, m_scene, &m_context, &hit); }
    void occluded(RTCRay& ray) { rtcOccluded1(m_scene, &m_context, &ray); }
    void occluded(const int* valid, RTCRay8& ray) { rtcOccluded8(valid, m_scene, &m_context, &ray); }
#else
    void intersect(RTCRayHit& hit) { rtcIntersect1(m_scene, &hit, &m_intersect); }
    void intersect(const int* valid, RTCRayHit8& hit) { rtcIntersect8(valid, m_scene, &hit, &m_intersect); }
    void occluded(RTCRay& ray) { rtcOccluded1(m_scene, &ray, &m_occluded); }
    void occluded(const int* valid, RTCRay8& ray) { rtcOccluded8(valid, m_scene, &ray, &m_occluded); }
#endif

private:
    RTCScene m_scene;
#if OBSCURA_EMBREE == 3
    RTCIntersectContext m_context;
#else
    RTCIntersectArguments m_intersect;
    RTCOccludedArguments m_occluded;
#endif
};

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Filter of hits on masked primitives: rejects hits on transparent texels.
void passMaskedTexels(const RTCFilterFunctionNArguments* args) {
    const auto& mask = *static_cast<const AlphaMask*>(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i)
        if (args->valid[i] == -1 &&
            mask.open(RTCHitN_primID(args->hit, args->N, i), RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i)))
            args->valid[i] = 0;
}

// A right-handed orthonormal basis with z = n [Duff 2017].
struct Basis {
    glm::vec3 x, y, z;
    explicit Basis(const glm::vec3& n) : z(n) {
        const float s = std::copysign(1.0f, n.z), a = -1.0f / (s + n.z), b = n.x * n.y * a;
        x = {1.0f + s * n.x * n.x * a, s * b, -s * n.x};
        y = {b, s + n.y * n.y * a, -n.y};
    }
    glm::vec3 cosine(float u, float v) const {
        const float r = std::sqrt(u), phi = 6.28318531f * v;
        return x * (r * std::cos(phi)) + y * (r * std::sin(phi)) + z * std::sqrt(std::max(1.0f - u, 0.0f));
    }
};

// Distances of the first hits of kBatch rays; infinity for no hit.
using Distances = std::array<float, kBatch>;
constexpr float kEscaped = std::numeric_limits<float>::infinity();

class Caster {
public:
    Caster(RTCScene scene, float length, bool anyHit, bool packets)
        : m_queries(scene), m_length(length), m_anyHit(anyHit), m_packets(packets) {}

    void cast(const glm::vec3& origin, const std::array<glm::vec3, kBatch>& directions, Distances& distances) {
        if (!m_packets)
            for (uint32_t i = 0; i < kBatch; ++i) distances[i] = castOne(origin, directions[i]);
        else
            for (uint32_t i = 0; i < kBatch; i += 8) castEight(origin, &directions[i], &distances[i]);
    }

private:
    float castOne(const glm::vec3& o, const glm::vec3& d) {
        RTCRayHit hit{};
        hit.ray = {o.x, o.y, o.z, 0.0f, d.x, d.y, d.z, 0.0f, m_length, ~0u, 0u, 0u};
        hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        if (m_anyHit) {
            m_queries.occluded(hit.ray);
            return hit.ray.tfar < 0.0f ? 0.0f : kEscaped;
        }
        m_queries.intersect(hit);
        return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kEscaped : hit.ray.tfar;
    }

    void castEight(const glm::vec3& o, const glm::vec3* d, float* distances) {
        alignas(32) static constexpr int kAll[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
        RTCRayHit8 hit;
        for (int i = 0; i < 8; ++i) {
            hit.ray.org_x[i] = o.x, hit.ray.org_y[i] = o.y, hit.ray.org_z[i] = o.z;
            hit.ray.dir_x[i] = d[i].x, hit.ray.dir_y[i] = d[i].y, hit.ray.dir_z[i] = d[i].z;
            hit.ray.tnear[i] = hit.ray.time[i] = 0.0f;
            hit.ray.tfar[i] = m_length;
            hit.ray.mask[i] = ~0u;
            hit.ray.id[i] = hit.ray.flags[i] = 0;
            hit.hit.geomID[i] = hit.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        }
        if (m_anyHit) {
            m_queries.occluded(kAll, hit.ray);
            for (int i = 0; i < 8; ++i) distances[i] = hit.ray.tfar[i] < 0.0f ? 0.0f : kEscaped;
        } else {
            m_queries.intersect(kAll, hit);
            for (int i = 0; i < 8; ++i) distances[i] = hit.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? kEscaped : hit.ray.tfar[i];
        }
    }

    Queries m_queries;
    float m_length;
    bool m_anyHit, m_packets;
};

}  // namespace

struct WorldReference::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<std::unique_ptr<AlphaMask>> masks;
    size_t triangles = 0;
    double buildSeconds = 0.0;

    ~Impl() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }

    void checkEmbree(const char* doing) const {
        const RTCError error = rtcGetDeviceError(device);
        if (error != RTC_ERROR_NONE)
            throw scene::Error(fmt::format("Embree failed while {} ({})", doing,
                error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : fmt::format("error {}", int(error))));
    }

    void add(const scene::PosedPrimitive& posed, bool masked) {
        const scene::Primitive& primitive = *posed.primitive;
        for (const glm::vec3& p : posed.positions)
            if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
                throw scene::Error(
                    fmt::format("{}: node {} has a posed position that is not finite; check its animation", posed.model->name, posed.node));
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* vertices =
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), posed.positions.size());
        void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, primitive.indices.size() / 3);
        if (vertices && indices) {
            std::memcpy(vertices, posed.positions.data(), posed.positions.size() * sizeof(glm::vec3));
            std::memcpy(indices, primitive.indices.data(), primitive.indices.size() / 3 * 12);
        }
        if (masked) {
            masks.push_back(std::make_unique<AlphaMask>(*posed.model, primitive));
            rtcSetGeometryUserData(geometry, masks.back().get());
            rtcSetGeometryIntersectFilterFunction(geometry, passMaskedTexels);
            rtcSetGeometryOccludedFilterFunction(geometry, passMaskedTexels);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        triangles += primitive.indices.size() / 3;
    }

    // Traces one receiver; returns the number of rays.
    uint32_t traceReceiver(Caster& caster, const Receiver& receiver, size_t index, std::span<const RayFalloff> falloffs,
        const WorldOptions& options, const Schedule& schedule, std::vector<Sums>& sums, std::vector<glm::vec4>& bent,
        Reference& out) const {
        const Basis basis(receiver.normal);
        const glm::vec3 a = glm::abs(receiver.position);
        const float offset = std::max(options.offset * receiver.scale, 1e-6f * std::max(a.x, std::max(a.y, a.z)));
        const glm::vec3 origin = receiver.position + (receiver.normal + receiver.towards) * offset;
        const uint32_t seed = shared::receiverSeed(options.seed, uint32_t(index));
        for (Sums& s : sums) s.fill(0.0f);
        std::fill(bent.begin(), bent.end(), glm::vec4(0.0f));
        std::array<glm::vec3, kBatch> directions;
        Distances distances;
        uint32_t point = 0;
        for (uint32_t until = schedule.first;; until = std::min(point + schedule.step, schedule.last)) {
            for (; point < until; ++point) {
                for (uint32_t s = 0; s < kBatch; ++s)
                    directions[s] = basis.cosine(shared::rayU(point, s, seed), shared::rayV(point, s, seed));
                caster.cast(origin, directions, distances);
                for (uint32_t s = 0; s < kBatch; ++s)
                    for (size_t f = 0; distances[s] < kEscaped && f < falloffs.size(); ++f)
                        if (distances[s] <= falloffs[f].reach) sums[f][s] += falloffs[f].hard ? 1.0f : falloffs[f].rho(distances[s]);
                for (size_t f = 0; f < bent.size(); ++f)
                    for (uint32_t s = 0; s < kBatch; ++s) {
                        const bool counts = distances[s] < kEscaped && distances[s] <= falloffs[f].reach;
                        const float open = !counts ? 1.0f : falloffs[f].hard ? 0.0f : 1.0f - falloffs[f].rho(distances[s]);
                        bent[f] += open * glm::vec4(directions[s], directions[s].y > 0.0f ? 1.0f : 0.0f);
                    }
            }
            float worst = 0.0f;
            for (size_t f = 0; f < falloffs.size(); ++f) {
                const Estimate e = estimate(sums[f], point);
                out.channels[f].obscurance.values[index] = e.mean;
                out.channels[f].error.values[index] = e.error;
                worst = std::max(worst, e.error);
            }
            if (point >= schedule.last || worst <= schedule.target) break;
        }
        out.rays.values[index] = float(point * kBatch);
        for (size_t f = 0; f < bent.size(); ++f) {
            bent[f] /= float(point * kBatch);
            for (int axis = 0; axis < 3; ++axis) out.channels[f].bent.mean[axis].values[index] = bent[f][axis];
            out.channels[f].bent.above.values[index] = bent[f].w;
        }
        return point * kBatch;
    }
};

WorldReference::WorldReference(std::span<const scene::PosedPrimitive> primitives, const WorldGeometry& geometry)
    : m_impl(std::make_unique<Impl>()) {
    const Clock::time_point start = Clock::now();
    Impl& impl = *m_impl;
    impl.device = rtcNewDevice(nullptr);
    if (!impl.device) throw scene::Error("Embree cannot create a device on this processor");
    impl.scene = rtcNewScene(impl.device);
    rtcSetSceneFlags(impl.scene, RTC_SCENE_FLAG_ROBUST);  // no rays between adjacent triangles
    rtcSetSceneBuildQuality(impl.scene, RTC_BUILD_QUALITY_HIGH);
    for (const scene::PosedPrimitive& posed : primitives) {
        const scene::AlphaMode mode = posed.model->materials[size_t(posed.primitive->material)].alphaMode;
        const bool masked = mode == scene::AlphaMode::mask;
        if (posed.primitive->indices.empty() || (masked && geometry.skipMasked) ||
            (mode == scene::AlphaMode::blend && geometry.skipBlended))
            continue;
        impl.add(posed, masked);
    }
    rtcCommitScene(impl.scene);
    impl.checkEmbree("building its acceleration structure");
    impl.buildSeconds = secondsSince(start);
}

WorldReference::~WorldReference() = default;
WorldReference::WorldReference(WorldReference&&) noexcept = default;
size_t WorldReference::triangles() const { return m_impl->triangles; }
double WorldReference::buildSeconds() const { return m_impl->buildSeconds; }

Reference WorldReference::trace(const CapturedFrame& frame, std::span<const RayFalloff> falloffs, const WorldOptions& options) const {
    if (!frame.hasNormals()) throw scene::Error("the frame has no normals; capture them, or reconstruct them from depth");
    const glm::mat4 worldFromEye = frame.worldFromEye();
    const glm::mat3 rotation(worldFromEye);
    const glm::uvec2 part = frame.visible();
    const shared::View view = frame.view();
    std::vector<Receiver> receivers(size_t(part.x) * part.y, {glm::vec3(0.0f), glm::vec3(0.0f)});
    for (uint32_t y = 0; y < part.y; y += std::max(options.stride, 1u))
        for (uint32_t x = 0; x < part.x; x += std::max(options.stride, 1u)) {
            const size_t at = frame.visibleIndex(x, y);
            if (frame.isSky(at)) continue;
            const glm::vec3 eye = frame.eyePosition(x + frame.guard.x, y + frame.guard.y);
            const glm::vec3 towards = view.orthographic > 0.5f ? glm::vec3(0, 0, 1) : -eye;
            const glm::vec3 n = glm::dot(frame.normals[at], towards) < 0.0f ? -frame.normals[at] : frame.normals[at];
            receivers[size_t(y) * part.x + x] = {glm::vec3(worldFromEye * glm::vec4(eye, 1.0f)), glm::normalize(rotation * n),
                glm::length(eye), glm::normalize(rotation * towards)};
        }
    return trace(receivers, falloffs, options, part.x);
}

Reference WorldReference::trace(
    std::span<const Receiver> receivers, std::span<const RayFalloff> falloffs, const WorldOptions& options, uint32_t width) const {
    if (falloffs.empty()) throw scene::Error("the world reference needs at least one falloff");
    if (width == 0) width = uint32_t(receivers.size());
    const Clock::time_point start = Clock::now();
    Reference out = emptyReference(width, width ? uint32_t((receivers.size() + width - 1) / width) : 0, falloffs);
    for (Reference::Channel& channel : out.channels)
        if (options.bentNormals)
            for (Plane* plane : {&channel.bent.mean[0], &channel.bent.mean[1], &channel.bent.mean[2], &channel.bent.above})
                *plane = Plane(out.rays.width, out.rays.height);
    const Schedule schedule(options);
    float length = 0.0f;
    bool anyHit = true;
    for (const RayFalloff& falloff : falloffs) {
        anyHit = anyHit && falloff.hard && falloff.reach == falloffs[0].reach;
        length = std::max(length, falloff.reach);
    }

    // Threads take receivers in blocks. A receiver writes its own pixel and is independent of others, so the result does not depend on the
    // number of threads.
    constexpr size_t kBlock = 64;
    const size_t blocks = (receivers.size() + kBlock - 1) / kBlock;
    std::atomic<size_t> nextBlock{0}, finished{0};
    std::atomic<uint64_t> rays{0};
    std::atomic<bool> stop{false};
    const auto work = [&](bool reportsProgress) {
        Caster caster(m_impl->scene, length, anyHit, options.packets);
        std::vector<Sums> sums(falloffs.size());
        std::vector<glm::vec4> bent(options.bentNormals ? falloffs.size() : 0);
        for (size_t block; !stop && (block = nextBlock++) < blocks;) {
            uint64_t cast = 0;
            const size_t end = std::min(receivers.size(), (block + 1) * kBlock);
            for (size_t i = block * kBlock; i < end; ++i)
                if (receivers[i].normal != glm::vec3(0.0f))
                    cast += m_impl->traceReceiver(caster, receivers[i], i, falloffs, options, schedule, sums, bent, out);
            rays += cast;
            const size_t done = ++finished;
            if (reportsProgress && options.progress && !options.progress(float(done) / float(blocks))) stop = true;
        }
    };
    const size_t wanted = options.threads ? options.threads : std::max(std::thread::hardware_concurrency(), 1u);
    {
        std::vector<std::jthread> helpers;
        // If progress() throws, the helper threads must stop before the objects that they use are destroyed.
        struct StopUnlessDone {
            std::atomic<bool>& stop;
            bool done = false;
            ~StopUnlessDone() {
                if (!done) stop = true;
            }
        } guard{stop};
        for (size_t i = 1; i < std::min(wanted, std::max<size_t>(blocks, 1)); ++i) helpers.emplace_back([&] { work(false); });
        work(true);
        guard.done = true;
    }
    if (stop) throw scene::Error("the reference was cancelled");
    if (options.progress) options.progress(1.0f);
    out.totalRays = rays;
    out.seconds = secondsSince(start);
    return out;
}

}  // namespace obscura::truth
