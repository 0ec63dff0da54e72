// Evaluates a scene's animation: node transforms and deformed vertices.
#pragma once

#include "meshkit/scene.h"

namespace obscura::kit {

/// The state of every node at one moment of the scene's animation.
struct Pose {
    std::vector<glm::mat4> world;
    std::vector<std::vector<float>> weights;
};

Pose poseAt(const Scene& scene, float time);

/// One channel's value at a moment, by its own interpolation; rotations come out normalised.
std::vector<float> valueAt(const Scene& scene, const Channel& channel, float time);

/// The world positions of a node's vertices after morphing and skinning.
std::vector<glm::vec3> posedPositions(const Scene& scene, const Pose& pose, int node);

}  // namespace obscura::kit
