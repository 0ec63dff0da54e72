// The world reference: rays against the scene's triangles, traced on the CPU with Embree. Only the receivers come from the screen, so it
// measures the error of an image.
#pragma once

#include <memory>
#include <span>

#include "scene/world.h"
#include "truth/captured_frame.h"
#include "truth/reference.h"

namespace obscura::truth {

struct WorldGeometry {
    bool skipMasked = false;  // no alpha-masked primitives (as in the stored references of real scenes)
    bool skipBlended = true;  // no alpha-blended primitives (as in the G-buffer)
};

struct WorldOptions : RayOptions {
    uint32_t threads = 0;  // 0: one per logical processor. The result is the same to the bit for any number
    bool packets = true;   // packets of 8 rays; single rays give the same result up to rounding
    // Rays start at the receiver plus this fraction of the camera distance along the normal and towards the camera: more than the rounding
    // of a float position, less than visible. Since nothing is between a visible point and the camera, a point in the corner of two walls
    // is moved off both.
    float offset = 1e-4f;
    bool bentNormals = false;  // also gives Reference::Channel::bent; the rays are the same
};

class WorldReference {
public:
    struct Receiver {
        glm::vec3 position;    // world, m
        glm::vec3 normal;      // world, unit; zero: no receiver (sky)
        float scale = 1.0f;    // m, distance to the camera; scales the offset
        glm::vec3 towards{0};  // world, unit vector to the camera; zero: no camera
    };

    // Triangles of the posed primitives, two-sided. Rays pass masked texels (texture alpha x factor x vertex alpha below the cutoff). The
    // models must outlive this object; the positions are copied. Throws scene::Error if Embree fails or a position is not finite (with
    // model and node).
    WorldReference(std::span<const scene::PosedPrimitive> primitives, const WorldGeometry& geometry = {});
    ~WorldReference();
    WorldReference(WorldReference&&) noexcept;

    // The visible part of a frame. Throws scene::Error if the frame has no normals or progress() cancels.
    Reference trace(const CapturedFrame& frame, std::span<const RayFalloff> falloffs, const WorldOptions& options = {}) const;
    // Any receivers. The planes are `width` pixels wide, receivers row by row; 0: one row.
    Reference trace(std::span<const Receiver> receivers, std::span<const RayFalloff> falloffs, const WorldOptions& options = {},
        uint32_t width = 0) const;

    size_t triangles() const;
    double buildSeconds() const;

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

}  // namespace obscura::truth
