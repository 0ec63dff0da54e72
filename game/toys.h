// The toasters that walk in a scene: those of the manifest keep to their animation; dropped ones walk as it does, but walls, each other and
// the player stop them, and the player can pick them up and throw them. Their instances' placements follow.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "app/content.h"
#include "physics.h"
#include "scene/camera.h"
#include "scene/world.h"

namespace obscura::game {

class Toys {
public:
    static constexpr size_t kMost = 64;  // dropped by the player

    // `world` already holds the scene; `model` has toys ("toaster_1", ...) or is null. Adds the groups of `info`.
    Toys(scene::World& world, const app::SceneInfo& info, std::shared_ptr<const scene::Model> model);
    bool empty() const { return m_kinds.empty(); }  // the model has none

    // One that stands at `at` on the floor at this time, or at the nearest free place. False if kMost are dropped or there are no toys.
    bool drop(const glm::vec3& at, float turn, float time);
    void removeLast();
    size_t dropped() const { return m_dropped.size(); }

    // Moves them from the time of the last call to this one. After a jump in time they stay where they are. `player`: pushes them; null:
    // there is none. `wait` for the walls, which a thread prepares when the first toy is dropped: otherwise they are missing until then.
    struct Pusher {
        scene::Camera camera;
        bool standing;
    };
    void advance(float time, const Pusher* player, bool wait);
    // Picks up the dropped toy that the camera looks at, within reach; or throws the one that it holds. What happened, for the player.
    enum class Grabbed { nothing, picked, thrown };
    Grabbed pickOrThrow(const scene::Camera& camera);
    // Where a standing player gets to whose eye wants to move.
    glm::vec3 slide(const glm::vec3& from, const glm::vec3& to);

private:
    // A toy of the model: root node of its subtree, and the animated node between its feet that moves it.
    struct Kind {
        int root, feet;
        float ground = 0.0f;  // lowest height of the feet over the animation
        glm::vec3 halfSize{0.0f};
        std::vector<glm::vec3> track;  // x, z, turn about y of the feet, at equal times over the animation
    };
    struct Toy {
        uint32_t instance;
        size_t kind;
        float scale, offset;  // seconds ahead of the world
        glm::vec3 at;         // where it was dropped
        uint32_t body = 0;
    };
    glm::mat4 steps(const Kind& kind, float time) const;
    void place(const Toy& toy, float time);
    void startPhysics(float time);
    void collectWalls(bool wait);
    glm::vec3 freePlace(const glm::vec3& at) const;
    scene::Instance& instance(uint32_t id);

    scene::World& m_world;
    const app::SceneInfo& m_info;
    std::shared_ptr<const scene::Model> m_model;
    float m_duration = 0.0f;
    std::vector<Kind> m_kinds;
    std::vector<Toy> m_groups, m_dropped;
    std::unique_ptr<Physics> m_physics;  // once a toy was dropped
    std::future<std::shared_ptr<Physics::Walls>> m_walls;
    std::optional<float> m_time;  // of the last call of advance()
    uint32_t m_held = 0;          // body
};

}  // namespace obscura::game
