// Shots of scenes: the sample's renderer draws depth and normals and runs the methods as in the game.
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "app/complaint.h"
#include "measure/shot.h"
#include "scene/json_text.h"

namespace obscura::measure {

namespace fs = std::filesystem;
using app::Complaint;

namespace {

// The file of a path camera: as given, or below a content folder; empty: the scene's flythrough.
std::optional<fs::path> pathFile(const CameraChoice& choice, const app::SceneFile& file) {
    if (choice.file.empty()) return file.flythrough;
    std::error_code ignored;
    if (fs::is_regular_file(choice.file, ignored)) return choice.file;
    return app::findContent(choice.file.string());
}

// Empty if a default camera does not exist in the scene.
std::optional<scene::Camera> cameraFor(
    const CameraChoice& choice, const app::SceneFile& file, const scene::World* world, float time, bool usual) {
    switch (choice.kind) {
        case CameraChoice::Kind::path: {
            const auto path = pathFile(choice, file);
            if (path) return scene::loadCameraPath(*path).at(choice.at);
            if (usual) return std::nullopt;
            throw Complaint(choice.file.empty()
                                ? fmt::format("--camera {}: {} has no flythrough of its own; name one: path:FILE.json@SECONDS", choice.text,
                                      file.info.name)
                                : fmt::format("--camera {}: no such file", choice.text));
        }
        case CameraChoice::Kind::file: {
            std::error_code ignored;
            if (!fs::is_regular_file(choice.file, ignored)) throw Complaint(fmt::format("--camera {}: no such file", choice.text));
            return scene::loadCamera(choice.file);
        }
        case CameraChoice::Kind::lens: {
            if (!world) return scene::Camera();
            const scene::Instance& first = world->instances().front();
            const int count = scene::lensCount(*first.model);
            if (choice.lens >= count)
                throw Complaint(fmt::format("--camera {}: {} has {} cameras; {}", choice.text, file.info.name, count,
                    count ? fmt::format("write scene:0 to scene:{}", count - 1) : "write own, path:FILE.json@SECONDS, or FILE.json"));
            return scene::lensCamera(first, scene::evaluate(*first.model, first.animation, time + first.timeOffset), choice.lens);
        }
        case CameraChoice::Kind::own: break;
    }
    if (file.named) return file.camera();
    if (!world) return scene::Camera();
    const scene::Instance& first = world->instances().front();
    if (scene::lensCount(*first.model) > 0)
        return scene::lensCamera(first, scene::evaluate(*first.model, first.animation, time + first.timeOffset), 0);
    return scene::frame(scene::bounds(*world, time));
}

float timeOf(const Measurement& what, const CameraChoice& camera) {
    return what.time ? *what.time : camera.kind == CameraChoice::Kind::path ? camera.at : 0.0f;
}

render::FrameOptions frameOptions(const Measurement& what, const scene::Camera& camera, float time) {
    render::FrameOptions frame;
    frame.visible = {what.size.x, what.size.y};
    frame.guard = what.guard;
    frame.camera = camera;
    frame.time = time;
    frame.view = render::View::visibility;  // without lighting
    frame.skipMasked = what.skipMasked;
    frame.voxels = what.voxels;
    return frame;
}

// Draws the frame once, without obscurance, and reads it back.
void capture(Machine& machine, const Measurement& what, const scene::World& world, const render::FrameOptions& wanted, Shot& shot) {
    const ao::Values none(*ao::methods()[0]);
    glm::uvec2 size(0);
    const Machine::Ran ran = machine.run(0, 1, [&](graph::Graph& graph, uint32_t) {
        render::FrameOptions frame = wanted;
        frame.method = &none;
        frame.cut = true;
        const render::Outputs outputs = machine.renderer().add(graph, world, frame);
        size = {graph.desc(outputs.linearDepth).width, graph.desc(outputs.linearDepth).height};
        return std::vector{outputs.linearDepth, outputs.normals};
    });
    shot.frame = capturedFrame(what.size, wanted.camera, size, ran.images[0], ran.images[1]);
    shot.frame.check(shot.scene + " " + shot.camera);
    for (const gpu::PassTime& pass : ran.passes)
        if (!pass.name.starts_with("prepare.")) shot.framePasses.push_back(pass.name);
}

}  // namespace

truth::CapturedFrame capturedFrame(glm::uvec2 visible, const scene::Camera& camera, glm::uvec2 size, const std::vector<std::byte>& depth,
    const std::vector<std::byte>& normals) {
    truth::CapturedFrame frame = truth::emptyFrame(visible, (size - visible) / 2u, camera.fovY, camera.nearPlane, camera);
    std::memcpy(frame.depth.data(), depth.data(), depth.size());
    std::vector<uint32_t> packed(frame.depth.size());
    std::memcpy(packed.data(), normals.data(), normals.size());
    for (size_t i = 0; i < packed.size(); ++i) {
        frame.depth[i] = std::min(frame.depth[i], frame.skyDepth);
        frame.normals[i] = frame.isSky(i) ? glm::vec3(0.0f) : truth::unpackNormal(packed[i]);
    }
    return frame;
}

void expectScenes(const Measurement& what) {
    for (const app::SceneFile& file : app::expectScenes(what.scenes))
        for (const CameraChoice& camera : what.cameras) cameraFor(camera, file, nullptr, 0.0f, what.usualCameras);
}

size_t shotCount(const Measurement& what) { return what.capture.empty() ? what.scenes.size() * what.cameras.size() : 1; }

LoadedScene::LoadedScene(Machine& machine, const app::SceneFile& file, const std::string& animation)
    : m_machine(machine), m_file(file), m_world(std::make_shared<scene::World>()) {
    const double begun = app::now();
    app::PlacedScene placed = app::loadScene(m_file, animation);
    m_world->add(std::move(placed.instance));
    for (const std::string& remark : placed.remarks) fmt::print(stderr, "{}\n", app::oneLine(remark));
    if (machine.newRenderer().load(*m_world) != gpu::Status::ok)
        throw Complaint(fmt::format("{}: cannot be uploaded to {}", m_file.file.string(), machine.deviceName()), app::kFailed);
    m_seconds = (app::now() - begun) * 1e-3;
}

std::optional<Shot> LoadedScene::shot(const Measurement& what, const CameraChoice& choice) {
    const double begun = app::now();
    Shot shot;
    shot.scene = m_file.info.name;
    shot.camera = scene::utf8(choice.text);
    shot.time = timeOf(what, choice);
    const auto camera = cameraFor(choice, m_file, m_world.get(), shot.time, what.usualCameras);
    if (!camera) return std::nullopt;
    const render::FrameOptions wanted = frameOptions(what, *camera, shot.time);
    capture(m_machine, what, *m_world, wanted, shot);
    shot.world = m_world;
    shot.skipMasked = what.skipMasked;
    shot.library = &m_machine.renderer().library();
    shot.add = [&renderer = m_machine.renderer(), world = m_world, wanted](
                   graph::Graph& graph, const Candidate& candidate, const ao::Falloff& falloff, uint32_t index) {
        render::FrameOptions frame = wanted;
        frame.method = &candidate.values;
        frame.falloff = falloff;
        frame.voxels = candidate.voxels.over(frame.voxels);
        frame.cut = index == 0;
        const render::Outputs drawn = renderer.add(graph, *world, frame);
        return candidate.values.bentNormals ? std::vector{drawn.visibility, drawn.bentNormals} : std::vector{drawn.visibility};
    };
    shot.seconds = (app::now() - begun) * 1e-3 + m_seconds;
    m_seconds = 0.0;
    return shot;
}

void sceneShots(Machine& machine, const Measurement& what, const TakeShot& take) {
    for (const app::SceneFile& file : app::expectScenes(what.scenes)) {
        LoadedScene scene(machine, file, what.animation);
        for (const CameraChoice& choice : what.cameras)
            if (auto shot = scene.shot(what, choice)) take(*shot);
    }
}

}  // namespace obscura::measure
