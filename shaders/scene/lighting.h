// Lights of a frame, directions in eye space.
#ifndef OBSCURA_SCENE_LIGHTING_H
#define OBSCURA_SCENE_LIGHTING_H
#include "shared/types.h"
#include "shared/view.h"
OBSCURA_SHARED_BEGIN

struct LightingBlock {
    View view;
    mat4 shadowFromEye;  // eye -> shadow map: xy in [0,1], z reversed depth
    vec4 toSun;          // unit; w: side of a shadow texel in metres
    vec4 sun;            // irradiance of a surface that faces the sun, linear
    vec4 sky;            // radiance from above
    vec4 ground;         // radiance from below
    vec4 up;             // unit; w: shadow map size in texels
    vec4 shadow;         // x: metres of the map's depth range; y: the sun's diameter over its distance
};
OBSCURA_SHARED_SIZE(LightingBlock, 256);

OBSCURA_SHARED_END
#endif
