// What is measured: frames, candidates, falloffs, references, numbers of timed frames, and the device.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "measure/candidate.h"
#include "render/voxel_volume.h"

namespace obscura::measure {

// Camera of a scene.
struct CameraChoice {
    enum class Kind { own, lens, path, file } kind = Kind::own;  // own: the manifest's view, or the file's first camera if there is none
    std::string text;                                            // as given on the command line
    std::filesystem::path file;                                  // path (empty: the scene's flythrough), file
    int lens = 0;
    float at = 0.0f;  // path: seconds
};
CameraChoice cameraOf(const std::string& text);  // throws app::Complaint

// How references are made.
struct RayChoice {
    uint32_t rays = 4096;        // maximum per pixel
    float targetError = 0.005f;  // standard error at which tracing a pixel stops; 0: always `rays`
    uint32_t seed = 1;
    bool cache = true;
    bool bentNormals = false;  // also the mean unblocked direction, of world references
    uint32_t every = 1;        // step between evaluated pixels in rows and columns, px; no others are traced
};

// References: rendered ones, or a file.
struct ReferenceChoice {
    bool world = false, screen = false;
    std::filesystem::path file;
    std::string channel;  // empty: the channel named after the falloff
};

struct Measurement {
    // Frames: a captured frame, or scenes x cameras.
    std::filesystem::path capture, captureCamera;
    std::vector<std::string> scenes;
    std::string animation = "all";  // of app::animationOf()
    std::vector<CameraChoice> cameras;
    bool usualCameras = false;  // `cameras` are defaults: those that a scene lacks are skipped
    std::optional<float> time;  // seconds; empty: a flythrough's own time, else 0
    glm::uvec2 size{640, 360};
    float guard = 0.1f;
    bool skipMasked = false;
    render::Voxelization voxels;
    // Candidates and references.
    std::vector<Candidate> candidates;
    std::vector<FalloffChoice> falloffs;
    ReferenceChoice reference;
    RayChoice rays;
    uint32_t frames = 12, warmUp = 3, rounds = 1;
    // Device.
    std::string device, validation = "off";
    bool verbose = false;
};

}  // namespace obscura::measure
