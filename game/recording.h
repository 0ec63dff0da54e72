// Records the player's camera path; times of its replay in fixed steps.
#pragma once

#include "scene/camera.h"

namespace obscura::game {

inline constexpr float kReplayRate = 30.0f;  // frames a second, as obscura-flythrough's

// World time of a replay's frame, s. Same arithmetic as obscura-flythrough's, so that frames are bit-identical.
inline float replayTime(float start, uint32_t frame) { return start + float(frame) / kReplayRate; }
// Frames from `start` to the path's last key, or of one loop; at least 1.
uint32_t replayFrames(const scene::CameraPath& path, float start);

// Keys carry world time, at most one per replayed frame, so that a replay meets the same animation.
class Recorder {
public:
    void start(const std::string& scene);  // of content/scenes.json, or a glTF file
    bool running() const { return m_running; }
    float seconds() const;  // recorded so far
    // Adds nothing while the world is paused. False: time went backwards, which a path cannot store.
    bool add(float time, const scene::Camera& camera);
    scene::CameraPath finish();  // does not loop; has no keys if none was added

private:
    scene::CameraPath m_path;
    bool m_running = false;
};

}  // namespace obscura::game
