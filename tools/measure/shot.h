// A shot: one frame on which methods are measured, from a scene or a captured file.
#pragma once

#include <functional>
#include <memory>

#include "app/content.h"
#include "measure/machine.h"
#include "measure/measurement.h"
#include "scene/world.h"
#include "truth/captured_frame.h"

namespace obscura::measure {

struct Shot {
    std::string scene;   // "sponza", or the captured file's stem
    std::string camera;  // as in CameraChoice::text, "capture" for a captured frame
    float time = 0.0f;   // seconds
    truth::CapturedFrame frame;
    std::string remark;    // one line, if an input was missing and was reconstructed
    double seconds = 0.0;  // time of loading and drawing the frame

    // The posed triangles for world references, computed on first use; null for a captured frame.
    std::shared_ptr<const scene::World> world;
    bool skipMasked = false;

    // Adds a method's passes to a graph; returns visibility (R16F, visible size) and, if the candidate asks for them, bent normals
    // (R8G8B8A8_SNORM). `index` counts frames since the last reset.
    std::function<std::vector<graph::ImageId>(graph::Graph&, const Candidate&, const ao::Falloff&, uint32_t index)> add;
    // The library that `add` uses.
    ao::Library* library = nullptr;
    // Passes of `add` that draw the frame for every method; they do not count as the method's time.
    std::vector<std::string> framePasses;
};

// A loaded scene with its GPU data. Its shots are valid until the machine makes another renderer. Throws app::Complaint or scene::Error.
class LoadedScene {
public:
    LoadedScene(Machine& machine, const app::SceneFile& file, const std::string& animation = "all");
    // Draws the frame once; `what` gives size, guard band, time and voxels. Empty if a default camera does not exist in the scene.
    std::optional<Shot> shot(const Measurement& what, const CameraChoice& camera);
    size_t triangles() const { return m_world->triangleCount(); }

private:
    Machine& m_machine;
    app::SceneFile m_file;
    std::shared_ptr<scene::World> m_world;
    double m_seconds = 0.0;  // loading time, reported with the first shot
};

// Makes shots one after the other, so that one scene is in memory at a time.
using TakeShot = std::function<void(Shot&)>;
void forEachShot(Machine& machine, const Measurement& what, const TakeShot& take);

// A frame read back from render::Outputs: linear depth and packed normals, `size` with guard band.
truth::CapturedFrame capturedFrame(glm::uvec2 visible, const scene::Camera& camera, glm::uvec2 size, const std::vector<std::byte>& depth,
    const std::vector<std::byte>& normals);

// The two sources of forEachShot().
void captureShot(Machine& machine, const Measurement& what, const TakeShot& take);
void sceneShots(Machine& machine, const Measurement& what, const TakeShot& take);
// Checks names and files of scenes and cameras without loading them. Throws app::Complaint.
void expectScenes(const Measurement& what);
size_t shotCount(const Measurement& what);

}  // namespace obscura::measure
