// Occluders that a screen-space method misses: rays through the volume, one invocation a pixel of the map. A ray ends where
// the method takes the depth buffer for solid, and counts where it meets a set cell before that. In: volume, linear depth, packed
// normals; with DEPTH_LAYERS, spans of matter. Out: 1 - B of the map's receivers, and what they are. The rule is told in runtime/ao/offscreen.h.
#ifndef OBSCURA_OFFSCREEN_TRACE_GLSL
#define OBSCURA_OFFSCREEN_TRACE_GLSL
#include "ao/common/lens.glsl"
#include "ao/common/map.glsl"
#include "shared/falloff.h"
#ifdef DEPTH_LAYERS
#include "ao/common/spans.glsl"
layout(set = 0, binding = 7, rgba32ui) uniform readonly uimage2D spans;
#endif
layout(push_constant) uniform Constants {
    FalloffBlock falloffBlock;
    uint rays;
    float stride;     // of a ray, cells a step at most
    uint scale;       // pixels a map's pixel, each way
    uint hidden;      // 1: what stands unseen inside the picture counts too
    float offset;     // of rays' origin along the normal, cells
    float grain;      // cells a side of the noise's
    float reach;      // Blocking: metres from the receiver
    float thickness;  // and behind the surface shown
};

const float kTwoPi = 6.28318531;
const float kMostSteps = 64.0;
const float kSlackPixels = 1.5;   // what lies less than this behind the surface shown is on it
const float kSlackCells = 1.7321; // a set cell nearer than this behind the surface shown may hold that surface

// Whether the method has counted a point as blocked that lies `behind` the surface shown, `far2` the squared distance of that surface
// from the receiver and `size` how thick it is taken to be.
bool represented(float behind, float slack, float size, float far2, float reach2) {
    return behind > slack && behind < size && far2 < reach2;
}

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    Volume volume = volumeBlock;
    FalloffBlock rho = falloffBlock;
    openVolume();
    uint rayCount = rays;
    float offsetCells = offset, reach2 = reach * reach;
    bool countsHidden = hidden != 0u;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(map)))) return;
    vec3 here, n;
    if (!receive(view, p, int(scale), here, n)) return;

    // A point of a ray is told twice, in cells and in homogeneous pixels; both go on by one vector a step. The frame of the rays is the
    // cells', so that it rests while the camera turns.
    Lens lens = lensOf(view);
    float metres = volume.anchor.w, lift = offsetCells * metres;
    vec3 up = cellsAlong(volume, n) * metres;
    vec3 receiver = cellOf(volume, here);
    vec3 origin = receiver + offsetCells * up, start = toPixels(lens, here + lift * n);
    vec3 xi = fract(cellNoise(latticeCell(volume, receiver, up, grain)) + frameShift(view));
    vec3 tangent, bitangent;
    around(up, tangent, bitangent);
    vec3 tangentPixels = toPixels(lens, eyeAlong(volume, tangent)), bitangentPixels = toPixels(lens, eyeAlong(volume, bitangent)), upPixels = toPixels(lens, n);

    uint stepCount = uint(clamp(ceil(rho.reach / (stride * metres)), 1.0, kMostSteps));
    float step = rho.reach / float(stepCount), cellsPerStep = step / metres, slackCells = kSlackCells * metres;
    float slackScale = kSlackPixels / view.pixelsPerMetre;
    // The azimuth turns by the golden angle from ray to ray.
    vec2 turned = vec2(cos(kTwoPi * xi.y), sin(kTwoPi * xi.y));
    const vec2 golden = vec2(-0.737368878, -0.675490294);
    float blocked = 0.0, shift = xi.z;
    for (uint i = 0u; i < rayCount; ++i) {
        float c = sqrt((float(i) + xi.x) / float(rayCount));  // even in the squared cosine: each ray counts alike
        float sine = sqrt(max(1.0 - c * c, 0.0));
        vec2 across = turned * sine;
        vec3 stride = (tangent * across.x + bitangent * across.y + up * c) * cellsPerStep;
        vec3 stridePixels = (tangentPixels * across.x + bitangentPixels * across.y + upPixels * c) * step;
        // Back to front: what is found last is nearest.
        float hit = -1.0;
        for (uint k = stepCount; k > 0u; --k) {
            float t = float(k - 1u) + shift;
            vec3 q = start + stridePixels * t, at = origin + stride * t;
            ivec2 shown;
            bool inside = texelOf(lens, q, shown);
            float slack = slackScale * (q.z * lens.scale.x + lens.scale.y);
#ifdef DEPTH_LAYERS
            // A span goes on for as long as cells behind it may hold its back: no ray steps over what is thin.
            Spans matter = unpackSpans(imageLoad(spans, shown));
            float behind = q.z - matter.first, next = q.z - matter.second, size = abs(matter.firstLength) + slackCells, nextSize = abs(matter.secondLength) + slackCells;
            vec3 d = surfaceAt(lens, shown, matter.first) - here, e = surfaceAt(lens, shown, matter.second) - here;
            bool two = matter.second > 0.0, unseen = behind > size && !(two && next > -slackCells && next < nextSize);
            bool ends = inside && (represented(behind, slack, size, dot(d, d), reach2) || two && represented(next, slack, nextSize, dot(e, e), reach2));
#else
            float zq = imageLoad(depth, shown).x;
            float behind = q.z - zq;
            vec3 d = surfaceAt(lens, shown, zq) - here;
            bool unseen = behind > slackCells, ends = inside && represented(behind, slack, thickness, dot(d, d), reach2);
#endif
            bool counts = occupied(volume, at) && (!inside || countsHidden && unseen);
            hit = ends ? -1.0 : counts ? t : hit;
        }
        // The receiver lies below the origin: as far from what stands on its surface, by lift * c farther from what faces the ray.
        blocked += hit >= 0.0 ? falloff(rho, hit * step + 0.5 * lift * c) : 0.0;
        turned = vec2(turned.x * golden.x - turned.y * golden.y, turned.x * golden.y + turned.y * golden.x);
        shift = fract(shift + 0.754877666);
    }
    imageStore(map, p, vec4(clamp(1.0 - blocked / float(rayCount), 0.0, 1.0)));
}

#endif
