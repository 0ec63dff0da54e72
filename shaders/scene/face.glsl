// What a fragment is to depth layers: which side of which solid. Include from fragment shaders.
#ifndef OBSCURA_SCENE_FACE_GLSL
#define OBSCURA_SCENE_FACE_GLSL

#include "scene/layers/hit.glsl"

// Side in two bits, solid in six above them. `shell` is DrawItem::normal[2].w: 0 for open sheets, else the solid's number + 1,
// negative where it is wound the other way round. Numbers go around: that two solids share one is possible, and rare.
uint faceOf(float shell) {
    uint side = shell == 0.0 ? kSheet : gl_FrontFacing == (shell > 0.0) ? kFront : kBack;
    return side | (uint(abs(shell)) & 63u) << 2;
}

#endif
