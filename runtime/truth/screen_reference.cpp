// Dispatches receivers to the marching pass, accumulates its sums, and drops receivers whose error is small enough.
#include "truth/screen_reference.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "graph/executor.h"
#include "truth/estimate.h"

namespace obscura::truth {
namespace {

// Receivers, and points per sequence, of one dispatch: limits memory, and the time of a dispatch on devices with a watchdog.
constexpr uint32_t kReceivers = 1u << 15;
constexpr uint32_t kPoints = 4;
constexpr uint32_t kTableSize = 2048;

// The reaches, then kTableSize samples of each falloff over [0, reach]: tables for the shader.
std::vector<float> tabulate(std::span<const RayFalloff> falloffs) {
    std::vector<float> table;
    for (const RayFalloff& falloff : falloffs) table.push_back(falloff.reach);
    for (const RayFalloff& falloff : falloffs)
        for (uint32_t i = 0; i < kTableSize; ++i)
            table.push_back(falloff.hard ? 1.0f : falloff.rho(falloff.reach * float(i) / float(kTableSize - 1)));
    return table;
}

struct Pending {
    uint32_t pixel;  // index in the visible part
    shared::MarchReceiver receiver;
    std::vector<Sums> sums;  // one per falloff
};

// Where a receiver's rays start: `offset` metres along the normal. If that is in another texel and behind its surface, they start a
// quarter of a pixel from the receiver instead, because all of them would be blocked where they start.
glm::vec3 startOf(
    const CapturedFrame& frame, const shared::View& view, glm::uvec2 texel, const glm::vec3& eye, const glm::vec3& n, float offset) {
    const glm::vec3 start = eye + n * offset;
    const float scale = view.orthographic > 0.5f ? 1.0f : -start.z;
    const glm::vec2 at(start.x / scale * view.project.x + view.project.z, start.y / scale * view.project.y + view.project.w),
        moved = glm::abs(at - glm::vec2(texel) - 0.5f);
    const float farthest = std::max(moved.x, moved.y);
    if (farthest < 0.5f || at.x < 0.0f || at.y < 0.0f || at.x >= float(frame.size.x) || at.y >= float(frame.size.y)) return start;
    const size_t there = frame.index(uint32_t(at.x), uint32_t(at.y));
    return frame.isSky(there) || -start.z <= frame.depth[there] ? start : eye + n * (offset * 0.25f / farthest);
}

std::vector<Pending> receiversOf(const CapturedFrame& frame, const ScreenOptions& options, size_t falloffs) {
    std::vector<Pending> list;
    const shared::View view = frame.view();
    const glm::uvec2 part = frame.visible();
    const uint32_t stride = std::max(options.stride, 1u);
    for (uint32_t y = 0; y < part.y; y += stride)
        for (uint32_t x = 0; x < part.x; x += stride) {
            const size_t at = frame.visibleIndex(x, y);
            if (frame.isSky(at)) continue;
            const bool ortho = view.orthographic > 0.5f;
            const glm::vec3 eye = frame.eyePosition(x + frame.guard.x, y + frame.guard.y);
            const glm::vec3 towards = ortho ? glm::vec3(0, 0, 1) : -eye;
            const glm::vec3 n = glm::dot(frame.normals[at], towards) < 0.0f ? -frame.normals[at] : frame.normals[at];
            const float footprint = (ortho ? 1.0f : frame.depth[at]) / view.pixelsPerMetre;
            const glm::vec3 p = startOf(frame, view, {x + frame.guard.x, y + frame.guard.y}, eye, n, options.offset * footprint);
            const uint32_t pixel = y * part.x + x;
            const float seed = std::bit_cast<float>(shared::receiverSeed(options.seed, pixel));
            list.push_back({pixel, {{p.x, p.y, p.z, 0.0f}, {n.x, n.y, n.z, seed}}, std::vector<Sums>(falloffs, Sums{})});
        }
    return list;
}

}  // namespace

struct ScreenReference::Impl {
    gpu::Device& device;
    gpu::Program march;
    graph::Graph graph;
    graph::Executor executor;
    gpu::Image depth;
    gpu::Buffer table, sums;

    explicit Impl(gpu::Device& d) : device(d), graph(d), executor(d) { executor.setTiming(false); }

    void expect(gpu::Status status, const char* doing) const {
        if (status != gpu::Status::ok)
            throw scene::Error(fmt::format("the screen reference failed while {}: {}", doing, gpu::name(status)));
    }

    void upload(const CapturedFrame& frame, const std::vector<float>& tables, size_t sumBytes) {
        gpu::ImageDesc desc{VK_FORMAT_R32_SFLOAT, frame.size.x, frame.size.y};
        desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        if (!depth || !(depth.desc() == desc)) expect(gpu::Image::create(device, desc, "truth depth", depth), "creating its depth image");
        expect(gpu::upload(device, depth, std::as_bytes(std::span(frame.depth)), VK_IMAGE_LAYOUT_GENERAL), "uploading the depth");
        const uint64_t tableBytes = tables.size() * sizeof(float);
        if (!table || table.bytes() < tableBytes)
            expect(gpu::Buffer::create(device, tableBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                       gpu::Memory::device, "truth falloffs", table),
                "creating its tables");
        expect(gpu::upload(device, table, std::as_bytes(std::span(tables))), "uploading its tables");
        if (!sums || sums.bytes() < sumBytes)
            expect(gpu::Buffer::create(device, sumBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::readback, "truth sums", sums),
                "creating its result buffer");
    }

    void run(const shared::View& view, std::span<const shared::MarchReceiver> receivers, const shared::MarchConstants& constants) {
        device.nextFrame();
        march.refresh();
        graph.begin();
        graph::External external;
        external.image = depth.handle();
        external.view = depth.view();
        external.desc = depth.desc();
        external.layout = external.layoutAfter = VK_IMAGE_LAYOUT_GENERAL;
        const graph::ImageId z = graph.import("truth depth", external);
        const graph::BufferId result = graph.import("truth sums", sums, graph::Graph::Shared::written);
        graph.pass("truth.march", march)
            .read(graph.upload("truth view", view))
            .read(z)
            .read(graph.upload("truth receivers", receivers.data(), receivers.size_bytes()))
            .read(graph.import("truth falloffs", table, graph::Graph::Shared::constant))
            .write(result)
            .constants(constants)
            .keep()
            .dispatch(uint32_t(receivers.size()) * kBatch);
        graph.pass("truth.readback").use(result, graph::Access::hostRead).keep().record([](const graph::PassContext&) {});
        gpu::Status recorded = gpu::Status::ok;
        expect(device.runNow([&](VkCommandBuffer cmd) { recorded = executor.execute(graph, cmd); }), "marching rays");
        expect(recorded, "recording its pass");
    }
};

ScreenReference::ScreenReference(gpu::Device& device, const gpu::ShaderLibrary& shaders) : m_impl(std::make_unique<Impl>(device)) {
    m_impl->expect(gpu::Program::compute(device, shaders, "truth/march.comp", {}, m_impl->march), "creating its pipeline");
}

ScreenReference::~ScreenReference() {
    if (m_impl) m_impl->device.waitIdle();
}

Reference ScreenReference::trace(const CapturedFrame& frame, std::span<const RayFalloff> falloffs, const ScreenOptions& options) {
    if (!frame.hasNormals()) throw scene::Error("the frame has no normals; capture them, or reconstruct them from depth");
    if (falloffs.empty() || falloffs.size() > kMaxFalloffs)
        throw scene::Error(fmt::format("{} falloffs; the screen reference takes 1 to {} at a time", falloffs.size(), kMaxFalloffs));
    if (!(options.thickness > 0.0f)) throw scene::Error(fmt::format("the thickness is {} m; it must be above 0", options.thickness));
    float length = 0.0f;
    for (const RayFalloff& falloff : falloffs) length = std::max(length, falloff.reach);
    if (!std::isfinite(length)) throw scene::Error("the screen reference needs falloffs of finite reach; use the world reference");
    Impl& impl = *m_impl;
    if (frame.size.x > impl.device.caps().maxImageSize || frame.size.y > impl.device.caps().maxImageSize)
        throw scene::Error(fmt::format(
            "{} x {} pixels are more than this device's {} a side", frame.size.x, frame.size.y, impl.device.caps().maxImageSize));

    const auto start = std::chrono::steady_clock::now();
    const glm::uvec2 part = frame.visible();
    Reference out = emptyReference(part.x, part.y, falloffs);
    std::vector<Pending> all = receiversOf(frame, options, falloffs.size());
    const Schedule schedule(options);
    const size_t perReceiver = falloffs.size() * kBatch;
    impl.device.waitIdle();
    impl.upload(frame, tabulate(falloffs), std::max<size_t>(std::min<size_t>(all.size(), kReceivers), 1) * perReceiver * sizeof(float));

    const shared::View view = frame.view();
    const auto reportProgress = [&](float done) {
        if (options.progress && !options.progress(done)) throw scene::Error("the reference was cancelled");
    };
    std::vector<shared::MarchReceiver> batch;
    for (size_t first = 0; first < all.size(); first += kReceivers) {
        std::vector<Pending*> active;
        const size_t end = std::min(all.size(), first + kReceivers);
        for (size_t i = first; i < end; ++i) active.push_back(&all[i]);
        for (uint32_t point = 0; !active.empty() && point < schedule.last;) {
            // Points until the next test of the error, in dispatches of at most kPoints.
            const uint32_t goal = point < schedule.first ? schedule.first : std::min(point + schedule.step, schedule.last);
            const uint32_t points = std::min(goal - point, kPoints);
            batch.clear();
            for (const Pending* pending : active) batch.push_back(pending->receiver);
            shared::MarchConstants constants{uint32_t(batch.size()), point, points, uint32_t(falloffs.size()), length,
                std::min(options.thickness, 1e30f), frame.near, options.tolerance / view.pixelsPerMetre, kTableSize, {}};
            impl.run(view, batch, constants);
            point += points;

            const auto* results = reinterpret_cast<const float*>(impl.sums.mapped());
            for (size_t i = 0; i < active.size(); ++i)
                for (size_t f = 0; f < falloffs.size(); ++f)
                    for (uint32_t s = 0; s < kBatch; ++s) active[i]->sums[f][s] += results[i * perReceiver + f * kBatch + s];
            if (point < schedule.first) continue;
            std::erase_if(active, [&](Pending* pending) {
                float worst = 0.0f;
                for (size_t f = 0; f < falloffs.size(); ++f) {
                    const Estimate e = estimate(pending->sums[f], point);
                    out.channels[f].obscurance.values[pending->pixel] = e.mean;
                    out.channels[f].error.values[pending->pixel] = e.error;
                    worst = std::max(worst, e.error);
                }
                out.rays.values[pending->pixel] = float(point * kBatch);
                return worst <= schedule.target;
            });
            // By points, not by receivers: active receivers can finish at any point.
            reportProgress((float(first) + float(end - first) * float(point) / float(schedule.last)) / float(all.size()));
        }
        for (size_t i = first; i < end; ++i) out.totalRays += uint64_t(out.rays.values[all[i].pixel]);
    }
    if (options.progress) options.progress(1.0f);
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return out;
}

}  // namespace obscura::truth
