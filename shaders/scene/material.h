// Uniform block of a glTF material. Texture slots: 0 base colour, 1 metalness and roughness, 2 normal, 3 emission, 4 occlusion.
#ifndef OBSCURA_SCENE_MATERIAL_H
#define OBSCURA_SCENE_MATERIAL_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct MaterialBlock {
    vec4 baseColor;    // linear
    vec4 emission;     // linear; w: alpha cutoff
    vec4 factors;      // metalness, roughness, normal scale, occlusion strength
    uvec4 flags;       // x: bit n: slot n uses the second texture coordinates; y: unlit
    vec4 uvMatrix[5];  // columns of the 2x2 [KHR_texture_transform]
    vec4 uvOffset[5];  // xy
};
OBSCURA_SHARED_SIZE(MaterialBlock, 224);

OBSCURA_SHARED_END
#endif
