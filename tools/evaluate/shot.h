// One frame that methods are judged on, wherever it came from.
#pragma once

#include <functional>
#include <memory>

#include "content.h"
#include "machine.h"
#include "options.h"
#include "scene/world.h"
#include "truth/captured_frame.h"

namespace obscura::evaluate {

struct Shot {
    std::string scene;    // "sponza", or the captured file's stem
    std::string camera;   // as in CameraChoice::text, "capture" for a captured frame
    float time = 0.0f;    // seconds
    truth::CapturedFrame frame;
    std::string remark;   // one line, where something had to be made up
    double seconds = 0.0; // loading and drawing the frame

    // The triangles behind the frame, for world references; null for a captured frame. Not posed before it is asked.
    std::shared_ptr<const scene::World> world;
    bool skipMasked = false;

    // A method's visibility (R16F, visible size) as part of a graph; `index` counts the frames since the last reset.
    std::function<graph::ImageId(graph::Graph&, const Candidate&, const ao::Falloff&, uint32_t index)> add;
    // The library behind `add`.
    ao::Library* library = nullptr;
    // Passes of `add` that draw the frame itself, whatever the method: no part of its cost.
    std::vector<std::string> framePasses;
};

// A scene loaded and on the GPU. Its shots hold until the machine makes another renderer. Throws app::Complaint or scene::Error.
class LoadedScene {
public:
    LoadedScene(Machine& machine, const std::string& nameOrPath);
    // Draws the frame once; options give size, guard band, time and voxels. Nothing where a usual camera is not to be had.
    std::optional<Shot> shot(const Options& options, const CameraChoice& camera);
    size_t triangles() const { return m_world->triangleCount(); }

private:
    Machine& m_machine;
    SceneFile m_file;
    std::shared_ptr<scene::World> m_world;
    double m_seconds = 0.0;  // loading, told with the first shot
};

// Each shot is made, handed over and dropped before the next, so that one scene is in memory at a time.
using TakeShot = std::function<void(Shot&)>;
void forEachShot(Machine& machine, const Options& options, const TakeShot& take);

// A frame of render::Outputs as it was read back: linear depth and packed normals, `size` with guard band.
truth::CapturedFrame capturedFrame(glm::uvec2 visible, const scene::Camera& camera, glm::uvec2 size, const std::vector<std::byte>& depth,
                                   const std::vector<std::byte>& normals);

// The two sources behind it.
void captureShot(Machine& machine, const Options& options, const TakeShot& take);
void sceneShots(Machine& machine, const Options& options, const TakeShot& take);
// What can be said of scenes and cameras without loading them: names, files. Throws app::Complaint.
void expectScenes(const Options& options);
size_t shotCount(const Options& options);

}  // namespace obscura::evaluate
