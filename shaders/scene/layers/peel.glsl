// Depth peeling [Everitt 2001]: of what lies behind the hit before, the depth test keeps the nearest.
#include "scene/face.glsl"
#include "scene/layers/hit.glsl"

layout(set = 0, binding = 2) uniform sampler2D before;  // device depth of the hit before; with WHOLE_HITS, of those peeled, the hit itself

#ifdef WHOLE_HITS
layout(constant_id = 0) const bool behindVisible = true;  // the first to be peeled
#endif

layout(location = 0) flat in float inShell;
layout(location = 0) out uint outHit;

void peel() {
    float last = texelFetch(before, ivec2(gl_FragCoord.xy), 0).x;
    outHit = hitOf(gl_FragCoord.z, faceOf(inShell));
#ifdef WHOLE_HITS
    // Hits are told apart and sorted as the ladder has them, face and all, so that both forms see the same to the bit.
    gl_FragDepth = uintBitsToFloat(outHit);
    if (behindVisible ? gl_FragCoord.z >= last : gl_FragDepth >= last) discard;
#else
    if (gl_FragCoord.z >= last) discard;  // the same surface has the same depth to the bit
#endif
}
