// What is flown: entries of content/flythroughs.json, made into a world and a camera for every frame.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.h"

namespace obscura::flythrough {

// A box that comes, moves or goes at a frame: an occluder whose receivers stay. Same name: same box.
struct Event {
    uint32_t frame = 0;
    std::string box;
    glm::vec3 size{1.0f};   // m
    glm::vec3 at{0.0f};     // of its centre, world
    bool gone = false;
};

struct Script {
    std::string name, title;
    std::string scene;                         // of content/scenes.json, or a glTF file
    std::optional<scene::Camera> camera;       // stands still
    std::filesystem::path path;                // or flies
    float start = 0.0f;                        // s, of path and animations
    float framesPerSecond = 30.0f;
    bool animated = true;                      // false: animations stand still at `start`
    std::string falloff = "quadratic:2";
    std::vector<Event> events;                 // by frame

    float timeAt(uint32_t frame) const { return start + float(frame) / framesPerSecond; }
};

// All of the manifest. Throws scene::Error or app::Complaint.
std::vector<Script> scripts();
// By name, or "FILE.json", "FILE.json@SECONDS": a recorded camera path. Throws app::Complaint that lists what there is. Its scene and
// path are there.
Script findScript(const std::string& name);

// A script ready to be drawn.
class Stage {
public:
    explicit Stage(const Script& script);      // loads; throws
    const scene::World& worldAt(uint32_t frame);  // frames in any order; valid until the next call
    scene::Camera cameraAt(uint32_t frame) const;
    float worldTimeAt(uint32_t frame) const { return m_script.animated ? m_script.timeAt(frame) : m_script.start; }
    const Script& script() const { return m_script; }

private:
    Script m_script;
    scene::World m_world;
    scene::CameraPath m_path;
    std::shared_ptr<const scene::Model> m_box;
    std::map<std::string, uint32_t> m_boxes;   // instances that stand in m_world, by name
};

}  // namespace obscura::flythrough
