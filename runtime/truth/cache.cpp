// References on disk: one EXR per reference, named by its key.
#include "truth/cache.h"

#include <cmath>
#include <fstream>

#include <fmt/format.h>

namespace obscura::truth {
namespace {

// Cache versions: raise one when the same inputs give another result (rays, offsets, estimates).
constexpr uint32_t kVersion = 1, kScreenVersion = 2;
constexpr const char* kRays = "rays";
constexpr const char* kBent[] = {"bent_x", "bent_y", "bent_z", "bent_above"};  // of a BentReference

std::string channelName(const char* kind, size_t index, const std::string& name) { return fmt::format("{}.{:02}.{}", kind, index, name); }

void add(Hash& hash, const CapturedFrame& frame) {
    hash.add(frame.size.x).add(frame.size.y).add(frame.guard.x).add(frame.guard.y).add(frame.near).add(frame.skyDepth);
    hash.add(&frame.projection, sizeof frame.projection);
    const glm::mat4 worldFromEye = frame.worldFromEye();
    hash.add(&worldFromEye, sizeof worldFromEye);
    hash.add(frame.depth.data(), frame.depth.size() * sizeof(float));
    hash.add(frame.normals.data(), frame.normals.size() * sizeof(glm::vec3));
}

void add(Hash& hash, std::span<const RayFalloff> falloffs) {
    hash.add(falloffs.size());
    for (const RayFalloff& falloff : falloffs) {
        hash.add(falloff.name).add(falloff.reach).add(falloff.hard);
        const float end = std::isfinite(falloff.reach) ? falloff.reach : 100.0f;
        for (int i = 0; i <= 64 && !falloff.hard; ++i) hash.add(falloff.rho(end * float(i) / 64.0f));
    }
}

void add(Hash& hash, const RayOptions& options) {
    hash.add(options.minRays).add(options.maxRays).add(options.targetError).add(options.seed).add(options.stride);
}

Reference read(const std::filesystem::path& file) {
    Picture picture = readExr(file);
    Reference reference;
    const auto require = [&](bool valid) {
        if (!valid) throw scene::Error(file.string() + ": is not a stored reference");
    };
    const auto take = [&](const std::string& prefix) {
        for (Picture::Channel& channel : picture.channels)
            if (channel.name.starts_with(prefix)) return &channel;
        return static_cast<Picture::Channel*>(nullptr);
    };
    const auto plane = [&](Picture::Channel& channel) {
        Plane result(picture.width, picture.height);
        result.values = std::move(channel.values);
        for (const float value : result.values) require(std::isfinite(value));
        return result;
    };
    for (size_t i = 0;; ++i) {
        const std::string prefix = channelName("obscurance", i, "");
        Picture::Channel* obscurance = take(prefix);
        if (!obscurance) break;
        Picture::Channel* error = take(channelName("error", i, ""));
        require(error);
        reference.channels.push_back({obscurance->name.substr(prefix.size()), plane(*obscurance), plane(*error), {}});
        BentReference& bent = reference.channels.back().bent;
        for (size_t k = 0; k < 4; ++k)
            if (Picture::Channel* stored = take(channelName(kBent[k], i, ""))) (k < 3 ? bent.mean[k] : bent.above) = plane(*stored);
    }
    Picture::Channel* rays = take(kRays);
    require(rays && !reference.channels.empty());
    reference.rays = plane(*rays);
    for (const float count : reference.rays.values) reference.totalRays += uint64_t(count);
    reference.fromCache = true;
    return reference;
}

void write(const std::filesystem::path& file, const Reference& reference) {
    Picture picture;
    for (size_t i = 0; i < reference.channels.size(); ++i) {
        picture.add(channelName("obscurance", i, reference.channels[i].name), reference.channels[i].obscurance);
        picture.add(channelName("error", i, reference.channels[i].name), reference.channels[i].error);
        const BentReference& bent = reference.channels[i].bent;
        for (size_t k = 0; bent && k < 4; ++k)
            picture.add(channelName(kBent[k], i, reference.channels[i].name), k < 3 ? bent.mean[k] : bent.above);
    }
    picture.add(kRays, reference.rays);
    writeExr(file, picture);
}

}  // namespace

std::string worldKey(std::span<const scene::PosedPrimitive> primitives, const WorldGeometry& geometry, const CapturedFrame& frame,
    std::span<const RayFalloff> falloffs, const WorldOptions& options) {
    Hash hash;
    hash.add("world").add(kVersion).add(geometry.skipMasked).add(geometry.skipBlended).add(options.offset).add(options.packets);
    for (const scene::PosedPrimitive& posed : primitives) {
        hash.add(posed.model->hash).add(posed.primitive->material);
        hash.add(posed.positions.data(), posed.positions.size() * sizeof(glm::vec3));
        hash.add(posed.primitive->indices.data(), posed.primitive->indices.size() * sizeof(uint32_t));
    }
    add(hash, frame);
    add(hash, falloffs);
    add(hash, options);
    if (options.bentNormals) hash.add("bent");
    return "world-" + hash.hex();
}

std::string screenKey(const CapturedFrame& frame, std::span<const RayFalloff> falloffs, const ScreenOptions& options) {
    Hash hash;
    hash.add("screen").add(kScreenVersion).add(options.thickness).add(options.offset).add(options.tolerance);
    add(hash, frame);
    add(hash, falloffs);
    add(hash, options);
    return "screen-" + hash.hex();
}

std::string viewKey(const scene::World& world, float time, const scene::Camera& camera, glm::uvec2 visible, const WorldGeometry& geometry,
    const RayFalloff& falloff) {
    Hash hash;
    hash.add("view").add(kVersion).add(geometry.skipMasked).add(geometry.skipBlended).add(visible.x).add(visible.y);
    for (const scene::Instance& instance : world.instances()) {
        hash.add(instance.model->hash).add(&instance.placement, sizeof instance.placement);
        hash.add(instance.animation).add(instance.timeOffset).add(instance.root);
    }
    if (world.duration() > 0.0f) hash.add(time);
    for (const glm::vec3& v : {camera.eye, camera.target, camera.up}) hash.add(&v, sizeof v);
    hash.add(camera.fovY).add(camera.orthoHalfHeight).add(camera.farPlane);
    add(hash, {&falloff, 1});
    return "view-" + hash.hex();
}

ReferenceCache::ReferenceCache(std::filesystem::path folder, Warn warn) : m_folder(std::move(folder)), m_warn(std::move(warn)) {}

std::filesystem::path ReferenceCache::fileOf(const std::string& key) const { return m_folder / (key + ".exr"); }

void ReferenceCache::note(const std::string& viewKey, const std::string& key) const {
    if (m_folder.empty()) return;
    try {
        writeWhole(m_folder / viewKey, key.data(), key.size());
    } catch (const scene::Error&) {
        // get() has already warned about the folder.
    }
}

std::optional<Reference> ReferenceCache::find(const std::string& viewKey) const {
    std::string key;
    if (m_folder.empty() || !(std::ifstream(m_folder / viewKey) >> key)) return std::nullopt;
    try {
        return read(fileOf(key));
    } catch (const scene::Error&) {
        return std::nullopt;
    }
}

Reference ReferenceCache::get(const std::string& key, const std::function<Reference()>& make) {
    if (m_folder.empty()) return make();
    const std::filesystem::path file = fileOf(key);
    std::error_code error;
    if (std::filesystem::exists(file, error)) {
        try {
            return read(file);
        } catch (const scene::Error& broken) {
            if (m_warn) m_warn(fmt::format("{}; the reference is traced again", broken.what()));
        }
    }
    Reference reference = make();
    try {
        std::filesystem::create_directories(m_folder, error);
        write(file, reference);
    } catch (const scene::Error& unwritable) {
        if (m_warn && !m_warned) m_warn(fmt::format("{}; continuing without a cache", unwritable.what()));
        m_warned = true;
    }
    return reference;
}

}  // namespace obscura::truth
