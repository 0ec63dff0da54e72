// Small models made in memory, one for each kind of animation. All have a smooth pattern as base colour, so that base-colour
// images identify the surface point of a pixel.
#pragma once

#include <memory>

#include "scene/world.h"

namespace obscura::test {

std::shared_ptr<scene::Model> turningCube();  // node animation: rotates and translates
std::shared_ptr<scene::Model> bendingBar();   // skin of four joints in a row, each turning; morph targets as well
std::shared_ptr<scene::Model> wavingPatch();  // three morph targets, one of weight 0
std::shared_ptr<scene::Model> floorPlate();   // 6 m x 6 m at y = 0, at rest

// Replaces the material of a model's first primitive.
std::shared_ptr<scene::Model> with(std::shared_ptr<scene::Model> model, const scene::Material& material);

scene::Instance instanceOf(std::shared_ptr<const scene::Model> model, const glm::vec3& at = glm::vec3(0.0f));

// All models, and a smaller mirrored cube.
scene::World mixedWorld();

}  // namespace obscura::test
