// The player's camera: flies, or walks on the floor.
#pragma once

#include <glm/glm.hpp>

#include "app/window.h"
#include "scene/camera.h"

namespace obscura::game {

// The area of a walker.
struct Ground {
    float floor = 0.0f;
    glm::vec2 min{-1e6f}, max{1e6f};  // x and z
};

class Player {
public:
    static constexpr float kEyeHeight = 1.7f;  // metres

    void look(const scene::Camera& from);  // copies position, direction and field of view
    scene::Camera camera() const;
    // Held keys and mouse of one frame. `speed` in metres a second.
    void update(const app::Window& window, float seconds, float speed, const Ground& ground);
    void moveTo(const glm::vec3& eye) { m_position = eye; }
    bool moved() const { return m_moved; }  // in the last update
    bool walking = false;

private:
    scene::Camera m_lens;
    glm::vec3 m_position{0.0f};
    float m_yaw = 0.0f, m_pitch = 0.0f;  // radians; yaw 0 looks along -z
    float m_fall = 0.0f;                 // metres a second, downwards
    bool m_moved = false;
};

}  // namespace obscura::game
