#include "player.h"

#include <algorithm>
#include <cmath>

namespace obscura::game {

namespace {

glm::vec3 forwardOf(float yaw, float pitch) { return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch)}; }

}  // namespace

void Player::look(const scene::Camera& from) {
    m_lens = from;
    m_position = from.eye;
    const glm::vec3 forward = glm::normalize(from.target - from.eye);
    m_pitch = std::asin(std::clamp(forward.y, -1.0f, 1.0f));
    m_yaw = std::atan2(forward.x, -forward.z);
    m_fall = 0.0f;
}

scene::Camera Player::camera() const {
    scene::Camera camera = m_lens;
    camera.eye = m_position;
    camera.target = m_position + forwardOf(m_yaw, m_pitch);
    camera.up = {0.0f, 1.0f, 0.0f};
    return camera;
}

void Player::update(const app::Window& window, float seconds, float speed, const Ground& ground) {
    const glm::vec3 before = m_position;
    const float yawBefore = m_yaw, pitchBefore = m_pitch;
    const auto axis = [&](int positive, int negative) { return float(window.held(positive)) - float(window.held(negative)); };

    constexpr float kPerPixel = 0.0025f, kPerSecond = 1.2f;  // radians
    if (window.mouseCaptured()) {
        m_yaw += window.mouseMoved().x * kPerPixel;
        m_pitch -= window.mouseMoved().y * kPerPixel;
    }
    const app::Window::Gamepad& pad = window.gamepad();
    m_yaw += (axis(GLFW_KEY_RIGHT, GLFW_KEY_LEFT) + 2.0f * pad.right.x) * kPerSecond * seconds;
    m_pitch += (axis(GLFW_KEY_UP, GLFW_KEY_DOWN) + 2.0f * pad.right.y) * kPerSecond * seconds;
    constexpr float kSteepest = 1.5f;
    m_pitch = std::clamp(m_pitch, -kSteepest, kSteepest);

    const bool fast = window.held(GLFW_KEY_LEFT_SHIFT) || window.held(GLFW_KEY_RIGHT_SHIFT);
    const float step = speed * (fast ? 4.0f : 1.0f) * seconds;
    // Walking speed is independent of the pitch.
    const glm::vec3 forward = forwardOf(m_yaw, walking ? 0.0f : m_pitch);
    const glm::vec3 right(std::cos(m_yaw), 0.0f, std::sin(m_yaw));
    glm::vec3 wish = (axis(GLFW_KEY_W, GLFW_KEY_S) + pad.left.y) * forward + (axis(GLFW_KEY_D, GLFW_KEY_A) + pad.left.x) * right;
    if (!walking) wish.y += axis(GLFW_KEY_E, GLFW_KEY_Q) + pad.raise - pad.lower;
    if (glm::length(wish) > 1.0f) wish = glm::normalize(wish);
    m_position += step * wish;

    if (walking) {
        // Each axis is clamped separately, so that a walker slides along a wall.
        m_position.x = std::clamp(m_position.x, ground.min.x, ground.max.x);
        m_position.z = std::clamp(m_position.z, ground.min.y, ground.max.y);
        constexpr float kGravity = 9.81f;
        const float standing = ground.floor + kEyeHeight;
        m_fall += kGravity * seconds;
        m_position.y -= m_fall * seconds;
        if (m_position.y <= standing) {
            m_position.y = standing;
            m_fall = 0.0f;
        }
    } else {
        m_fall = 0.0f;
    }
    m_moved = m_position != before || m_yaw != yawBefore || m_pitch != pitchBefore;
}

}  // namespace obscura::game
