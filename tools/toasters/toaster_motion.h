// Poses of a toaster over time.
#pragma once

#include "toasters/toaster_model.h"
#include "toasters/toaster_script.h"

#include <array>
#include <glm/gtc/quaternion.hpp>
#include <vector>

namespace obscura::toasters {

/// A node's place relative to its parent.
struct Placement {
    glm::vec3 translation{0.0f};
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};

    glm::mat4 matrix() const;
};

/// The pose of one toy at one moment.
struct ToyPose {
    Placement root;
    Placement body;
    glm::quat head{1.0f, 0.0f, 0.0f, 0.0f};
    std::array<glm::quat, kJointCount> joints{};
    /// Relative to the head.
    Placement toast;
    float toastBend = 0.0f;
};

/// Turns a script into poses: the gait follows the distance walked, so that standing feet do not slip.
class ToyMotion {
public:
    /// `ground` is the height of the floor the toy walks on.
    ToyMotion(Script script, float ground);

    ToyPose at(float time) const;

private:
    /// Locomotion of the toy at one moment.
    struct Gait {
        float phase = 0.0f;
        /// 1 while striding, 0 while standing.
        float stride = 0.0f;
        /// 1 while the feet are lifted in turn, for walking and for turning on the spot.
        float step = 0.0f;
    };

    void preparePhases();
    float forwardSpeed(float time) const;
    float turnSpeed(float time) const;
    float airHeight(float time) const;
    Gait gaitAt(float time) const;
    Placement rootAt(float time) const;
    Placement bodyAt(float time) const;
    float headAngle(float time) const;
    /// Where the ankle belongs, relative to the root; side is +1 for the left leg.
    Placement footAt(float time, float side) const;
    void placeLeg(ToyPose& pose, float time, float side) const;
    void placeToast(ToyPose& pose, float time) const;
    glm::mat4 headMatrix(float time) const;

    Script m_script;
    float m_ground;
    std::vector<float> m_phases;
};

}  // namespace obscura::toasters
