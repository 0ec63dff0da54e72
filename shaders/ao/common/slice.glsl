// Shared by methods that search slices of the hemisphere through the view ray, as GTAO does [Jimenez 2016, alg. 1; XeGTAO]: bindings,
// receiver, slices and samples. In: packed normals, depth and its coarser levels, guard band included.
// Out: visibility and edges, see ao/common/edges.glsl.
#ifndef OBSCURA_SLICE_GLSL
#define OBSCURA_SLICE_GLSL
#include "ao/common/arcs.glsl"
#include "ao/common/depth_mips.glsl"
#include "ao/common/edges.glsl"
#include "ao/common/hilbert.glsl"
#include "shared/octahedral.glsl"
#include "shared/view.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 2, r32f) uniform readonly image2D depths;
layout(set = 0, binding = 3, r32ui) uniform writeonly uimage2D noisy;

const float kTooClose = 1.3;  // px: nearer samples are the pixel itself

struct Receiver {
    vec2 pixel;    // its centre, guard band included
    ivec2 last, padded;
    vec3 here, v, n;
    float nv;      // dot(n, v)
    float radius;  // the reach, px
    vec2 noise;    // rotation of slices, shift of samples
    uint edges;
};
// False: outside, or sky, for which visibility 1 is stored.
bool receive(View view, ivec2 p, float reach, out Receiver r) {
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return false;
    ivec2 texel = p + ivec2(view.guard);
    r.last = ivec2(view.size) - 1;
    r.padded = paddedSize(view.size);
    float z = imageLoad(depths, texel).x, depth = depthForTolerance(view, z);
    vec4 around = vec4(imageLoad(depths, max(texel - ivec2(1, 0), 0)).x, imageLoad(depths, min(texel + ivec2(1, 0), r.last)).x,
                       imageLoad(depths, max(texel - ivec2(0, 1), 0)).x, imageLoad(depths, min(texel + ivec2(0, 1), r.last)).x);
    r.edges = packEdges(edgesAt(z, depth, around));
    r.pixel = vec2(texel) + 0.5;
    r.here = eyePosition(view, r.pixel, z - 1e-5 * depth);  // bias against rounding of depth
    r.v = towardsEye(view, r.here);
    r.n = unpackNormal(imageLoad(normals, texel).x);
    r.n = dot(r.n, r.v) < 0.0 ? -r.n : r.n;
    r.nv = dot(r.n, r.v);
    r.radius = reach * view.pixelsPerMetre / (view.orthographic > 0.5 ? 1.0 : z);
    r.noise = hilbertNoise(view, p);
    if (isSky(view, z)) imageStore(noisy, p, uvec4(packNoisy(1.0, r.edges)));
    return !isSky(view, z);
}

// A slice's direction across the view ray, of unit length, and its direction on the screen.
struct Slice {
    vec3 across;
    vec2 along;  // px, of the length of a pixel's height
};
// Slices are evenly spaced on the screen, as published, which is uneven around the view ray away from the image centre; or, with
// aroundRay, evenly around the view ray.
Slice sliceAt(View view, Receiver r, float angle, bool aroundRay) {
    vec3 d = vec3(cos(angle), sin(angle), 0.0);
    if (!aroundRay) return Slice(normalize(d - dot(d, r.v) * r.v), d.xy * view.project.xy / view.pixelsPerMetre);
    vec3 tangent = normalize(vec3(1, 0, 0) - r.v * r.v.x), across = tangent * d.x + cross(tangent, r.v) * d.y;
    vec2 along = view.orthographic > 0.5 ? across.xy : across.xy * -r.here.z + r.here.xy * across.z;
    return Slice(across, along * inversesqrt(max(dot(along, along), 1e-20)) * view.project.xy / view.pixelsPerMetre);
}
// Jittered position of sample i of slice k, 0 to 1 along the reach.
float samplePlace(Receiver r, uint k, uint i, uint steps) {
    return (float(i) + fract(r.noise.y + float(k + i * steps) * 0.61803399)) / float(steps);
}
int levelAt(float distance, float mipOffset) { return int(clamp(log2(distance) + 0.5 - mipOffset, 0.0, float(kDepthLevels) - 0.5)); }
// Vector from the receiver to the surface in the depth buffer at a place.
vec3 toSurface(View view, Receiver r, vec2 at, int level) {
    return eyePosition(view, at, imageLoad(depths, mipTexel(r.padded, clamp(ivec2(at), ivec2(0), r.last), level)).x) - r.here;
}

// Twice the cosine-weighted integral from the view ray to the angle of cosine c on a side of a slice, where nv and no are the
// normal's parts along the ray and towards the side: nv (1 - c^2) + no (acos c - c sqrt(1 - c^2)).
float sliceArc(float nv, float no, float c) {
    float s2 = max(1.0 - c * c, 0.0);
    return nv * s2 + no * (arcCosine(c) - c * sqrt(s2));
}

#endif
