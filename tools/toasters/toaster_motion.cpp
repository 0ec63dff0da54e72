#include "toasters/toaster_motion.h"

#include "toasters/toaster_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace obscura::toasters {

using kit::smoothStep;

namespace {

constexpr float kTau = glm::two_pi<float>();
constexpr float kStride = 0.23f;
constexpr float kStepHeight = 0.032f;
/// Steps taken for each full turn on the spot.
constexpr float kStridesPerTurn = 4.0f;
constexpr float kPhaseRate = 300.0f;
/// How far the hips sink below the bind pose, so the knees keep some bend to walk with.
constexpr float kHipDrop = 0.019f;

/// Seconds since the last time `event` came round.
float since(float time, float event) { return time - event - std::floor((time - event) / kDuration) * kDuration; }

/// A damped oscillation that starts at 0.
float ringing(float elapsed, float decay, float frequency) { return std::exp(-decay * elapsed) * std::sin(kTau * frequency * elapsed); }

}  // namespace

glm::mat4 Placement::matrix() const { return glm::translate(glm::mat4(1.0f), translation) * glm::mat4_cast(rotation); }

ToyMotion::ToyMotion(Script script, float ground) : m_script(std::move(script)), m_ground(ground) { preparePhases(); }

void ToyMotion::preparePhases() {
    const int count = static_cast<int>(kDuration * kPhaseRate);
    m_phases.push_back(0.0f);
    for (int i = 0; i < count; ++i) {
        const float time = (static_cast<float>(i) + 0.5f) / kPhaseRate;
        const float strides = std::max(forwardSpeed(time), 0.0f) / kStride + turnSpeed(time) / kTau * kStridesPerTurn;
        const bool onGround = airHeight(time) == 0.0f;
        m_phases.push_back(m_phases.back() + (onGround ? strides / kPhaseRate : 0.0f));
    }
    // A whole number of strides closes the loop; the correction is too small to see the feet slip.
    const float scale = std::round(m_phases.back()) / m_phases.back();
    for (float& phase : m_phases) phase *= scale;
}

float ToyMotion::forwardSpeed(float time) const {
    constexpr float kStep = 0.004f;
    const float rate = (m_script.travel(time + kStep) - m_script.travel(time - kStep)) / (2.0f * kStep);
    // A toy that has turned round walks its course in the other direction.
    return rate * m_script.direction * std::cos(m_script.turn(time));
}

float ToyMotion::turnSpeed(float time) const {
    constexpr float kStep = 0.004f;
    return std::abs(m_script.turn(time + kStep) - m_script.turn(time - kStep)) / (2.0f * kStep);
}

float ToyMotion::airHeight(float time) const {
    for (const Hop& hop : m_script.hops) {
        const float u = since(time, hop.start) / hop.duration();
        if (u < 1.0f) return 4.0f * hop.height * u * (1.0f - u);
    }
    return 0.0f;
}

ToyMotion::Gait ToyMotion::gaitAt(float time) const {
    Gait gait;
    const float place = since(time, 0.0f) * kPhaseRate;
    const auto index = std::min(static_cast<std::size_t>(place), m_phases.size() - 2);
    gait.phase = glm::mix(m_phases[index], m_phases[index + 1], place - static_cast<float>(index));
    const float grounded = 1.0f - smoothStep(0.0f, 0.02f, airHeight(time));
    gait.stride = grounded * smoothStep(0.03f, 0.22f, forwardSpeed(time));
    gait.step = std::max(gait.stride, grounded * smoothStep(0.2f, 1.5f, turnSpeed(time)));
    return gait;
}

Placement ToyMotion::rootAt(float time) const {
    const float distance = m_script.travel(time);
    const glm::vec2 place = m_script.course.position(distance);
    const float backwards = m_script.direction < 0.0f ? glm::pi<float>() : 0.0f;
    const float heading = m_script.course.heading(distance) + backwards + m_script.turn(time);
    return {glm::vec3(place.x, m_ground + airHeight(time), place.y), glm::angleAxis(heading, glm::vec3(0.0f, 1.0f, 0.0f))};
}

Placement ToyMotion::bodyAt(float time) const {
    constexpr float kRoll = 0.12f;
    constexpr float kSway = 0.012f;
    constexpr float kBob = 0.006f;
    const Gait gait = gaitAt(time);
    const float swing = std::sin(kTau * gait.phase);

    float drop = kHipDrop;
    float pitch = 0.05f * gait.stride;
    for (const Hop& hop : m_script.hops) {
        const float before = since(hop.start, time);
        const float after = since(time, hop.start) - hop.duration();
        // Crouch, stretch at the jump, and give way on landing.
        drop += 0.045f * smoothStep(0.24f, 0.1f, before) * smoothStep(0.0f, 0.07f, before);
        pitch += 0.12f * smoothStep(0.24f, 0.1f, before) * smoothStep(0.0f, 0.07f, before);
        if (after < 0.0f) drop -= 0.012f * std::sin(glm::pi<float>() * -after / hop.duration());
        else drop += 0.06f * std::max(0.0f, ringing(after, 8.0f, 1.6f));
    }
    for (float bump : m_script.bumps) pitch -= 0.34f * ringing(since(time, bump), 4.5f, 2.2f);
    for (const Pop& pop : m_script.pops)
        drop += 0.012f * ringing(since(time, pop.start), 9.0f, 3.0f) + 0.016f * ringing(since(time, pop.start + pop.flight), 9.0f, 3.0f);

    Placement body;
    body.translation = {kSway * swing * gait.step, kHipHeight - drop + kBob * gait.step * (swing * swing - 1.0f), 0.0f};
    body.rotation =
        glm::angleAxis(-kRoll * swing * gait.step, glm::vec3(0.0f, 0.0f, 1.0f)) * glm::angleAxis(pitch, glm::vec3(1.0f, 0.0f, 0.0f));
    return body;
}

float ToyMotion::headAngle(float time) const {
    constexpr float kOpen = 0.62f;
    const Gait gait = gaitAt(time);
    float angle = 0.035f * gait.step * (1.0f - std::cos(2.0f * kTau * gait.phase));
    const auto bite = [&](float elapsed, float widest) {
        const float open = smoothStep(0.0f, 0.17f, elapsed) * smoothStep(0.34f, 0.25f, elapsed);
        const float bounce = elapsed > 0.34f ? 0.12f * std::abs(ringing(elapsed - 0.34f, 9.0f, 3.5f)) : 0.0f;
        angle += widest * (open + bounce);
    };
    for (float snap : m_script.snaps) {
        bite(since(time, snap), kOpen);
        bite(since(time, snap + 0.36f), 0.6f * kOpen);
    }
    for (float bump : m_script.bumps) angle += 0.25f * std::abs(ringing(since(time, bump), 6.0f, 2.0f));
    for (const Hop& hop : m_script.hops) {
        const float u = since(time, hop.start) / hop.duration();
        if (u < 1.0f) angle += 0.3f * std::sin(glm::pi<float>() * u) * std::sin(glm::pi<float>() * u);
        else angle += 0.2f * std::abs(ringing((u - 1.0f) * hop.duration(), 7.0f, 2.2f));
    }
    return angle;
}

glm::mat4 ToyMotion::headMatrix(float time) const {
    const Placement head{kHinge, glm::angleAxis(-headAngle(time), glm::vec3(1.0f, 0.0f, 0.0f))};
    return rootAt(time).matrix() * bodyAt(time).matrix() * head.matrix();
}

Placement ToyMotion::footAt(float time, float side) const {
    constexpr float kHalfReach = 0.25f * kStride;
    constexpr float kSwingShare = 0.5f;
    const Gait gait = gaitAt(time);
    // The left foot stands in the first half of each stride, the right one in the second.
    const float phase = gait.phase + (side > 0.0f ? 0.0f : 0.5f);
    const float u = phase - std::floor(phase);
    float forward = kHalfReach * (1.0f - 2.0f * u / kSwingShare);
    float lift = 0.0f;
    if (u >= kSwingShare) {
        const float swing = (u - kSwingShare) / (1.0f - kSwingShare);
        // The foot leaves and meets the ground at the speed of the ground beneath it.
        forward = kHalfReach * (2.0f * smoothStep(0.0f, 1.0f, swing) - 1.0f - 2.0f * swing * (1.0f - swing) * (1.0f - 2.0f * swing));
        lift = kStepHeight * std::pow(std::sin(glm::pi<float>() * swing), 2.0f);
    }
    const float air = airHeight(time);
    const float tuck = smoothStep(0.02f, 0.3f, air);
    Placement foot;
    foot.translation = {side * (kHipSide + 0.004f), kAnkleHeight + lift * gait.step + 0.018f * tuck, forward * gait.stride - 0.02f * tuck};
    const float toeUp = -4.0f * lift * gait.step + 0.45f * tuck;
    foot.rotation = glm::angleAxis(toeUp, glm::vec3(1.0f, 0.0f, 0.0f));
    return foot;
}

void ToyMotion::placeLeg(ToyPose& pose, float time, float side) const {
    const int first = side > 0.0f ? kHipLeft : kHipRight;
    const Placement foot = footAt(time, side);
    const glm::vec3 hip{side * kHipSide, 0.0f, 0.0f};
    const glm::vec3 ankle = glm::vec3(glm::inverse(pose.body.matrix()) * glm::vec4(foot.translation, 1.0f));
    const glm::vec3 reach = ankle - hip;
    // Two equal bones: the knee lies over the middle of the line from hip to ankle.
    const float half = std::min(0.5f * glm::length(reach), kLegSegment * 0.9999f);
    const float bend = std::acos(half / kLegSegment);
    const glm::vec3 down = glm::normalize(reach);
    const glm::vec3 sideways = glm::normalize(glm::cross(glm::vec3(0.0f, 0.0f, 1.0f), down));
    const glm::mat3 frame(sideways, -down, glm::cross(sideways, -down));
    const glm::quat toAnkle = glm::normalize(glm::quat_cast(frame));
    const glm::vec3 axis(1.0f, 0.0f, 0.0f);
    pose.joints[first] = toAnkle * glm::angleAxis(-bend, axis);
    pose.joints[first + 1] = glm::angleAxis(2.0f * bend, axis);
    const glm::quat shin = pose.body.rotation * pose.joints[first] * pose.joints[first + 1];
    pose.joints[first + 2] = glm::inverse(shin) * foot.rotation;
}

void ToyMotion::placeToast(ToyPose& pose, float time) const {
    pose.toast.translation = kToastSeat;
    for (const Pop& pop : m_script.pops) {
        const float elapsed = since(time, pop.start);
        const float u = elapsed / pop.flight;
        if (u >= 1.0f) {
            pose.toastBend += 0.75f * ringing(elapsed - pop.flight, 4.0f, 3.2f);
            continue;
        }
        // In flight the slice moves in world space, on a ballistic arc to the slot's later position.
        const glm::mat4 from = headMatrix(pop.start);
        const glm::mat4 to = headMatrix(pop.start + pop.flight);
        const glm::vec3 start(from * glm::vec4(kToastSeat, 1.0f));
        const glm::vec3 end(to * glm::vec4(kToastSeat, 1.0f));
        const glm::vec3 rise(0.0f, 0.5f * kGravity * pop.flight * pop.flight * u * (1.0f - u), 0.0f);
        // It clears the slot before it tumbles, and is upright again before it falls in.
        const float tumble = -kTau * smoothStep(0.08f, 0.9f, u);
        const glm::quat facing = glm::slerp(glm::quat_cast(glm::mat3(from)), glm::quat_cast(glm::mat3(to)), smoothStep(0.0f, 1.0f, u));
        const Placement world{glm::mix(start, end, u) + rise, facing * glm::angleAxis(tumble, glm::vec3(1.0f, 0.0f, 0.0f))};
        const glm::mat4 local = glm::inverse(headMatrix(time)) * world.matrix();
        pose.toast.translation = glm::vec3(local[3]);
        pose.toast.rotation = glm::normalize(glm::quat_cast(glm::mat3(local)));
        pose.toastBend = 0.6f * std::sin(kTau * 2.0f * u) * std::sin(glm::pi<float>() * u);
    }
}

ToyPose ToyMotion::at(float time) const {
    ToyPose pose;
    pose.root = rootAt(time);
    pose.body = bodyAt(time);
    pose.head = glm::angleAxis(-headAngle(time), glm::vec3(1.0f, 0.0f, 0.0f));
    for (float side : {1.0f, -1.0f}) placeLeg(pose, time, side);
    placeToast(pose, time);
    return pose;
}

}  // namespace obscura::toasters
