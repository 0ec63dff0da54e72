// The screen reference: the same rays, marched on the GPU through every texel of the depth buffer, guard band included, that a ray crosses.
// It has the information that a screen-space method has, so it measures the error of an implementation.
//
// A ray is blocked where it is behind the depth buffer by at most `thickness`; rho takes the distance along the ray to that point. It
// escapes where it leaves the image or passes the camera plane. Sky does not block.
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
    float thickness = std::numeric_limits<float>::infinity();  // m along the view axis, of every surface in the depth buffer
    // A texel has the depth of its centre, so a slanted surface is a staircase. Rays start `offset` pixel footprints along the normal (more
    // than sqrt(1/2) clears the staircase at any slant) and are blocked when more than `tolerance` footprints behind a texel.
    float offset = 0.75f;
    float tolerance = 0.5f;
};

class ScreenReference {
public:
    // `shaders` includes truth::shaders(). `device` and `shaders` must outlive this object. Throws scene::Error if the pipeline cannot be
    // created.
    ScreenReference(gpu::Device& device, const gpu::ShaderLibrary& shaders);
    ~ScreenReference();

    // Traces the visible part. 1 to kMaxFalloffs falloffs of finite reach. Uses the device's queue and waits for it; do not call it while a
    // frame is being recorded. Throws scene::Error: no normals, wrong falloffs, device lost, cancelled.
    static constexpr size_t kMaxFalloffs = 8;
    Reference trace(const CapturedFrame& frame, std::span<const RayFalloff> falloffs, const ScreenOptions& options = {});

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

std::span<const gpu::EmbeddedShader> shaders();  // this module's, for ShaderLibrary::add

}  // namespace obscura::truth
