// References on disk, named by a hash of all their inputs. Tracing a reference takes minutes; later runs load it from here.
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

// Keys of references. Inputs: the posed triangles (hence the scene's bytes, time and animation), the models' hashes (textures of masked
// materials), geometry options, the frame's receivers and camera, names, samples and reaches of the falloffs, and the ray options except
// threads and progress, which do not change the result.
std::string worldKey(std::span<const scene::PosedPrimitive> primitives, const WorldGeometry& geometry, const CapturedFrame& frame,
    std::span<const RayFalloff> falloffs, const WorldOptions& options);
std::string screenKey(const CapturedFrame& frame, std::span<const RayFalloff> falloffs, const ScreenOptions& options);

// Key of a view, from the inputs of a world reference that are known before anything is posed or drawn: the world's instances, its time if
// it has animations, the camera except its near plane, the visible size, geometry options, the falloff. Ray options are not included.
std::string viewKey(const scene::World& world, float time, const scene::Camera& camera, glm::uvec2 visible, const WorldGeometry& geometry,
    const RayFalloff& falloff);

class ReferenceCache {
public:
    using Warn = std::function<void(const std::string& line)>;
    // The folder is created at the first write. An empty path turns the cache off. `warn` gets a line for each damaged file and, once, for
    // a folder that cannot be written; neither is an error.
    explicit ReferenceCache(std::filesystem::path folder = scene::cacheFolder(), Warn warn = {});

    // Loads the reference (fromCache is set), or makes and stores it: under a temporary name, then renamed.
    Reference get(const std::string& key, const std::function<Reference()>& make);
    std::filesystem::path fileOf(const std::string& key) const;
    // Stores `key` as the reference of a view, for programs that do not trace. A later call replaces it.
    void note(const std::string& viewKey, const std::string& key) const;
    // The reference of a view; empty if there is none or it cannot be read.
    std::optional<Reference> find(const std::string& viewKey) const;

private:
    std::filesystem::path m_folder;
    Warn m_warn;
    bool m_warned = false;
};

}  // namespace obscura::truth
