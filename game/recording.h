// The player's own camera path: written down as it is flown, flown again at fixed steps.
#pragma once

#include "scene/camera.h"

namespace obscura::game {

inline constexpr float kReplayRate = 30.0f;  // frames a second, as obscura-flythrough's

// A replay's world time at a frame; the same arithmetic as obscura-flythrough's, so that frames are the same to the bit.
inline float replayTime(float start, uint32_t frame) { return start + float(frame) / kReplayRate; }
// From `start` until the path's last key or, where it loops, once round; at least one.
uint32_t replayFrames(const scene::CameraPath& path, float start);

// Keys lie on the world's clock, at most one a replayed frame: a path belongs to what moved while it was flown.
class Recorder {
public:
    void start(const std::string& scene);  // of content/scenes.json, or a glTF file
    bool running() const { return m_running; }
    float seconds() const;                 // recorded so far
    // A time that does not go on (the world is paused) adds nothing. False: it went back, which a path cannot.
    bool add(float time, const scene::Camera& camera);
    scene::CameraPath finish();            // open, without keys if none was added

private:
    scene::CameraPath m_path;
    bool m_running = false;
};

}  // namespace obscura::game
