// State of the windowed game between frames; changed by keys and panels.
#pragma once

#include <string>
#include <vector>

#include "app/statistics.h"
#include "choice.h"
#include "engine.h"
#include "keys.h"
#include "measures.h"
#include "player.h"
#include "recommendation.h"
#include "recording.h"
#include "stage.h"

namespace obscura::game {

class Session {
public:
    Session(const Options& options, Stage& stage, Engine& engine);

    Options options;  // of the command line; after construction only the camera is read
    Stage& stage;
    Engine& engine;
    Choice choice;
    Choice other;  // side B of the comparison; its falloff is not used
    bool comparing = false;
    float split = 0.5f, differenceRange = 0.25f;
    Player player;
    app::Statistics statistics{240};

    render::View view = render::View::final;
    std::string passView;
    float time = 0.0f;  // seconds, of the world
    float pace = 1.0f;  // world seconds per second
    float exposure = 1.0f, guard = 0.1f;
    bool bentNormals = false;  // FrameOptions::bentNormals
    render::Antialiasing antialiasing = render::Antialiasing::temporal;
    render::Voxelization voxels;
    render::VoxelSlice slice;
    bool paused = false;
    bool following = false;  // the camera moves by itself: flythrough, path or lens
    bool cut = true;         // camera or time of the next frame jumped: histories are discarded
    bool mouseLook = false;  // the mouse looks around without a button
    bool showOverlay = true, showKeys = false;
    bool wantsScreenshot = false, wantsCommand = false, wantsFullScreen = false, wantsQuit = false;
    std::string notice;                  // one line, shown until noticeUntil
    double noticeUntil = 0.0;            // ms, of app::now()
    std::vector<std::string> passNames;  // of the last frame, for the view menu

    void act(Action action, int key);
    // Advances time and camera by real seconds. `keysTaken`: a panel reads the keyboard.
    void advance(const app::Window& window, float seconds, bool keysTaken);
    scene::Camera camera() const { return m_camera; }
    render::FrameOptions frame(VkExtent2D size);
    void say(const std::string& line);
    void selectMethod(size_t index);
    void setComparing(bool on);
    // Moves the divider with the pointer while it is dragged; a drag starts outside the panels. True while it is dragged.
    bool dragDivider(const app::Window& window, bool onPanel);
    std::string comparison() const;              // as command-line options
    std::vector<Argument> settings() const;      // that the next start takes over; no method if the recommended one is in use
    std::string command(VkExtent2D size) const;  // starts the game with the present frame
    // Of the device, measured at the start; empty if the command line or the settings chose a method.
    std::optional<Recommendation> recommendation;
    bool usesRecommendation() const { return recommendation && choice.values() == m_recommended; }
    void useRecommendation(Recommendation made);
    const std::optional<ao::Values>& recommended() const { return m_recommended; }
    KnownFigures figures;
    // Median GPU time of each method's obscurance when it was last shown, ms; 0: not yet. noteCost() follows the present one.
    std::vector<double> costs = std::vector<double>(Choice::count());
    void noteCost();
    void follow(bool on);                // on: flythrough or path; off: the player controls the camera from its current place
    std::shared_ptr<Measures> measures;  // null: measuring is off
    // Why there is no reference for a reading, or the command that traces it.
    std::string referenceHint(const Measures::Reading& reading) const;
    void startReplay();    // of the path of options.camera, or of the last recorded one
    void stopRecording();  // writes the file if a key was recorded; shows its name or the error
    bool replaying() const { return m_replayed.has_value(); }
    Recorder recorder;
    // Of a replay: its path, and the time of its first frame, s.
    std::filesystem::path replayFile;
    float replayStart = 0.0f;
    void scrub(float to);  // jumps to a time

    // Milliseconds of loop iterations: of those right after a method switch, and of all others.
    app::Series switches{"switch", {}}, steady{"steady", {}};
    void measured(double milliseconds);
    void startMeasuring();  // forgets these

private:
    void stepTime(float seconds);
    void compareAct(Action action);
    bool m_dragging = false;
    std::optional<uint32_t> m_replayed;  // next frame of the replay
    scene::Camera m_camera;
    CameraChoice m_follow;
    size_t m_lastMethod;
    std::optional<ao::Values> m_recommended;
    uint32_t m_switchIterations = 0;  // next loop iterations that count towards a switch
    uint64_t m_frames = 0;
};

}  // namespace obscura::game
