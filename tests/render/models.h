// Small models made in memory, one for each way to move. All carry a smooth pattern as base colour, so that a picture of
// the base colour shows which point of the surface a pixel sees.
#pragma once

#include <memory>

#include "scene/world.h"

namespace obscura::test {

std::shared_ptr<scene::Model> turningCube();   // node animation: turns and travels; triangles of its six faces
std::shared_ptr<scene::Model> bendingBar();    // skin of four joints in a row, each turning; morph targets as well
std::shared_ptr<scene::Model> wavingPatch();   // three morph targets, one of them never on
std::shared_ptr<scene::Model> floorPlate();    // 6 m x 6 m at y = 0, at rest

// Makes the material of a model's first primitive another one.
std::shared_ptr<scene::Model> with(std::shared_ptr<scene::Model> model, const scene::Material& material);

scene::Instance instanceOf(std::shared_ptr<const scene::Model> model, const glm::vec3& at = glm::vec3(0.0f));

// All of them, and a smaller cube mirrored.
scene::World mixedWorld();

}  // namespace obscura::test
