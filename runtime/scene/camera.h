// Cameras and flythroughs. Eye space: right-handed, camera at the origin looking down -z, y up.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/gltf/gltf.h"
#include "scene/world.h"

namespace obscura::scene {

struct Camera {
    glm::vec3 eye{0.0f, 1.7f, 4.0f};     // world, metres
    glm::vec3 target{0.0f, 1.0f, 0.0f};  // world
    glm::vec3 up{0.0f, 1.0f, 0.0f};
    float fovY = 1.0471976f;       // radians, of the visible part (the guard band adds to it)
    float nearPlane = 0.05f;       // metres; orthographic: may be 0
    float farPlane = 0.0f;         // metres; 0: at infinity (orthographic: at 1e4 times the near distance)
    float orthoHalfHeight = 0.0f;  // > 0: orthographic, half the visible height in metres
    bool operator==(const Camera&) const = default;

    glm::mat4 view() const;  // world -> eye
    // Eye -> clip, Vulkan: y down, depth reversed (1 at the near plane, 0 at the far plane). `size`: px of the whole image, guard band
    // included; `visible`: px of the part that fovY spans. Orthographic cameras have linear depth.
    glm::mat4 projection(glm::vec2 size, glm::vec2 visible) const;
};

// A camera that shows the bounds in a three-quarter view.
Camera frame(const Bounds& bounds);
// The camera of a posed glTF node; `index` counts the nodes with a camera in Model::order. Its lengths are scaled by the instance's
// placement; scales of the file's nodes do not affect a lens.
Camera lensCamera(const Instance& instance, const Pose& pose, int index);
int lensCount(const Model& model);

// {"eye":[..],"target":[..],"up":[..],"verticalFovDegrees":60,"near":0.05}; eye and target are required.
Camera loadCamera(const std::filesystem::path& file);

// A flythrough: keys of {time, eye, target, fov}, Catmull-Rom (centripetal) in between, JSON in content/.
// {"name":..,"scene":..,"duration":s,"loop":bool,"keys":[{"time":0,"eye":[],"target":[],"verticalFovDegrees":60}],
//  "events":[...]} Unknown fields are an error that names them.
class CameraPath {
public:
    struct Key {
        float time = 0.0f;
        glm::vec3 eye{0.0f}, target{0.0f};
        float fovY = 1.0471976f;
    };
    std::string name;
    std::string scene;
    float duration = 0.0f;
    bool loop = true;
    std::vector<Key> keys;  // times strictly increasing, at least one; a loop returns to the first at its time + duration
    std::string events;     // the file's JSON array, kept for save(); empty if it has none

    Camera at(float time) const;
    void save(const std::filesystem::path& file) const;  // temporary name, then rename
};
CameraPath loadCameraPath(const std::filesystem::path& file);
// Once around the bounds in 24 s, as far away and as high as frame().
CameraPath orbit(const Bounds& bounds);

}  // namespace obscura::scene
