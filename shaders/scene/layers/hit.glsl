// A hit of the view ray with a surface, as one uint: reversed device depth with its face (scene/face.glsl) in the eight lowest bits, which
// leaves 16 significant bits of depth. The nearer of two hits is the greater number. 0: none.
#ifndef OBSCURA_SCENE_HIT_GLSL
#define OBSCURA_SCENE_HIT_GLSL

const uint kFront = 1u, kBack = 2u, kSheet = 3u;  // the face's two lowest bits

uint hitOf(float deviceDepth, uint face) { return (floatBitsToUint(deviceDepth) & ~255u) | face; }
float depthOf(uint hit) { return uintBitsToFloat(hit & ~255u); }
uint faceOfHit(uint hit) { return hit & 255u; }

// Linear depth, metres; infinite for sky.
float linearDepth(mat4 projection, float d) {
    return projection[2][3] != 0.0 ? projection[3][2] / (projection[2][2] - projection[2][3] * d)
        : d > 0.0 ? (projection[3][2] - d) / projection[2][2] : 1.0 / 0.0;
}

#endif
