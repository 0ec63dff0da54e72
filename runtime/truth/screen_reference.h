// The screen reference: the same rays marched through the guard-banded depth buffer, on the GPU, every texel that a ray
// crosses. It knows what a screen-space method can know, so it judges whether an implementation is right.
//
// A ray is blocked where it lies behind the depth buffer, by no more than `thickness`; rho takes the distance along the ray
// to that point. It escapes where it leaves the image (guard band included) or passes the camera. Sky blocks nothing.
#pragma once

#include <limits>
#include <memory>
#include <span>

#include "gpu/device.h"
#include "gpu/shader.h"
#include "truth/captured_frame.h"
#include "truth/reference.h"

namespace obscura::truth {

struct ScreenOptions : RayOptions {
    float thickness = std::numeric_limits<float>::infinity();  // m along the view axis, of whatever the depth buffer shows
    // A texel knows the depth at its centre only, so a slanted surface is a staircase. Rays start `offset` pixel footprints
    // along the normal (more than sqrt(1/2) clears the stairs at any slant) and are blocked when more than `tolerance`
    // footprints behind a texel.
    float offset = 0.75f;
    float tolerance = 0.5f;
};

class ScreenReference {
public:
    // `shaders` holds truth::shaders() and outlives this object, as the device does. Throws scene::Error when the pass
    // cannot be made.
    ScreenReference(gpu::Device& device, const gpu::ShaderLibrary& shaders);
    ~ScreenReference();

    // The visible part. At most kMaxFalloffs at a time, finite reaches. Uses the device's queue and waits for it; not while
    // a frame is being recorded. Throws scene::Error: no normals, falloffs, device lost, stopped.
    static constexpr size_t kMaxFalloffs = 8;
    Reference trace(const CapturedFrame& frame, std::span<const RayFalloff> falloffs, const ScreenOptions& options = {});

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

std::span<const gpu::EmbeddedShader> shaders();  // this room's, for ShaderLibrary::add

}  // namespace obscura::truth
