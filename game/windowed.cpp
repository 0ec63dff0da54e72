// The windowed game: its loop, screenshots and shader reload.
#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "app/overlay.h"
#include "app/presenter.h"
#include "input.h"
#include "jobs.h"
#include "panels.h"

namespace obscura::game {

namespace fs = std::filesystem;

namespace {

constexpr double kReloadEvery = 250.0;  // milliseconds between checks for edited shaders
constexpr double kIdleWait = 0.1;       // seconds, while the window has no image to draw into

class Game {
public:
    // `begun`: when the program started, ms of app::now().
    Game(const Options& options, app::Window& window, app::Presenter& presenter, Engine& engine, Stage& stage, double begun)
        : m_options(options),
          m_window(window),
          m_presenter(presenter),
          m_engine(engine),
          m_session(options, stage, engine),
          m_begun(begun) {}

    void run();
    Session& session() { return m_session; }

private:
    void drawFrame();
    void reload();
    void remember();
    void warmUp();
    void takeScreenshot(graph::Graph& graph, graph::ImageId picture, fs::path file, bool last);
    void makeOverlay(VkFormat format);
    const Options& m_options;
    app::Window& m_window;
    app::Presenter& m_presenter;
    Engine& m_engine;
    Session m_session;
    std::unique_ptr<app::Overlay> m_overlay;
    std::vector<std::string> m_shaderErrors;  // as last printed
    uint64_t m_firstFrame = 0;                // timings of earlier frames (warm-up) are not plotted
    // Methods that have not been run yet: one after each of the first pictures, so that no switch to one is a hitch.
    std::vector<const ao::MethodInfo*> m_cold;
    uint64_t m_shown = 0;
    bool m_overlayTried = false;
    bool m_idle = false;  // the last iteration drew nothing
    bool m_announced = false;
    double m_lastFrame = 0.0;
    double m_begun;  // when the program started, ms
};

void Game::makeOverlay(VkFormat format) {
    m_overlayTried = true;
    std::string error;
    m_overlay = app::Overlay::create(m_engine.device(), m_window, format, m_options.uiScale, error);
    if (!m_overlay) fmt::print(stderr, "obscura: {}; the game continues without panels\n", error);
}

void Game::takeScreenshot(graph::Graph& graph, graph::ImageId picture, fs::path file, bool last) {
    m_engine.expect(m_engine.capture().add(graph, picture,
                        [this, file = std::move(file), last](app::Picture&& done) {
                            try {
                                app::writePng(file, done);
                                m_session.say("wrote " + file.string());
                                fmt::print("wrote {}\n", file.string());
                                std::fflush(stdout);
                            } catch (const app::Complaint& complaint) {
                                if (last) throw;  // requested on the command line: reported by the exit code
                                m_session.say(complaint.what());
                                fmt::print(stderr, "obscura: {}\n", complaint.what());
                            }
                        }),
        "taking a screenshot");
}

void Game::drawFrame() {
    graph::Graph& graph = m_engine.graph();
    app::Frames& frames = m_engine.frames();
    m_engine.expect(frames.begin(graph), "waiting for a frame");
    m_engine.capture().collect();
    if (graph.timings().frame >= m_firstFrame) m_session.statistics.add(graph.timings());
    m_session.noteCost();
    m_idle = !m_presenter.acquire(frames.slot());
    if (m_idle) return m_engine.expect(frames.end(graph), "idling");

    const render::FrameOptions frame = m_session.frame(m_presenter.size());
    const render::Outputs outputs = m_engine.renderer().add(graph, m_session.stage.world, frame);
    if (m_session.measures)
        m_engine.expect(
            readInto(m_session.measures, m_engine.capture(), graph, outputs, measuredFrame(frame, m_session.stage.world, m_shown)),
            "reading samples back");
    m_session.passNames.clear();
    for (const graph::Graph::Written& written : graph.written())
        if (std::find(m_session.passNames.begin(), m_session.passNames.end(), written.pass) == m_session.passNames.end())
            m_session.passNames.push_back(written.pass);
    const bool last = m_options.frames && m_shown + 1 >= *m_options.frames;
    if (m_session.wantsScreenshot)
        takeScreenshot(graph, outputs.color, app::freshName((m_session.options.out / "obscura").string(), ".png"), false);
    m_session.wantsScreenshot = false;
    if (m_session.wantsCommand) {
        const std::string command = m_session.command(m_presenter.size());
        glfwSetClipboardString(m_window.handle(), command.c_str());
        m_session.say("copied: " + command);
        fmt::print("{}\n", command);
        std::fflush(stdout);
    }
    m_session.wantsCommand = false;
    if (last && !m_options.screenshot.empty()) takeScreenshot(graph, outputs.color, m_options.screenshot, true);
    if (!m_overlayTried) makeOverlay(graph.desc(outputs.color).format);
    if (m_overlay) {
        m_overlay->beginFrame();
        drawPanels(m_session);
        m_overlay->add(graph, outputs.color, frames.slot());
    }
    m_presenter.add(graph, outputs.color);
    m_engine.expect(frames.end(graph, m_presenter.acquired(), m_presenter.rendered()), "drawing");
    m_engine.expect(m_presenter.present(), "presenting");
    ++m_shown;
    if (last) m_window.close();
}

void Game::reload() {
    if (m_engine.shaders().poll()) {
        m_session.say("shaders reloaded");
        fmt::print("shaders reloaded\n");
    }
    std::vector<std::string> errors = m_engine.shaders().errors();
    if (errors == m_shaderErrors) return;
    m_shaderErrors = std::move(errors);
    for (const std::string& error : m_shaderErrors) fmt::print("shader error: {}\n", error);
    std::fflush(stdout);
}

void Game::remember() {
    if (m_options.settings.empty()) return;
    try {
        std::vector<Argument> settings = m_session.settings();
        if (m_window.isFullScreen()) settings.push_back({"--full-screen", ""});
        else settings.push_back({"--size", fmt::format("{:.0f}x{:.0f}", m_window.screenSize().x, m_window.screenSize().y)});
        writeSettings(m_options.settings, settings);
    } catch (const app::Complaint& complaint) {
        fmt::print(stderr, "obscura: the settings are not remembered: {}\n", complaint.what());
    }
}

void Game::warmUp() {
    constexpr uint64_t kFirst = 2;  // pictures before the first one
    if (m_cold.empty() || m_shown < kFirst) return;
    const ao::MethodInfo& info = *m_cold.back();
    m_cold.pop_back();
    m_session.say(fmt::format("preparing the other methods: {}", info.id));
    m_engine.warmUp(m_options, m_session.stage, info);
    m_firstFrame = m_engine.device().frame() + 1;
    m_session.cut = true;
    if (m_cold.empty()) m_session.startMeasuring();
}

void Game::run() {
    double lastReload = 0.0;
    m_cold.assign(ao::methods().begin(), ao::methods().end());
    std::erase(m_cold, &m_session.choice.info());
    std::reverse(m_cold.begin(), m_cold.end());
    m_firstFrame = m_engine.device().frame() + 1;
    m_lastFrame = app::now();
    while (!m_window.closing()) {
        if (m_idle) m_window.waitEvents(kIdleWait);
        m_window.poll();
        const bool typing = m_overlay && m_overlay->wantsKeys();
        if (!typing) handleKeys(m_window, m_session);
        if (m_session.wantsQuit) break;
        if (m_session.wantsFullScreen) m_window.toggleFullScreen();
        m_session.wantsFullScreen = false;
        // Mouse look starts outside the panels and continues over them, with the pointer hidden.
        const bool onPanel = m_overlay && m_overlay->wantsMouse();
        m_session.dragDivider(m_window, onPanel);
        m_window.captureMouse(m_session.mouseLook || (m_window.button(GLFW_MOUSE_BUTTON_RIGHT) && (m_window.mouseCaptured() || !onPanel)));

        const double begun = app::now();
        const double since = begun - m_lastFrame;
        m_lastFrame = begun;
        m_session.advance(m_window, float(since * 1e-3), typing);
        if (m_engine.reloads() && begun - lastReload > kReloadEvery) {
            lastReload = begun;
            reload();
        }
        const bool wasIdle = m_idle;
        warmUp();
        drawFrame();
        if (m_shown == 1 && !std::exchange(m_announced, true)) {
            fmt::print("first picture after {:.2f} s. F1 shows the keys.\n", (app::now() - m_begun) * 1e-3);
            std::fflush(stdout);
        }
        if (!m_idle && !wasIdle) {
            // The whole iteration: with frames in flight a hitch may show in a later one, at its wait.
            m_session.statistics.addCpu(m_engine.frames().recordMilliseconds(), since);
            m_session.measured(app::now() - begun);
        }
    }
    if (m_session.recorder.running()) m_session.stopRecording();
    remember();
    if (m_session.comparing) fmt::print("compared: {}\n", m_session.comparison());
    m_engine.expect(m_engine.frames().wait(), "finishing the last frame");
    m_engine.capture().collect(true);
    if (!m_session.switches.values.empty())
        fmt::print("worst frame at a switch {:.2f} ms ({} switches), median frame {:.2f} ms\n", m_session.switches.worst(),
            m_session.switches.values.size(), m_session.steady.median());
}

}  // namespace

int playWindowed(const Options& options) {
    const double begun = app::now();
    if (!options.out.empty()) app::expectFolder(options.out);
    if (!options.screenshot.empty()) app::expectWritable(options.screenshot);
    std::string error;
    auto window = app::Window::open("Obscura", int(options.size.width), int(options.size.height), error);
    if (!window) return runWithoutWindow(options, "no window: " + error);

    Stage stage(options.scene, options.bare, options.animation);
    stage.camera(options.camera, options.time);
    for (const std::string& remark : stage.remarks) fmt::print(stderr, "obscura: {}\n", remark);
    stage.dropToys(options.toys, options.time);
    auto engine = std::make_unique<Engine>(options, window.get());
    auto presenter = app::Presenter::create(engine->device(), *window, options.vsync, error);
    if (!presenter) {
        engine.reset();
        window.reset();
        return runWithoutWindow(options, error);
    }
    const bool recommends = !options.namesMethod && !options.switchTest;
    engine->prepare(options, stage, recommends ? std::vector<const ao::MethodInfo*>() : preparedMethods(options));
    std::optional<Recommendation> recommendation;
    if (recommends) {
        constexpr double kSeconds = 1.0;
        const double budget = options.budget.value_or(engine->device().caps().software ? kSoftwareBudget : kBudget);
        recommendation = recommend(engine->costs(options, stage, candidates(), budget, kSeconds), budget);
    }
    fmt::print(
        "Obscura: {} on {}, {} methods; started in {:.2f} s (device {:.2f}, scene {:.2f}, pipelines {:.2f}, warm-up {:.2f}; pipeline "
        "cache {})\n",
        stage.info.title, engine->device().caps().deviceName, Choice::count(), engine->started.total(), engine->started.device,
        engine->started.scene, engine->started.pipelines, engine->started.warmUp, engine->started.cacheFound ? "found" : "not found");
    std::fflush(stdout);
    if (options.switchTest) {
        switchTest(options, *engine, stage);
    } else {
        if (options.fullScreen) window->toggleFullScreen();
        Game game(options, *window, *presenter, *engine, stage, begun);
        if (recommendation) {
            fmt::print("recommended: {}\n", recommendation->reason());
            game.session().useRecommendation(std::move(*recommendation));
        }
        game.run();
    }
    const int code = reportValidation(options, *engine);
    presenter.reset();
    return code;
}

}  // namespace obscura::game
