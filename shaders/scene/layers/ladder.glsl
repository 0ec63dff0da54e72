// The three nearest hits behind the visible one, in one pass: each hit climbs down a ladder of atomic maxima, and what it
// finds farther than itself it carries on in its stead. The order of arrival does not show. The depth test lets only
// through what lies behind the visible surface.
#include "scene/face.glsl"
#include "scene/layers/hit.glsl"

layout(early_fragment_tests) in;
layout(set = 0, binding = 2, r32ui) uniform uimage2D second;
layout(set = 0, binding = 3, r32ui) uniform uimage2D third;
layout(set = 0, binding = 4, r32ui) uniform uimage2D fourth;

layout(location = 0) flat in float inShell;

void climb() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    uint hit = hitOf(gl_FragCoord.z, faceOf(inShell));
    uint found = imageAtomicMax(second, p, hit);
    hit = found == hit ? 0u : min(hit, found);  // the same hit again is no other one
    if (hit != 0u) {
        found = imageAtomicMax(third, p, hit);
        hit = found == hit ? 0u : min(hit, found);
    }
    if (hit != 0u) imageAtomicMax(fourth, p, hit);
}
