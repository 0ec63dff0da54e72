#include "recording.h"

#include <algorithm>
#include <cmath>

namespace obscura::game {

uint32_t replayFrames(const scene::CameraPath& path, float start) {
    const float seconds = path.loop ? path.duration : path.keys.back().time - start;
    const float frames = std::max(0.0f, seconds) * kReplayRate;
    // A loop ends before it repeats its first frame; an open path shows its last key. 1e-2 absorbs rounding.
    return std::max(1u, uint32_t(path.loop ? std::ceil(frames - 1e-2f) : std::floor(frames + 1e-2f) + 1.0f));
}

void Recorder::start(const std::string& scene) {
    m_path = {};
    m_path.name = "recorded in " + scene;
    m_path.scene = scene;
    m_path.loop = false;
    m_running = true;
}

float Recorder::seconds() const { return m_path.keys.empty() ? 0.0f : m_path.keys.back().time - m_path.keys.front().time; }

bool Recorder::add(float time, const scene::Camera& camera) {
    if (!m_path.keys.empty()) {
        const float last = m_path.keys.back().time;
        if (time < last) return false;
        if (time - last < 0.999f / kReplayRate) return true;
    }
    m_path.keys.push_back({time, camera.eye, camera.target, camera.fovY});
    return true;
}

scene::CameraPath Recorder::finish() {
    m_running = false;
    if (!m_path.keys.empty()) m_path.duration = m_path.keys.back().time - m_path.keys.front().time;
    return std::move(m_path);
}

}  // namespace obscura::game
