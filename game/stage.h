// The scene that is being played: its world, its toys, where its cameras stand.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "content.h"
#include "options.h"
#include "scene/camera.h"
#include "scene/world.h"

namespace obscura::game {

class Stage {
public:
    static constexpr size_t kMostToys = 64;  // dropped by the player

    // `scene` is a name of the manifest or a path; `bare` leaves out the toys that the manifest sets down. Throws app::Complaint or
    // scene::Error.
    explicit Stage(const std::string& scene, bool bare = false);

    scene::World world;
    SceneInfo info;
    scene::CameraPath path;               // the flythrough; an orbit where a scene brings none
    scene::Bounds bounds;                 // at time 0, of everything
    std::vector<std::string> remarks;     // one line each, for the terminal
    std::string file;                     // what was loaded
    double loadSeconds = 0.0;             // that this took

    scene::Camera startCamera() const;
    // The path of --camera path: or --path, read once. Throws app::Complaint.
    const scene::CameraPath& pathOf(const std::filesystem::path& file);
    // The camera that an option asks for, at a time.
    scene::Camera camera(const CameraChoice& choice, float time);
    bool moves(const CameraChoice& choice) const;  // does it change over time by itself?

    // Drops a toy that stands at `at` (its height is the floor's), or beside those dropped there before, at this time and
    // walks on from there. False at the limit or without toasters.glb.
    bool dropToy(const glm::vec3& at, float turn, float time);
    void dropToys(uint32_t count, float time);  // around the place the first camera looks at
    void removeToy();
    void clearToys();
    size_t toys() const { return m_dropped.size(); }
    bool hasToys() const { return m_toys != nullptr; }
    // Where a ray meets the floor, or the point ahead when it does not.
    glm::vec3 floorAhead(const scene::Camera& camera) const;
    float moveSpeed() const;  // metres a second that suit the scene's size

private:
    void loadNamed(const SceneInfo& named, bool bare);
    void loadFile(const std::filesystem::path& file);
    void loadToys(bool wanted);
    void placeGroup(const ToyGroup& group);
    glm::vec3 freePlace(const glm::vec3& at) const;
    std::shared_ptr<const scene::Model> m_toys;
    // A toy of m_toys: the node whose subtree it is, the node that carries it along (between its feet), and the lowest
    // height at which that ever is.
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
    std::filesystem::path m_chosenFile;  // that it was read from
};

// "name  title  where" lines of the manifest.
std::string sceneList();

}  // namespace obscura::game
