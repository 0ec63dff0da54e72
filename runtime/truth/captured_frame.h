// A captured frame: linear depth and geometric normals, guard band included, with their camera. The input of references and metrics.
// Two files: NAME.capture.exr (float channels Z, N.X, N.Y, N.Z) and NAME.json:
//
//   "verticalFovDegrees": 60        of the visible part
//   "visible": [320, 180]           px
//   "guardBand": [32, 18]           px on each side; the EXR has visible + 2 * guardBand pixels
//   "near": 0.1                     m
// optional:
//   "eye": [x,y,z], "target": [..], "up": [..]   the camera in world space; up defaults to +y.
//                                   Without eye and target, eye space is world space.
//   "depth": "linear" | "device"    Z is -z in metres (default), or the value of a depth buffer
//   "projection": [16 numbers]      eye -> Vulkan clip space of the whole image, columns. The depth convention (reversed,
//                                   infinite, orthographic, off-centre, flipped y) is read from it. Default: reversed with
//                                   infinite far plane, from the fields above.
//   "skyDepth": 10000               linear depths from here on are sky (default 10000; device depth: the far plane)
//   "normals": "eye" | "world"      the space of N (default eye); "world" needs eye and target
// Other fields are ignored. A capture without N.X, N.Y and N.Z has no normals (`normals` stays empty).
#pragma once

#include <optional>

#include <glm/glm.hpp>

#include "scene/camera.h"
#include "shared/view.h"
#include "truth/picture.h"

namespace obscura::truth {

struct CapturedFrame {
    glm::uvec2 size{0};                   // px, guard band included
    glm::uvec2 guard{0};                  // px on each side
    float verticalFov = 1.0471976f;       // radians, of the visible part
    float near = 0.05f;                   // m
    float skyDepth = 1e4f;                // m; linear depths from here on are sky
    glm::mat4 projection{1.0f};           // eye -> clip of the whole image
    std::optional<scene::Camera> camera;  // empty: eye space is world space
    std::vector<float> depth;             // linear, m; rows top to bottom
    std::vector<glm::vec3> normals;       // eye space, unit, zero for sky; empty if the capture has none

    glm::uvec2 visible() const { return size - 2u * guard; }
    size_t index(uint32_t x, uint32_t y) const { return size_t(y) * size.x + x; }  // whole image
    size_t visibleIndex(uint32_t x, uint32_t y) const { return index(x + guard.x, y + guard.y); }
    bool isSky(size_t i) const { return depth[i] >= skyDepth; }
    bool showsSurface() const;  // a pixel of the visible part is not sky
    bool hasNormals() const { return !normals.empty(); }
    glm::vec3 eyePosition(uint32_t x, uint32_t y) const;  // of the pixel's centre, whole image; not for sky
    glm::mat4 worldFromEye() const;                       // identity without a camera
    shared::View view() const;                            // the camera as uniform block of GPU passes
    Plane visibleDepth() const;                           // without the guard band
    std::vector<uint8_t> visibleMask() const;             // 0 for sky, else 1; without the guard band

    // Reconstructs normals from depth: on each axis, the smaller of the differences to the two neighbours.
    void reconstructNormals();
    // Throws scene::Error, one line with `name`, unless sizes agree, depths are finite and positive, normals are unit.
    void check(const std::string& name) const;
};

// Inverse of packNormal() in shaders/shared/octahedral.glsl.
glm::vec3 unpackNormal(uint32_t bits);

// A frame filled with sky, with the renderer's projection; the caller sets depth and normals.
CapturedFrame emptyFrame(glm::uvec2 visible, glm::uvec2 guard, float verticalFov, float near, std::optional<scene::Camera> camera = {});

// `stem` is the path of NAME, with or without ".json" or ".capture.exr". Throws scene::Error, one line: file, field or channel and pixel,
// what would be right.
CapturedFrame readCapture(const std::filesystem::path& stem);

// Writes both files, each atomically, with linear depth and eye-space normals.
void writeCapture(const std::filesystem::path& stem, const CapturedFrame& frame);

}  // namespace obscura::truth
