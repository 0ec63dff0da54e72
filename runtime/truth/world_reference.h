// The world reference: rays against the triangles themselves, traced on the CPU with Embree. It knows nothing of the
// screen but the receivers, so it judges whether a picture is good.
#pragma once

#include <memory>
#include <span>

#include "scene/world.h"
#include "truth/captured_frame.h"
#include "truth/reference.h"

namespace obscura::truth {

struct WorldGeometry {
    bool skipMasked = false;   // leave alpha-masked primitives out (the stored references of real scenes do)
    bool skipBlended = true;   // leave alpha-blended primitives out, as the G-buffer does
};

struct WorldOptions : RayOptions {
    uint32_t threads = 0;      // 0: as many as the machine has. The result does not depend on it, to the bit.
    bool packets = true;       // eight rays at a time; single rays give the same picture but for rounding
    // Rays start this far along the normal and as far towards the camera, times the distance to it (metres at 1 m): enough for
    // a float position, too little to see. Nothing lies between a visible point and the camera, so a point in the corner of
    // two walls comes free of both.
    float offset = 1e-4f;
};

class WorldReference {
public:
    struct Receiver {
        glm::vec3 position;    // world, m
        glm::vec3 normal;      // world, unit; zero: no receiver (sky)
        float scale = 1.0f;    // m; the offset is scaled by it: distance to the camera
        glm::vec3 towards{0};  // world: unit vector to the camera; zero: none looks
    };

    // Triangles of the posed primitives, both sides. Masked texels let rays through (texture alpha x factor x vertex alpha
    // against the cutoff). The models must outlive this object; the positions are copied.
    // Throws scene::Error when Embree refuses or a position is not finite (names the model and node).
    WorldReference(std::span<const scene::PosedPrimitive> primitives, const WorldGeometry& geometry = {});
    ~WorldReference();
    WorldReference(WorldReference&&) noexcept;

    // The visible part of a frame. Throws scene::Error when the frame has no normals or progress said stop.
    Reference trace(const CapturedFrame& frame, std::span<const RayFalloff> falloffs, const WorldOptions& options = {}) const;
    // Any receivers: the planes are receivers.size() x 1, or width pixels wide when given (receivers row by row).
    Reference trace(std::span<const Receiver> receivers, std::span<const RayFalloff> falloffs, const WorldOptions& options = {},
                    uint32_t width = 0) const;

    size_t triangles() const;
    double buildSeconds() const;

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

}  // namespace obscura::truth
