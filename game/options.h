// The command line as a struct. Everything that can be judged without a GPU or a scene is judged here.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <vulkan/vulkan_core.h>

#include "choice.h"
#include "render/renderer.h"

namespace obscura::game {

enum class Job { play, headless, listMethods, listScenes, listDevices };

// Where the camera is taken from.
struct CameraChoice {
    enum class Kind { scene, flythrough, file, lens, path, fixed } kind = Kind::scene;
    std::filesystem::path file;    // file, path
    int lens = 0;                  // the n-th camera of the scene's glTF
    std::optional<float> at;       // path: stand still at this time
    glm::vec3 eye{0.0f}, target{0.0f};
    std::optional<float> fovDegrees;  // replaces that of any kind
    bool replay = false;           // path: at fixed steps from `start`, whatever the clock says
    std::optional<float> start;    // of a replay; its first key's time unless given
};

struct Options {
    Job job = Job::play;
    bool json = false;
    std::string scene = "atrium";
    std::string device;
    std::string validation = "off";
    std::string pipelineCache;        // empty: the user's cache folder
    bool noPipelineCache = false;
    bool verbose = false;
    bool vsync = true;
    bool fullScreen = false;
    bool noPresent = false;
    VkExtent2D size{1280, 720};
    std::optional<uint32_t> frames;
    std::optional<uint32_t> switchTest;  // steady frames before each switch
    bool bare = false;                   // without the toasters that the scene's entry sets down
    float time = 0.0f;
    float step = 1.0f / 30.0f;
    float guard = 0.1f;
    float exposure = 1.0f;
    uint32_t toys = 0;                   // dropped at the start
    bool skipMasked = false;
    bool measure = false;
    render::Voxelization voxels;
    render::VoxelSlice slice;
    CameraChoice camera;
    Choice choice;
    std::optional<Choice> compare;       // the second side; its falloff is not used
    float split = 0.5f;
    float differenceRange = 0.25f;
    render::View view = render::View::final;
    std::string passView;
    std::filesystem::path screenshot;
    std::filesystem::path out;
    std::string commandLine;             // for the report
};

// Throws app::Complaint. Nothing when the line asked for help or the version, which has been printed.
std::optional<Options> parseOptions(int argc, const char* const* argv);

}  // namespace obscura::game
