// Rendered references on disk, under a hash of everything that determines them. A reference takes minutes; a tool that is
// started again finds it here.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "scene/hash.h"
#include "truth/screen_reference.h"
#include "truth/world_reference.h"

namespace obscura::truth {

using scene::Hash;

// Keys. They cover: the posed triangles themselves (so the scene's bytes, time and animation), the models' hashes (textures
// of masked materials), geometry options, the frame's receivers and camera, names, samples and reaches of the falloffs, and
// the ray options that change the result. Not covered, because they change nothing: threads and progress.
std::string worldKey(std::span<const scene::PosedPrimitive> primitives, const WorldGeometry& geometry, const CapturedFrame& frame,
                     std::span<const RayFalloff> falloffs, const WorldOptions& options);
std::string screenKey(const CapturedFrame& frame, std::span<const RayFalloff> falloffs, const ScreenOptions& options);

// What determines a world reference and is known before anything is posed or drawn: the world's instances, its time if anything in it
// moves, the camera but for its near plane, the visible size, geometry options, the falloff. Not the rays.
std::string viewKey(const scene::World& world, float time, const scene::Camera& camera, glm::uvec2 visible, const WorldGeometry& geometry,
                    const RayFalloff& falloff);

class ReferenceCache {
public:
    using Warn = std::function<void(const std::string& line)>;
    // The folder is made when first written to. An empty one turns the cache off. `warn` hears of broken files and of a
    // folder that cannot be written (once); the work goes on without.
    explicit ReferenceCache(std::filesystem::path folder = scene::cacheFolder(), Warn warn = {});

    // From disk (fromCache is set), or made now and written: to a temporary name, then renamed.
    Reference get(const std::string& key, const std::function<Reference()>& make);
    std::filesystem::path fileOf(const std::string& key) const;
    // Notes that the reference of `key` is what is seen under a view key, for whoever cannot trace; the last one noted stays.
    void note(const std::string& viewKey, const std::string& key) const;
    // The reference noted; nothing where there is none, or where it cannot be read.
    std::optional<Reference> find(const std::string& viewKey) const;

private:
    std::filesystem::path m_folder;
    Warn m_warn;
    bool m_complained = false;
};

}  // namespace obscura::truth
