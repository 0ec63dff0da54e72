// The command line as a struct. Everything that can be judged without a device or a scene is judged here.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "candidate.h"
#include "render/voxel_volume.h"

namespace obscura::evaluate {

enum class Job { evaluate, gallery, checkBaseline, renewBaseline };

// Where a scene is looked at from.
struct CameraChoice {
    enum class Kind { own, lens, path, file } kind = Kind::own;  // own: the manifest's view, else the file's first camera
    std::string text;            // as it was written
    std::filesystem::path file;  // path (empty: the scene's flythrough), file
    int lens = 0;
    float at = 0.0f;             // path: seconds
};
CameraChoice cameraOf(const std::string& text);  // throws app::Complaint

// How references are made.
struct RayChoice {
    uint32_t rays = 4096;        // at most, a pixel
    float targetError = 0.005f;  // standard error at which a pixel stops; 0: always `rays`
    uint32_t seed = 1;
    bool cache = true;
    uint32_t every = 1;          // pixels from judged pixel to judged pixel, in rows and columns; no others are traced
};

// Against what is judged: references that are rendered, or a file of them.
struct ReferenceChoice {
    bool world = false, screen = false;
    std::filesystem::path file;
    std::string channel;         // empty: the one named after the falloff
};

struct Options {
    Job job = Job::evaluate;
    // Frames: a captured one, or scenes x cameras.
    std::filesystem::path capture, captureCamera;
    std::vector<std::string> scenes;
    std::vector<CameraChoice> cameras;
    bool usualCameras = false;   // `cameras` were not asked for: those that a scene lacks are left out
    std::optional<float> time;   // seconds; empty: a flythrough's own time, else 0
    glm::uvec2 size{640, 360};
    float guard = 0.1f;
    bool skipMasked = false;
    render::Voxelization voxels;
    // What is judged, and against what.
    std::vector<Candidate> candidates;
    std::vector<FalloffChoice> falloffs;
    ReferenceChoice reference;
    RayChoice rays;
    uint32_t frames = 12, warmUp = 3, rounds = 1;
    bool errorsOnly = false;     // eA alone, no regions or perceptual metrics: what a gate compares
    // What is written.
    std::filesystem::path json, out, page, captureOut, baseline;
    // Device.
    std::string device, validation = "off";
    bool verbose = false;
};

// Throws app::Complaint. Nothing when the line asked for help or a list, which has been printed.
std::optional<Options> parseOptions(int argc, const char* const* argv);

}  // namespace obscura::evaluate
