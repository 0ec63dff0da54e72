#include "physics.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <btBulletDynamicsCommon.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace obscura::game {

namespace {

constexpr float kStep = 1.0f / 120.0f;  // longest, seconds
constexpr float kPlayerRadius = 0.25f;  // metres
constexpr float kInFloor = 0.03f;       // triangles that reach no higher above the floor are the floor, metres
constexpr float kKnock = 1.2f;          // change of speed that knocks a walker over, m/s
constexpr float kSlow = 0.15f;          // below it a tumbling body counts as at rest, m/s and rad/s
constexpr float kRests = 0.5f;          // seconds at rest, after which it gets up
constexpr float kRising = 5.0f;         // rad/s at which it gets up
constexpr float kUpright = 0.05f;       // radians off upright at which it walks again
constexpr float kBlocked = 0.6f;        // seconds without progress, after which a walker turns away
constexpr float kTurnAway = 2.6f;       // radians
constexpr float kTurnSpeed = 3.0f;      // rad/s

enum class Gait { walks, tumbles, rises, fixed };

btVector3 bullet(const glm::vec3& v) { return {v.x, v.y, v.z}; }
glm::vec3 vector(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
btTransform bullet(const glm::mat4& m) {
    btTransform transform;
    transform.setFromOpenGLMatrix(glm::value_ptr(m));
    return transform;
}
btTransform upright(const btVector3& at) { return btTransform(btQuaternion::getIdentity(), at); }
glm::mat4 matrix(const btTransform& transform) {
    glm::mat4 m;
    transform.getOpenGLMatrix(glm::value_ptr(m));
    return m;
}

struct Body {
    std::unique_ptr<btBoxShape> shape;
    std::unique_ptr<btRigidBody> rigid;
    float halfHeight = 0.0f;
    Gait gait = Gait::walks;
    glm::vec2 velocity{0.0f};                            // wanted, in the body's space
    float turn = 0.0f;                                   // wanted
    float rested = 0.0f;                                 // seconds
    float wanted = 0.0f, walked = 0.0f, watched = 0.0f;  // metres wanted and walked in so many seconds
    float away = 0.0f;                                   // radians left to turn away
    bool held = false;

    void set(Gait next) {
        gait = next;
        rested = wanted = walked = watched = away = 0.0f;
        const bool upright = next == Gait::walks;
        rigid->setAngularFactor(upright ? btVector3(0, 1, 0) : btVector3(1, 1, 1));
        rigid->setFriction(upright ? 0.0f : 0.6f);
    }
};

// Nearest hit of a swept shape with what does not move.
struct WallCast : btCollisionWorld::ClosestConvexResultCallback {
    WallCast(const btVector3& from, const btVector3& to) : ClosestConvexResultCallback(from, to) {
        m_collisionFilterMask = btBroadphaseProxy::StaticFilter;
    }
};

}  // namespace

struct Physics::Walls {
    btTriangleMesh mesh;
    std::unique_ptr<btBvhTriangleMeshShape> shape;  // none without triangles
    btCollisionObject object;
};

struct Physics::Impl {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    float floor;
    btStaticPlaneShape floorShape;
    btCollisionObject ground;
    std::shared_ptr<Walls> walls;
    btSphereShape ball{kPlayerRadius};
    std::unique_ptr<btCapsuleShape> capsule;
    std::unique_ptr<btRigidBody> player;
    std::map<uint32_t, Body> bodies;
    uint32_t next = 1;

    explicit Impl(float height) : floor(height), floorShape(btVector3(0, 1, 0), height) {
        world.setGravity({0, -9.81f, 0});
        ground.setCollisionShape(&floorShape);
        ground.setFriction(1.0f);
        world.addCollisionObject(&ground, btBroadphaseProxy::StaticFilter, ~btBroadphaseProxy::StaticFilter);
    }
    ~Impl() {
        for (auto& [id, body] : bodies) takeOut(body);
        if (player) world.removeRigidBody(player.get());
        removeWalls();
        world.removeCollisionObject(&ground);
    }

    void removeWalls() {
        if (walls && walls->shape) world.removeCollisionObject(&walls->object);
    }

    uint32_t add(const glm::vec3& half, const glm::mat4& feet, bool fixed) {
        Body& body = bodies[next];
        body.shape = std::make_unique<btBoxShape>(bullet(half));
        body.shape->setMargin(0.02f * half.y);
        body.halfHeight = half.y;
        const float mass = fixed ? 0.0f : 1.0f;
        btVector3 inertia(0, 0, 0);
        if (!fixed) body.shape->calculateLocalInertia(mass, inertia);
        body.rigid = std::make_unique<btRigidBody>(mass, nullptr, body.shape.get(), inertia);
        body.rigid->setUserIndex(int(next));
        body.rigid->setActivationState(DISABLE_DEACTIVATION);
        body.rigid->setRestitution(0.3f);
        body.rigid->setDamping(0.02f, 0.2f);
        if (fixed) body.rigid->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
        body.set(fixed ? Gait::fixed : Gait::walks);
        place(body, feet);
        world.addRigidBody(body.rigid.get());
        return next++;
    }
    void place(Body& body, const glm::mat4& feet) {
        body.rigid->setWorldTransform(bullet(glm::translate(feet, glm::vec3(0.0f, body.halfHeight, 0.0f))));
    }
    void takeOut(Body& body) {
        if (!body.held) world.removeRigidBody(body.rigid.get());
    }

    // Velocities before a step.
    void steer(Body& body, float seconds) const {
        btRigidBody& rigid = *body.rigid;
        const btVector3 up = rigid.getWorldTransform().getBasis().getColumn(1);
        if (body.gait == Gait::walks) {
            const bool turnsAway = body.away != 0.0f;
            const float away = std::copysign(std::min(std::fabs(body.away), kTurnSpeed * seconds), body.away);
            const glm::vec2 pace = turnsAway ? glm::vec2(0.0f) : body.velocity;
            const btVector3 flat = rigid.getWorldTransform().getBasis() * btVector3(pace.x, 0, pace.y);
            rigid.setLinearVelocity({flat.x(), rigid.getLinearVelocity().y(), flat.z()});
            rigid.setAngularVelocity({0, turnsAway ? away / seconds : body.turn, 0});
            body.away -= away;
            body.wanted += flat.length() * seconds;
        } else if (body.gait == Gait::rises) {
            const btVector3 axis = up.cross(btVector3(0, 1, 0));
            const btVector3 about = axis.length() > 1e-3f ? axis.normalized() : rigid.getWorldTransform().getBasis().getColumn(0);
            rigid.setAngularVelocity(about * std::min(kRising, up.angle(btVector3(0, 1, 0)) / seconds * 0.25f));
        }
    }
    // What comes next for a body after a step of it from `before`.
    void settle(uint32_t id, Body& body, const btVector3& before, float seconds) const {
        btRigidBody& rigid = *body.rigid;
        const float lean = rigid.getWorldTransform().getBasis().getColumn(1).angle(btVector3(0, 1, 0));
        if (body.gait == Gait::walks) {
            body.walked += (rigid.getWorldTransform().getOrigin() - before).length();
            body.watched += seconds;
            if (body.watched < kBlocked) return;
            const bool blocked = body.wanted > 0.1f * body.halfHeight && body.walked < 0.4f * body.wanted;
            body.wanted = body.walked = body.watched = 0.0f;
            if (blocked) body.away = id % 2 ? kTurnAway : -kTurnAway;
        } else if (body.gait == Gait::tumbles) {
            const bool slow = rigid.getLinearVelocity().length() < kSlow && rigid.getAngularVelocity().length() < kSlow * 4.0f;
            body.rested = slow ? body.rested + seconds : 0.0f;
            if (body.rested > kRests) body.set(Gait::rises);
        } else if (body.gait == Gait::rises) {
            body.rested += seconds;
            if (lean < kUpright) {
                const btMatrix3x3& basis = rigid.getWorldTransform().getBasis();
                const btVector3 back = basis.getColumn(2);
                btTransform stood(btQuaternion(btVector3(0, 1, 0), std::atan2(back.x(), back.z())), rigid.getWorldTransform().getOrigin());
                rigid.setWorldTransform(stood);
                rigid.setInterpolationWorldTransform(stood);
                body.set(Gait::walks);
            } else if (body.rested > 4.0f * kRests) {
                body.set(Gait::tumbles);  // it is wedged: tries again
            }
        }
    }
    // Walkers that a tumbling body hit fall over.
    void knock() {
        for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
            const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
            float impulse = 0.0f;
            for (int k = 0; k < manifold.getNumContacts(); ++k) impulse += manifold.getContactPoint(k).getAppliedImpulse();
            const auto a = bodies.find(uint32_t(manifold.getBody0()->getUserIndex()));
            const auto b = bodies.find(uint32_t(manifold.getBody1()->getUserIndex()));
            if (impulse < kKnock || a == bodies.end() || b == bodies.end()) continue;
            if (a->second.gait == Gait::walks && b->second.gait == Gait::tumbles) a->second.set(Gait::tumbles);
            else if (b->second.gait == Gait::walks && a->second.gait == Gait::tumbles) b->second.set(Gait::tumbles);
        }
    }
};

Physics::Physics(float floor) : m_impl(std::make_unique<Impl>(floor)) {}
Physics::~Physics() = default;

std::shared_ptr<Physics::Walls> Physics::makeWalls(const std::vector<glm::vec3>& corners, float floor) {
    auto made = std::make_shared<Walls>();
    for (size_t i = 0; i + 2 < corners.size(); i += 3) {
        const bool inFloor = std::max({corners[i].y, corners[i + 1].y, corners[i + 2].y}) < floor + kInFloor;
        if (!inFloor) made->mesh.addTriangle(bullet(corners[i]), bullet(corners[i + 1]), bullet(corners[i + 2]));
    }
    if (made->mesh.getNumTriangles() == 0) return made;
    made->shape = std::make_unique<btBvhTriangleMeshShape>(&made->mesh, true);
    made->object.setCollisionShape(made->shape.get());
    made->object.setFriction(1.0f);
    return made;
}

void Physics::use(std::shared_ptr<Walls> walls) {
    Impl& impl = *m_impl;
    impl.removeWalls();
    impl.walls = std::move(walls);
    if (impl.walls->shape)
        impl.world.addCollisionObject(&impl.walls->object, btBroadphaseProxy::StaticFilter, ~btBroadphaseProxy::StaticFilter);
}

uint32_t Physics::add(const glm::vec3& halfSize, const glm::mat4& feet) { return m_impl->add(halfSize, feet, false); }
uint32_t Physics::addFixed(const glm::vec3& halfSize, const glm::mat4& feet) { return m_impl->add(halfSize, feet, true); }

void Physics::remove(uint32_t id) {
    m_impl->takeOut(m_impl->bodies.at(id));
    m_impl->bodies.erase(id);
}

glm::mat4 Physics::feet(uint32_t id) const {
    const Body& body = m_impl->bodies.at(id);
    return glm::translate(matrix(body.rigid->getWorldTransform()), glm::vec3(0.0f, -body.halfHeight, 0.0f));
}

void Physics::place(uint32_t id, const glm::mat4& feet) { m_impl->place(m_impl->bodies.at(id), feet); }

void Physics::walk(uint32_t id, const glm::vec2& velocity, float turn) {
    Body& body = m_impl->bodies.at(id);
    body.velocity = velocity;
    body.turn = turn;
}

bool Physics::walks(uint32_t id) const { return m_impl->bodies.at(id).gait == Gait::walks; }

void Physics::hold(uint32_t id) {
    Body& body = m_impl->bodies.at(id);
    m_impl->takeOut(body);
    body.set(Gait::fixed);
    body.held = true;
}

void Physics::throwAway(uint32_t id, const glm::vec3& velocity, const glm::vec3& spin) {
    Body& body = m_impl->bodies.at(id);
    m_impl->world.addRigidBody(body.rigid.get());
    body.held = false;
    body.set(Gait::tumbles);
    body.rigid->setLinearVelocity(bullet(velocity));
    body.rigid->setAngularVelocity(bullet(spin));
}

uint32_t Physics::firstAlong(const glm::vec3& from, const glm::vec3& direction, float reach) const {
    // A ball's sweep rather than a ray: toasters are small in the picture.
    constexpr float kBall = 0.08f;
    const btVector3 begin = bullet(from), end = bullet(from + reach * glm::normalize(direction));
    btCollisionWorld::ClosestConvexResultCallback hit(begin, end);
    hit.m_collisionFilterMask = btBroadphaseProxy::DefaultFilter | btBroadphaseProxy::StaticFilter;
    const btSphereShape probe(kBall);
    m_impl->world.convexSweepTest(&probe, upright(begin), upright(end), hit);
    if (!hit.hasHit()) return 0;
    const auto found = m_impl->bodies.find(uint32_t(hit.m_hitCollisionObject->getUserIndex()));
    return found == m_impl->bodies.end() || found->second.gait == Gait::fixed ? 0 : found->first;
}

void Physics::noPlayer() {
    if (m_impl->player) m_impl->world.removeRigidBody(m_impl->player.get());
    m_impl->player.reset();
}

void Physics::player(const glm::vec3& eye, bool standing) {
    Impl& impl = *m_impl;
    const float tall = std::max(eye.y + kPlayerRadius - impl.floor, 2.0f * kPlayerRadius);
    if (standing && (!impl.capsule || std::fabs(impl.capsule->getHalfHeight() * 2.0f + 2.0f * kPlayerRadius - tall) > 0.01f)) {
        noPlayer();
        impl.capsule = std::make_unique<btCapsuleShape>(kPlayerRadius, tall - 2.0f * kPlayerRadius);
    }
    btCollisionShape* shape = standing ? static_cast<btCollisionShape*>(impl.capsule.get()) : &impl.ball;
    const btVector3 middle(eye.x, standing ? eye.y + kPlayerRadius - 0.5f * tall : eye.y, eye.z);
    if (impl.player && impl.player->getCollisionShape() != shape) noPlayer();
    if (!impl.player) {
        impl.player = std::make_unique<btRigidBody>(0.0f, nullptr, shape);
        impl.player->setUserIndex(0);
        impl.player->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
        impl.player->setActivationState(DISABLE_DEACTIVATION);
        impl.world.addRigidBody(impl.player.get(), btBroadphaseProxy::KinematicFilter, btBroadphaseProxy::DefaultFilter);
    }
    impl.player->setWorldTransform(upright(middle));
}

glm::vec3 Physics::slide(const glm::vec3& from, const glm::vec3& to) const {
    constexpr float kStepHeight = 0.4f;  // metres; a player steps over what is lower
    constexpr float kGap = 0.01f;        // metres kept from a wall
    const Impl& impl = *m_impl;
    if (!impl.walls) return to;
    const float low = std::min(impl.floor + kStepHeight + kPlayerRadius, from.y);
    const btCapsuleShape shape(kPlayerRadius, from.y - low);
    const float down = 0.5f * (from.y - low);
    glm::vec3 at = from, rest = to - from;
    rest.y = 0.0f;
    for (int i = 0; i < 3 && glm::length(rest) > 1e-5f; ++i) {
        const btVector3 begin(at.x, at.y - down, at.z), end(at.x + rest.x, at.y - down, at.z + rest.z);
        WallCast hit(begin, end);
        impl.world.convexSweepTest(&shape, upright(begin), upright(end), hit);
        if (!hit.hasHit()) {
            at += rest;
            break;
        }
        const float part = std::max(0.0f, hit.m_closestHitFraction - kGap / glm::length(rest));
        at += part * rest;
        rest *= 1.0f - part;
        glm::vec3 normal = vector(hit.m_hitNormalWorld);
        normal.y = 0.0f;
        if (glm::length(normal) < 1e-3f) break;
        normal = glm::normalize(normal);
        rest -= std::min(0.0f, glm::dot(rest, normal)) * normal;
    }
    return {at.x, to.y, at.z};
}

void Physics::step(float seconds) {
    Impl& impl = *m_impl;
    const int count = int(std::ceil(seconds / kStep - 1e-3f));
    std::vector<btVector3> before;
    for (int i = 0; i < count; ++i) {
        const float part = seconds / float(count);
        before.clear();
        for (auto& [id, body] : impl.bodies) {
            before.push_back(body.rigid->getWorldTransform().getOrigin());
            impl.steer(body, part);
        }
        impl.world.stepSimulation(part, 0);
        size_t k = 0;
        for (auto& [id, body] : impl.bodies) impl.settle(id, body, before[k++], part);
        impl.knock();
    }
}

}  // namespace obscura::game
