// Flythroughs: entries of content/flythroughs.json, and the world and camera of every frame.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/content.h"
#include "scene/camera.h"

namespace obscura::flythrough {

// A box that appears, moves or disappears at a frame: a changing occluder above fixed receivers. Equal names are one box.
struct Event {
    uint32_t frame = 0;
    std::string box;
    glm::vec3 size{1.0f};  // m
    glm::vec3 at{0.0f};    // of its centre, world
    bool gone = false;
};

struct Script {
    std::string name, title;
    std::string scene;                    // of content/scenes.json, or a glTF file
    std::optional<scene::Camera> camera;  // fixed camera
    std::filesystem::path path;           // or camera path
    std::string view;                     // or a camera of any scene, as --camera names it
    std::string animation = "all";        // of app::animationOf()
    float start = 0.0f;                   // s, of path and animations
    float framesPerSecond = 30.0f;
    bool animated = true;  // false: animations stand still at `start`
    std::string falloff = "quadratic:2";
    std::vector<Event> events;  // by frame

    float timeAt(uint32_t frame) const { return start + float(frame) / framesPerSecond; }
};

// All entries of the manifest. Throws scene::Error or app::Complaint.
std::vector<Script> scripts();
// By name, or "FILE.json", "FILE.json@SECONDS": a recorded camera path. Throws app::Complaint, which lists the known
// names. The files of its scene and path exist.
Script findScript(const std::string& name);

// Any scene, by its name or a glTF file, seen by `view`: "orbit", or a camera as measure::cameraOf() reads it. Throws app::Complaint.
Script sceneScript(const app::SceneFile& scene, const std::string& view, const std::string& animation);

// A loaded script.
class Stage {
public:
    explicit Stage(const Script& script);         // loads; throws
    const scene::World& worldAt(uint32_t frame);  // frames in any order; valid until the next call
    scene::Camera cameraAt(uint32_t frame) const;
    float worldTimeAt(uint32_t frame) const { return m_script.animated ? m_script.timeAt(frame) : m_script.start; }
    const Script& script() const { return m_script; }
    uint64_t sceneHash() const { return m_world.instances().front().model->hash; }

private:
    Script m_script;
    scene::World m_world;
    scene::CameraPath m_path;
    std::optional<int> m_lens;    // the scene's camera that films
    std::optional<float> m_near;  // m, of paths through files
    std::shared_ptr<const scene::Model> m_box;
    std::map<std::string, uint32_t> m_boxes;  // instances of boxes in m_world, by name
};

}  // namespace obscura::flythrough
