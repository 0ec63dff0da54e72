// A fragment's face, for depth layers: side (front, back, sheet) and number of its solid. Include from fragment shaders.
#ifndef OBSCURA_SCENE_FACE_GLSL
#define OBSCURA_SCENE_FACE_GLSL

#include "scene/layers/hit.glsl"

// Side in the two lowest bits, solid in the next six. `shell` is DrawItem::normal[2].w: 0 for open sheets, else the solid's number, 1 to
// 63, negative if it is wound the other way round. Numbers repeat after 63 solids, so two solids can share one.
uint faceOf(float shell) {
    uint side = shell == 0.0 ? kSheet : gl_FrontFacing == (shell > 0.0) ? kFront : kBack;
    return side | (uint(abs(shell)) & 63u) << 2;
}

#endif
