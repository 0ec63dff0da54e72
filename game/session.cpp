#include "session.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "ao/settings_text.h"
#include "app/files.h"

namespace obscura::game {

namespace {

constexpr float kFrame = 1.0f / 30.0f;  // step of the keys , and ., seconds
constexpr size_t kMaxPending = 3;       // frames that may wait for the measuring worker
constexpr float kGrab = 8.0f;           // distance from the divider at which it can be grabbed, screen units
constexpr float kDividerStep = 0.02f;   // of the width

}  // namespace

Session::Session(const Options& given, Stage& stage_, Engine& engine_)
    : options(given),
      stage(stage_),
      engine(engine_),
      choice(given.choice),
      comparing(given.compare.has_value()),
      split(given.split),
      differenceRange(given.differenceRange),
      view(given.view),
      passView(given.passView),
      time(given.time),
      exposure(given.exposure * stage_.info.exposure),
      guard(given.guard),
      bentNormals(given.bentNormals),
      antialiasing(given.antialiasing),
      voxels(given.voxels),
      slice(given.slice),
      m_lastMethod(given.choice.current()) {
    if (given.measure) act(Action::measure, 0);
    if (given.compare) other = *given.compare;
    else other = choice, other.selectNext(1);
    m_follow = options.camera;
    following = stage.moves(options.camera);
    if (!following) m_follow.kind = CameraChoice::Kind::flythrough;  // what L follows
    if (options.camera.replay) {
        replayFile = options.camera.file;
        startReplay();
    }
    m_camera = stage.camera(options.camera, time);
    player.look(m_camera);
}

void Session::say(const std::string& line) {
    constexpr double kShown = 4000.0;  // milliseconds
    notice = line;
    noticeUntil = app::now() + kShown;
}

void Session::selectMethod(size_t index) {
    if (index >= Choice::count()) return say(fmt::format("there are {} methods", Choice::count()));
    choice.select(index);
    say(fmt::format("{}: {}", choice.info().id, choice.info().title));
}

void Session::useRecommendation(Recommendation made) {
    m_recommended = candidates()[made.candidate];
    choice.select(std::string(m_recommended->info().id));
    choice.values() = *m_recommended;
    recommendation = std::move(made);
    say(recommendation->reason());
}

void Session::noteCost() {
    constexpr size_t kSettled = 8;  // frames of the last pass
    if (comparing || statistics.passes().empty() || m_switchIterations > 0) return;
    for (const app::Series& pass : statistics.passes())
        if (pass.name.starts_with(choice.info().id) && pass.values.size() < kSettled) return;
    costs[choice.current()] = obscuranceCost(statistics);
}

void Session::scrub(float to) {
    m_replayed.reset();
    time = std::max(0.0f, to);
    cut = true;
}

void Session::stepTime(float seconds) {
    paused = true;
    if (m_replayed) {  // whole frames
        const uint32_t shown = *m_replayed == 0 ? 0 : *m_replayed - 1;
        const scene::CameraPath& path = stage.pathOf(replayFile);
        m_replayed = std::max(1u, seconds < 0.0f ? shown : *m_replayed + 1);
        if (!path.loop) m_replayed = std::min(*m_replayed, replayFrames(path, replayStart));
        time = replayTime(replayStart, *m_replayed - 1);
        return;
    }
    time = std::max(0.0f, time + seconds);
    // A step of one frame is not a cut: histories stay valid.
}

void Session::setComparing(bool on) {
    comparing = on;
    if (!on && render::isDifference(view)) view = render::View::final;
}

void Session::compareAct(Action action) {
    if (action == Action::compare) return setComparing(!comparing), say(comparing ? "A | B" : "A alone");
    if (!comparing) return say("Press C to compare first");
    switch (action) {
        case Action::nextOther: other.selectNext(1); return say(fmt::format("B: {}: {}", other.info().id, other.info().title));
        case Action::swapSides: {
            const ao::Falloff falloff = choice.falloff;  // shared by both sides
            std::swap(choice, other);
            choice.falloff = falloff;
            return;
        }
        case Action::copySide: other = choice; return say(fmt::format("B: {}", label(other.values())));
        default: split = std::clamp(split + (action == Action::dividerLeft ? -kDividerStep : kDividerStep), 0.0f, 1.0f);
    }
}

bool Session::dragDivider(const app::Window& window, bool onPanel) {
    for (const app::Window::Click& click : window.clicked())
        if (comparing && !onPanel && click.button == GLFW_MOUSE_BUTTON_LEFT &&
            std::fabs(click.at.x - split * window.screenSize().x) <= kGrab)
            m_dragging = true;
    m_dragging = m_dragging && comparing && window.button(GLFW_MOUSE_BUTTON_LEFT);
    if (m_dragging) split = std::clamp(window.mouse().x / window.screenSize().x, 0.0f, 1.0f);
    return m_dragging;
}

std::string Session::comparison() const {
    std::vector<Argument> list = methodOptions(choice.values());
    list.push_back({"--compare", compareText(other.values())});
    list.push_back({"--falloff", ao::falloffText(choice.falloff)});
    list.push_back({"--split", fmt::format("{:.3f}", split)});
    return asText(list);
}

void Session::follow(bool on) {
    if (following && !on) player.look(m_camera);
    following = on;
    cut = cut || on;
    m_replayed.reset();
    if (on && m_follow.replay) m_follow = {.kind = CameraChoice::Kind::flythrough, .fovDegrees = options.camera.fovDegrees};
}

void Session::startReplay() {
    if (replayFile.empty()) return say("no recorded path: press R to start and to stop recording");
    const scene::CameraPath& path = stage.pathOf(replayFile);
    replayStart =
        options.camera.replay && replayFile == options.camera.file && options.camera.start ? *options.camera.start : path.keys.front().time;
    follow(true);
    m_follow = {.kind = CameraChoice::Kind::path, .file = replayFile, .fovDegrees = options.camera.fovDegrees, .replay = true};
    m_replayed = 0;
    time = replayStart;
    paused = false;
    say(fmt::format("replaying {}", replayFile.filename().string()));
}

void Session::stopRecording() {
    const scene::CameraPath path = recorder.finish();
    if (path.keys.empty()) return say("nothing was recorded");
    const std::filesystem::path file = app::freshName((options.out / "obscura").string(), ".path.json");
    try {
        path.save(file);
        replayFile = file;
        say(fmt::format("wrote {}: {:.1f} s; Y replays it", file.string(), path.duration));
        fmt::print("wrote {}\n", file.string());
        std::fflush(stdout);
    } catch (const scene::Error& error) {
        say(error.what());
        fmt::print(stderr, "obscura: {}\n", error.what());
    }
}

std::string Session::referenceHint(const Measures::Reading& reading) const {
    if (!replaying()) return "only replayed paths have references: R records one, Y replays it";
    if (!stage.info.toys.empty()) return "references leave out the game's own toasters: start the game with --bare";
    if (stage.toys->dropped() > 0) return "references leave out dropped toasters: Delete removes them";
    const scene::CameraPath& path = stage.pathOf(replayFile);
    const std::string from = replayStart == path.keys.front().time ? "" : fmt::format("@{}", replayStart);
    return fmt::format(
        "obscura-flythrough --flythrough {}{} --length {} --size {}x{} --falloff {} --method none --filter raw --no-pictures --out "
        "out/references",
        replayFile.string(), from, replayFrames(path, replayStart), reading.size.x, reading.size.y, ao::falloffText(choice.falloff));
}

void Session::act(Action action, int key) {
    switch (action) {
        case Action::quit:
            if (!std::exchange(mouseLook, false)) wantsQuit = true;
            break;
        case Action::captureMouse: mouseLook = !mouseLook; break;
        case Action::toggleOverlay: showOverlay = !showOverlay; break;
        case Action::toggleKeys: showKeys = !showKeys; break;
        case Action::screenshot: wantsScreenshot = true; break;
        case Action::fullScreen: wantsFullScreen = true; break;
        case Action::visibilityOnly: view = view == render::View::visibility ? render::View::final : render::View::visibility; break;
        case Action::nextView: {
            const auto at = std::find(std::begin(render::kViews), std::end(render::kViews), view);
            const auto next = std::find_if(at == std::end(render::kViews) ? at : at + 1, std::end(render::kViews),
                [&](render::View v) { return comparing || !render::isDifference(v); });
            view = next == std::end(render::kViews) ? render::kViews[0] : *next;
            say(fmt::format("view: {}", render::name(view)));
            break;
        }
        case Action::method: selectMethod(size_t(key - GLFW_KEY_1)); break;
        case Action::previousMethod:
        case Action::nextMethod:
            choice.selectNext(action == Action::nextMethod ? 1 : -1);
            say(fmt::format("{}: {}", choice.info().id, choice.info().title));
            break;
        case Action::nextPreset: {
            const auto& presets = choice.info().presets;
            if (presets.size() == 0) break;
            const ao::Preset* present = presetsOf(choice.values()).preset;
            const ao::Preset& next = present ? presets[(size_t(present - &presets[0]) + 1) % presets.size()] : presets[0];
            usePreset(choice.values(), next);
            say(fmt::format("{}: preset {}", choice.info().id, next.id));
            break;
        }
        case Action::compare:
        case Action::nextOther:
        case Action::swapSides:
        case Action::copySide:
        case Action::dividerLeft:
        case Action::dividerRight: compareAct(action); break;
        case Action::record:
            if (recorder.running()) return stopRecording();
            recorder.start(options.scene);
            say(paused ? "recording the camera path; world time is paused: Space resumes it, R stops recording"
                       : "recording the camera path; R stops");
            break;
        case Action::replay:
            if (replaying()) return follow(false), say("free camera");
            startReplay();
            break;
        case Action::measure: measures = measures ? nullptr : std::make_shared<Measures>(kMaxPending); break;
        case Action::copyCommand: wantsCommand = true; break;
        case Action::pause: paused = !paused; break;
        case Action::stepBack: stepTime(-kFrame); break;
        case Action::stepForward: stepTime(kFrame); break;
        case Action::faster:
            pace = std::min(pace * 2.0f, 8.0f);
            say(fmt::format("time x {:g}", pace));
            break;
        case Action::slower:
            pace = std::max(pace * 0.5f, 0.125f);
            say(fmt::format("time x {:g}", pace));
            break;
        case Action::toggleWalk:
            player.walking = !player.walking;
            follow(false);
            say(player.walking ? "walking" : "flying");
            break;
        case Action::toggleFlythrough:
            follow(!following);
            say(following ? "following the flythrough" : player.walking ? "walking" : "flying");
            break;
        case Action::resetCamera:
            follow(false);
            player.look(stage.startCamera());
            cut = true;
            break;
        case Action::dropToy: {
            const glm::vec3 away = m_camera.eye - m_camera.target;
            if (stage.toys->drop(stage.floorAhead(m_camera), std::atan2(away.x, away.z), time))
                say(fmt::format("{} of {} toasters dropped", stage.toys->dropped(), Toys::kMost));
            else
                say(stage.toys->empty() ? "toasters.glb is missing; build the target content, which makes it"
                                        : fmt::format("{} toasters is the maximum; Backspace removes one", Toys::kMost));
            break;
        }
        case Action::removeToy:
            stage.toys->removeLast();
            say(fmt::format("{} toasters dropped", stage.toys->dropped()));
            break;
        case Action::clearToys:
            while (stage.toys->dropped() > 0) stage.toys->removeLast();
            say("no toasters dropped");
            break;
        case Action::grabToy: {
            const Toys::Grabbed grabbed = stage.toys->pickOrThrow(m_camera);
            if (grabbed == Toys::Grabbed::nothing) say("no dropped toaster ahead within reach; T drops one");
            else say(grabbed == Toys::Grabbed::picked ? "picked up a toaster; H throws it" : "threw a toaster");
            break;
        }
    }
}

void Session::advance(const app::Window& window, float seconds, bool keysTaken) {
    constexpr float kLongest = 0.25f;  // seconds; longest time step, so that a hitch does not make the world jump
    seconds = std::min(seconds, kLongest);
    if (m_replayed && !paused) {
        const scene::CameraPath& path = stage.pathOf(replayFile);
        const uint32_t frames = replayFrames(path, replayStart);
        if (!path.loop && *m_replayed >= frames) {  // past the last frame: restart
            m_replayed = 0;
            cut = true;
        }
        time = replayTime(replayStart, (*m_replayed)++);
        if (!path.loop && *m_replayed == frames) {
            paused = true;
            say("last frame of the path; Space replays it again, Y stops the replay");
        }
    } else if (!paused) {
        time += seconds * pace;
    }
    if (!keysTaken) {
        const glm::vec3 from = player.camera().eye;
        player.update(window, seconds, stage.moveSpeed(), {stage.info.floor, stage.info.walkMin, stage.info.walkMax});
        if (player.walking && player.moved()) player.moveTo(stage.toys->slide(from, player.camera().eye));
        if (following && player.moved()) {  // camera input ends following
            follow(false);
        }
    }
    m_camera = following ? stage.camera(m_follow, time) : player.camera();
    const Toys::Pusher pusher{m_camera, player.walking};
    stage.toys->advance(time, following ? nullptr : &pusher, false);
    if (recorder.running() && !recorder.add(time, m_camera)) stopRecording();
}

render::FrameOptions Session::frame(VkExtent2D size) {
    if (choice.current() != m_lastMethod) m_switchIterations = engine.device().framesInFlight();
    m_lastMethod = choice.current();
    render::FrameOptions frame;
    frame.visible = size;
    frame.guard = guard;
    frame.camera = m_camera;
    frame.time = time;
    frame.method = &choice.values();
    frame.falloff = choice.falloff;
    frame.compare = comparing ? &other.values() : nullptr;
    frame.split = split;
    frame.differenceRange = differenceRange;
    frame.view = view;
    frame.passView = passView;
    frame.exposure = exposure;
    frame.bentNormals = bentNormals;
    frame.antialiasing = antialiasing;
    frame.cut = cut;
    frame.skipMasked = options.skipMasked;
    frame.sampleStep = measures ? measuredStep(size) : 0;
    frame.voxels = voxels;
    frame.slice = slice;
    frame.voxels.exact = false;  // voxels may be one frame late; rendering does not wait for them
    cut = false;
    return frame;
}

void Session::startMeasuring() {
    switches.values.clear();
    steady.values.clear();
    m_frames = 0;
}

void Session::measured(double milliseconds) {
    constexpr uint64_t kSettling = 10;  // first loop iterations, not counted
    if (++m_frames <= kSettling) return;
    // With frames in flight, a long GPU frame delays a later iteration, which waits for it.
    (m_switchIterations > 0 ? switches : steady).values.push_back(milliseconds);
    if (m_switchIterations > 0) --m_switchIterations;
}

}  // namespace obscura::game
