// A Model at a time: node matrices, joint matrices, morph weights. Pure functions of (model, animation, time).
#pragma once

#include <vector>

#include "scene/model.h"

namespace obscura::scene {

struct Pose {
    std::vector<glm::mat4> world;             // node -> model space, one per node (identity for unreachable ones)
    std::vector<std::vector<float>> weights;  // morph weights, one vector per node (empty without morph targets)
};

// What plays: an animation by its index, or one of these.
inline constexpr int kRestPose = -1;
inline constexpr int kAllAnimations = -2;
// The animations that play. All together: those that move nothing which an earlier one moves in the same way; the others are alternatives.
// An index out of range: none.
std::vector<int> playing(const Model& model, int animation);

// time in seconds, wrapped into each animation's duration when `loop`. Quaternions are slerped, CUBICSPLINE per glTF 2.0 appendix C.
Pose evaluate(const Model& model, int animation, float time, bool loop = true);

// Joint matrices of a skin in model space: world[joint] * inverseBind. The node's own transform does not apply to
// skinned geometry [glTF 2.0, 3.7.3].
std::vector<glm::mat4> jointMatrices(const Model& model, const Skin& skin, const Pose& pose);

// Positions, and normals unless null, of a primitive after morphing and skinning, in model space. The CPU version of
// shaders/scene/deform.comp: its test reference, and the input of the modules truth and voxel.
void deform(const Model& model, int node, const Primitive& primitive, const Pose& pose, std::vector<glm::vec3>& positions,
    std::vector<glm::vec3>* normals);

}  // namespace obscura::scene
