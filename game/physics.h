// Rigid bodies on the floor of a scene (Bullet): upright boxes that walk, until something throws or knocks them over; then they tumble,
// come to rest and get up again. World space, metres, seconds. Deterministic: the same calls give the same places.
#pragma once

#include <memory>
#include <vector>

#include <glm/glm.hpp>

namespace obscura::game {

class Physics {
public:
    explicit Physics(float floor);  // height of an endless floor
    ~Physics();

    // Triangles that do not move, three corners each. Those that lie in the floor are left out. Any thread may make them.
    struct Walls;
    static std::shared_ptr<Walls> makeWalls(const std::vector<glm::vec3>& corners, float floor);
    void use(std::shared_ptr<Walls> walls);  // in place of those of before

    // A box that walks. `feet`: rotation and place of the middle of its bottom; its bottom's up is y.
    uint32_t add(const glm::vec3& halfSize, const glm::mat4& feet);
    // A box that others cannot move; place() moves it.
    uint32_t addFixed(const glm::vec3& halfSize, const glm::mat4& feet);
    void remove(uint32_t body);
    glm::mat4 feet(uint32_t body) const;
    void place(uint32_t body, const glm::mat4& feet);  // of a fixed or held one

    // Until the next call: metres a second to the body's right (x) and back (z), radians a second about y. One that tumbles ignores it.
    void walk(uint32_t body, const glm::vec2& velocity, float turn);
    bool walks(uint32_t body) const;
    void hold(uint32_t body);  // fixed until it is thrown
    void throwAway(uint32_t body, const glm::vec3& velocity, const glm::vec3& spin);
    // The first walking or tumbling body along a ray, not farther than `reach`; 0: none, or a wall stands before it.
    uint32_t firstAlong(const glm::vec3& from, const glm::vec3& direction, float reach) const;

    // The player: a ball about the eye, or an upright capsule from the floor to it, that pushes bodies.
    void player(const glm::vec3& eye, bool standing);
    void noPlayer();
    // How far a standing player whose eye is at `from` gets towards `to`: walls stop it, or it slides along them.
    glm::vec3 slide(const glm::vec3& from, const glm::vec3& to) const;

    void step(float seconds);

private:
    struct Impl;
    std::unique_ptr<Impl> m_impl;
};

}  // namespace obscura::game
