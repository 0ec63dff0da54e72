// Frame and Volume of the API as the blocks that shaders read.
#pragma once

#include "ao/result.h"
#include "shared/view.h"
#include "shared/volume.h"

namespace obscura::ao {

// The view of a frame's size, guard band and projection. The depth convention (reversed or not, finite or infinite, orthographic,
// off-centre, y flipped) is read from the matrix. Status::invalid with a reason if the matrix is no projection.
Status viewOf(const Frame& frame, shared::View& view, const char*& reason);

// Why a matrix is not Frame::eyeFromWorld, a rigid transform, mirrored if the world is left-handed: the rest of a sentence that
// begins with its name. Null: it is one.
const char* unfitEyeFromWorld(const float matrix[16]);

// View::orthographicDepth of a view with its visible size and pixelsPerMetre.
inline float orthographicDepth(const shared::View& view) {
    constexpr float kDepths = 0.8660254f;  // in heights: 1 / (2 tan 30 degrees)
    return view.orthographic > 0.5f ? kDepths * float(view.visible.y) / view.pixelsPerMetre : 0.0f;
}

// The volume block of Frame::volume, without its buffer. Status::invalid with a reason if it describes no volume.
Status volumeOf(const Volume& volume, shared::Volume& block, const char*& reason);
// The most steps of a ray of shaders/ao/common/volume_rays.glsl: those of a receiver in level 0. reach: metres; stride: cells;
// octave: log2 of the number of steps an octave.
uint32_t volumeRaySteps(const shared::Volume& volume, float reach, float stride, uint32_t octave);

// Linear depth of sky in Inputs::depth, metres; view.skyDepth is at most this.
inline constexpr float kSkyDepth = 1.0e8f;

}  // namespace obscura::ao
