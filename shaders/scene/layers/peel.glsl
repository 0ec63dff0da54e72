// Depth peeling [Everitt 2001]: of what lies behind the hit before, the depth test keeps the nearest.
#include "scene/face.glsl"
#include "scene/layers/hit.glsl"

layout(set = 0, binding = 2) uniform sampler2D before;  // device depth of the hit before

layout(location = 0) flat in float inShell;
layout(location = 0) out uint outHit;

void peel() {
    if (gl_FragCoord.z >= texelFetch(before, ivec2(gl_FragCoord.xy), 0).x) discard;  // the same surface has the same depth to the bit
    outHit = hitOf(gl_FragCoord.z, faceOf(inShell));
}
