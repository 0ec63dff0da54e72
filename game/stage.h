// The loaded scene: its world, its cameras, and the toasters that walk in it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/content.h"
#include "options.h"
#include "scene/camera.h"
#include "scene/world.h"
#include "toys.h"

namespace obscura::game {

class Stage {
public:
    // `scene` is a name of the manifest or a path; `bare` leaves out the toys that the manifest sets down. Throws app::Complaint or
    // scene::Error.
    explicit Stage(const std::string& scene, bool bare = false, const std::string& animation = "all");

    scene::World world;
    app::SceneInfo info;
    std::unique_ptr<Toys> toys;        // never null
    scene::CameraPath path;            // the flythrough; an orbit if the scene has none
    scene::Bounds bounds;              // of the whole world at time 0
    std::vector<std::string> remarks;  // one line each, for the terminal
    std::string file;                  // path of the loaded glTF file
    double loadSeconds = 0.0;          // loading time

    scene::Camera startCamera() const;
    // The path of --camera path: or --path, read once. Throws app::Complaint.
    const scene::CameraPath& pathOf(const std::filesystem::path& file);
    // The camera of an option at a time.
    scene::Camera camera(const CameraChoice& choice, float time);
    bool moves(const CameraChoice& choice) const;  // the camera changes over time without input

    void dropToys(uint32_t count, float time);  // around the floor point that the start camera looks at
    // Intersection of the view ray with the floor, or a point on the floor ahead if there is none nearby.
    glm::vec3 floorAhead(const scene::Camera& camera) const;
    float moveSpeed() const;  // metres a second that suit the scene's size

private:
    void describe();
    std::shared_ptr<const scene::Model> toyModel();
    scene::CameraPath m_chosenPath;
    std::filesystem::path m_chosenFile;  // of m_chosenPath
};

// "name  title  where" lines of the manifest.
std::string sceneList();

}  // namespace obscura::game
