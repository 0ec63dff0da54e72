// Depth layers, peeling [Everitt 2001]: of the fragments behind the previous hit, the depth test keeps the nearest. For the first layer
// alone; with WHOLE_HITS, the next of three hits behind the visible one, for two layers. MASKED: alpha test.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant MASKED
#pragma variant WHOLE_HITS
#pragma variant WHOLE_HITS,MASKED
#include "scene/face.glsl"
#include "scene/layers/hit.glsl"

// Device depth of the previous hit; with WHOLE_HITS, from the second peel on, the hit's bits as a float.
layout(set = 0, binding = 2) uniform sampler2D before;

#ifdef WHOLE_HITS
layout(constant_id = 0) const bool behindVisible = true;  // first peel: the previous hit is the visible one
#endif

layout(location = 0) flat in float inShell;
#ifdef MASKED
#include "scene/material.glsl"
layout(location = 1) in vec4 inUv;
layout(location = 2) in float inAlpha;
#endif
layout(location = 0) out uint outHit;

void main() {
#ifdef MASKED
    if (baseColorOf(inUv, vec4(1.0, 1.0, 1.0, inAlpha)).a < material.emission.w) discard;
#endif
    float last = texelFetch(before, ivec2(gl_FragCoord.xy), 0).x;
    outHit = hitOf(gl_FragCoord.z, faceOf(inShell));
#ifdef WHOLE_HITS
    // Sorts by the hit's bits, face included, as the ladder does, so that both forms give the same images to the bit.
    gl_FragDepth = uintBitsToFloat(outHit);
    if (behindVisible ? gl_FragCoord.z >= last : gl_FragDepth >= last) discard;
#else
    if (gl_FragCoord.z >= last) discard;  // a surface has the same depth to the bit in every pass
#endif
}
