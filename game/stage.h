// The loaded scene: its world, its cameras, and the toasters (toys) that walk in it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/content.h"
#include "options.h"
#include "scene/camera.h"
#include "scene/world.h"

namespace obscura::game {

class Stage {
public:
    static constexpr size_t kMostToys = 64;  // dropped by the player

    // `scene` is a name of the manifest or a path; `bare` leaves out the toys that the manifest sets down. Throws app::Complaint or
    // scene::Error.
    explicit Stage(const std::string& scene, bool bare = false, const std::string& animation = "all");

    scene::World world;
    app::SceneInfo info;
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

    // Adds a toy that stands at `at` on the floor at this time, or at the nearest free place, and walks from there. False if kMostToys are
    // dropped or toasters.glb is missing.
    bool dropToy(const glm::vec3& at, float turn, float time);
    void dropToys(uint32_t count, float time);  // around the floor point that the start camera looks at
    void removeToy();
    void clearToys();
    size_t toys() const { return m_dropped.size(); }
    bool hasToys() const { return m_toys != nullptr; }
    // Intersection of the view ray with the floor, or a point on the floor ahead if there is none nearby.
    glm::vec3 floorAhead(const scene::Camera& camera) const;
    float moveSpeed() const;  // metres a second that suit the scene's size

private:
    void describe();
    void loadToys(bool wanted);
    void placeGroup(const app::ToyGroup& group);
    glm::vec3 freePlace(const glm::vec3& at) const;
    std::shared_ptr<const scene::Model> m_toys;
    // A toy of m_toys: root node of its subtree, the animated node between its feet that moves it, and the lowest height of that node over
    // the animation.
    struct Toy {
        int root, feet;
        float ground;
    };
    std::vector<Toy> m_toyKinds;
    struct Dropped {
        uint32_t id;
        glm::vec3 at;
    };
    std::vector<Dropped> m_dropped;
    scene::CameraPath m_chosenPath;
    std::filesystem::path m_chosenFile;  // of m_chosenPath
};

// "name  title  where" lines of the manifest.
std::string sceneList();

}  // namespace obscura::game
