// What the player has done so far: the state between frames of the windowed game, changed by keys and panels alike.
#pragma once

#include <string>
#include <vector>

#include "app/statistics.h"
#include "choice.h"
#include "engine.h"
#include "keys.h"
#include "measures.h"
#include "player.h"
#include "recording.h"
#include "stage.h"

namespace obscura::game {

class Session {
public:
    Session(const Options& options, Stage& stage, Engine& engine);

    Options options;  // as given; only its camera is used later on
    Stage& stage;
    Engine& engine;
    Choice choice;
    Choice other;            // side B of the comparison; its falloff is not used
    bool comparing = false;
    float split = 0.5f, differenceRange = 0.25f;
    Player player;
    app::Statistics statistics{240};

    render::View view = render::View::final;
    std::string passView;
    float time = 0.0f;       // seconds, of the world
    float pace = 1.0f;       // world seconds a second
    float exposure = 1.0f, guard = 0.1f;
    render::Voxelization voxels;
    render::VoxelSlice slice;
    bool paused = false;
    bool following = false;  // the camera moves by itself: flythrough, path or lens
    bool cut = true;         // the next frame's camera or time jumped
    bool showOverlay = true, showKeys = false;
    bool wantsScreenshot = false, wantsFullScreen = false, wantsQuit = false;
    std::string notice;      // one line, shown for a while
    double noticeUntil = 0.0;
    std::vector<std::string> passNames;  // of the last frame, for the view menu

    void act(Action action, int key);
    // Moves time and camera on by so many real seconds.
    void advance(const app::Window& window, float seconds, bool keysTaken);
    scene::Camera camera() const { return m_camera; }
    render::FrameOptions frame(VkExtent2D size);
    void say(const std::string& line);
    void selectMethod(size_t index);
    void setComparing(bool on);
    // A divider that is grabbed follows the pointer; grabbed it can be where no panel lies. True while it is.
    bool dragDivider(const app::Window& window, bool onPanel);
    std::string comparison() const;  // as options of the command line
    void follow(bool on);    // the camera moves by itself; off: it is the player's, where it is
    std::shared_ptr<Measures> measures;  // null: nothing is measured
    // Why the measures have no reference, or the command that makes it.
    std::string referenceHint(const Measures::Reading& reading) const;
    void startReplay();      // of options.camera's path, or of what was recorded last
    void stopRecording();    // writes the file, if any key was recorded; says so, or what went wrong
    bool replaying() const { return m_replayed.has_value(); }
    Recorder recorder;
    // Of a replay: the path and where its frames begin.
    std::filesystem::path replayFile;
    float replayStart = 0.0f;
    void scrub(float to);    // jumps to a time

    // Rounds of the loop right after another method was chosen, against all others, milliseconds.
    app::Series switches{"switch", {}}, steady{"steady", {}};
    void measured(double milliseconds);

private:
    void stepTime(float seconds);
    void compareAct(Action action);
    bool m_dragging = false;
    std::optional<uint32_t> m_replayed;  // the replay's frame that is shown next
    scene::Camera m_camera;
    CameraChoice m_follow;
    size_t m_lastMethod;
    uint32_t m_switchRounds = 0;  // rounds that still count as those of a switch
    uint64_t m_frames = 0;
};

}  // namespace obscura::game
