// Inputs of the geometry passes, per frame and per drawn instance; push constants of the deform pass.
#ifndef OBSCURA_SCENE_FRAME_H
#define OBSCURA_SCENE_FRAME_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct SceneFrame {
    mat4 projection;   // eye -> clip, guard band included
    vec4 viewport;     // size.xy in px, then half of it
    vec4 visibleQuads; // the visible part in 2x2 quads: first (xy), one past the last (zw)
    vec4 orthographic; // x: 1 or 0
};
OBSCURA_SHARED_SIZE(SceneFrame, 112);

// Matrices are three rows of a 3x4: dot(row, vec4(p, 1)).
struct DrawItem {
    vec4 eye[3];       // object -> eye
    vec4 previous[3];  // object of last frame -> last frame's clip x, y, w
    vec4 normal[3];    // object -> eye for normals; .w: [0] 1 if object and camera have not moved (motion is exactly 0), [1] sign of the
                       // determinant, [2] shell, see scene/face.glsl
};
OBSCURA_SHARED_SIZE(DrawItem, 144);

struct ShadowItem {
    vec4 clip[3];      // object -> light clip x, y, z (orthographic: w is 1)
};
OBSCURA_SHARED_SIZE(ShadowItem, 48);

// One primitive of one instance. Offsets count elements of the arrays in scene/deform.comp.
struct DeformJob {
    uint vertices;
    uint positions;    // floats into the rest data
    uint frames;       // uints into the rest data
    uint influences;   // ~0: not skinned
    uint joints;       // first matrix
    uint targets;      // floats into the targets: this primitive's first target
    uint weights;      // first active weight
    uint weightCount;
    uint posed;        // first vertex written
};
OBSCURA_SHARED_SIZE(DeformJob, 36);

struct ActiveWeight {
    uint target;
    float weight;
};
OBSCURA_SHARED_SIZE(ActiveWeight, 8);

OBSCURA_SHARED_END
#endif
