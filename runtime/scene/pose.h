// A Model at a time: node matrices, joint matrices, morph weights. Pure functions of (model, animation, time).
#pragma once

#include <vector>

#include "scene/model.h"

namespace obscura::scene {

struct Pose {
    std::vector<glm::mat4> world;             // node -> model space, one per node (identity for unreachable ones)
    std::vector<std::vector<float>> weights;  // morph weights, one vector per node (empty without morph targets)
};

// time in seconds, wrapped into the animation's duration when `loop`. animation -1 or out of range: the rest pose.
// Quaternions are slerped, CUBICSPLINE per glTF 2.0 appendix C.
Pose evaluate(const Model& model, int animation, float time, bool loop = true);

// Joint matrices of a skin in model space: world[joint] * inverseBind. The node's own transform does not apply to
// skinned geometry [glTF 2.0, 3.7.3].
std::vector<glm::mat4> jointMatrices(const Model& model, const Skin& skin, const Pose& pose);

// Positions, and normals unless null, of a primitive after morphing and skinning, in model space. The CPU version of
// shaders/scene/deform.comp: its test reference, and the input of the modules truth and voxel.
void deform(const Model& model, int node, const Primitive& primitive, const Pose& pose, std::vector<glm::vec3>& positions,
    std::vector<glm::vec3>* normals);

}  // namespace obscura::scene
