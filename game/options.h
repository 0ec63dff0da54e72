// The command line as a struct. Parsing checks everything that needs neither a GPU nor a scene.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>
#include <glm/glm.hpp>

#include "choice.h"
#include "render/renderer.h"

namespace obscura::game {

enum class Job { play, headless, listMethods, listScenes, listScene, listDevices };

// Source of the camera.
struct CameraChoice {
    enum class Kind { scene, flythrough, file, lens, path, fixed } kind = Kind::scene;
    std::filesystem::path file;  // file, path
    int lens = 0;                // the n-th camera of the scene's glTF
    std::optional<float> at;     // path: camera fixed at this time, s
    glm::vec3 eye{0.0f}, target{0.0f};
    std::optional<float> fovDegrees;  // replaces the field of view of any kind
    bool replay = false;              // path: fixed time steps from `start`, independent of the clock
    std::optional<float> start;       // of a replay, s; empty: time of the path's first key
};

struct Options {
    Job job = Job::play;
    bool json = false;
    std::string scene = "atrium";
    std::string animation = "all";
    std::string device;
    std::string validation = "off";
    std::string pipelineCache;  // empty: the user's cache folder
    bool noPipelineCache = false;
    bool verbose = false;
    bool vsync = true;
    bool fullScreen = false;
    bool noPresent = false;
    VkExtent2D size{1280, 720};
    std::optional<uint32_t> frames;
    std::optional<uint32_t> switchTest;  // steady frames before each switch
    bool bare = false;                   // without the toasters of the scene's manifest entry
    float time = 0.0f;
    float step = 1.0f / 30.0f;
    float guard = 0.1f;
    float exposure = 1.0f;
    std::optional<double> budget;    // ms of GPU time for obscurance; empty: by the kind of device
    bool namesMethod = false;        // a method, preset, resolve or parameter is given: none is recommended
    std::optional<float> uiScale;    // size of the panels' text; empty: by the monitor
    std::filesystem::path settings;  // file of remembered settings; empty: none
    uint32_t toys = 0;               // dropped at the start
    bool skipMasked = false;
    render::Antialiasing antialiasing = render::Antialiasing::temporal;
    bool bentNormals = false;  // of methods that have them: ambient light is taken from them
    bool measure = false;
    render::Voxelization voxels;
    render::VoxelSlice slice;
    CameraChoice camera;
    Choice choice;
    std::optional<Choice> compare;  // the second side; its falloff is not used
    float split = 0.5f;
    float differenceRange = 0.25f;
    render::View view = render::View::final;
    std::string passView;
    std::filesystem::path screenshot;
    std::filesystem::path out;
    std::string commandLine;  // written into the report
};

// Throws app::Complaint. Empty after printing help or the version.
std::optional<Options> parseOptions(int argc, const char* const* argv);

}  // namespace obscura::game
