// Off-screen occluders: rays through the volume, one invocation per map pixel. A ray ends where the method treats the depth buffer as
// solid, and counts if it hits a set cell before that; see runtime/ao/offscreen.h. In: volume, linear depth, packed normals; with
// DEPTH_LAYERS, packed layers. Out: 1 - B, depth and normal of the map's receivers.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant VOLUME_NANOVDB
#pragma variant DEPTH_LAYERS
#pragma variant VOLUME_NANOVDB,DEPTH_LAYERS
#define VOLUME_BINDING 2
#include "ao/common/lens.glsl"
#include "ao/common/map.glsl"
#include "ao/offscreen/constants.h"
#include "shared/falloff.h"
#ifdef DEPTH_LAYERS
#include "ao/common/packed_layers.glsl"
layout(set = 0, binding = 7, rgba32ui) uniform readonly uimage2D packedLayers;
#endif
layout(push_constant) uniform Block { OffscreenTrace constants; };

const float kTwoPi = 6.28318531;
const float kMostSteps = 64.0;
const float kSlackPixels = 1.5;    // points less than this behind the visible surface are on it
const float kSlackCells = 1.7321;  // a set cell less than this behind the visible surface may contain that surface

// Whether the method has counted a point, `behind` metres behind the visible surface, as blocked. size: thickness of that surface; far2:
// its squared distance from the receiver.
bool countedByMethod(float behind, float slack, float size, float far2, float reach2) {
    return behind > slack && behind < size && far2 < reach2;
}

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    Volume volume = volumeBlock;
    FalloffBlock rho = constants.falloff;
    openVolume();
    uint rayCount = constants.rays;
    float offsetCells = constants.offset, reach2 = constants.reach * constants.reach;
    bool countsHidden = constants.hidden != 0u;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(map)))) return;
    vec3 here, n;
    if (!receive(view, p, int(constants.scale), here, n)) return;

    // Ray points are kept in cells and in homogeneous pixels; a step adds one vector to each. The basis of the rays is in cell axes, so
    // that it does not rotate with the camera.
    Lens lens = lensOf(view);
    float metres = volume.anchor.w, lift = offsetCells * metres;
    vec3 up = cellsAlong(volume, n) * metres;
    vec3 receiver = cellOf(volume, here);
    vec3 origin = receiver + offsetCells * up, start = toPixels(lens, here + lift * n);
    vec3 xi = fract(cellNoise(latticeCell(volume, receiver, up, constants.grain)) + frameShift(view));
    vec3 tangent, bitangent;
    basisAround(up, tangent, bitangent);
    vec3 tangentPixels = toPixels(lens, eyeAlong(volume, tangent)), bitangentPixels = toPixels(lens, eyeAlong(volume, bitangent)),
         upPixels = toPixels(lens, n);

    uint stepCount = uint(clamp(ceil(rho.reach / (constants.stride * metres)), 1.0, kMostSteps));
    float step = rho.reach / float(stepCount), cellsPerStep = step / metres, slackCells = kSlackCells * metres;
    float slackScale = kSlackPixels / view.pixelsPerMetre;
    // The azimuth advances by the golden angle from ray to ray.
    vec2 azimuthVector = vec2(cos(kTwoPi * xi.y), sin(kTwoPi * xi.y));
    const vec2 golden = vec2(-0.737368878, -0.675490294);
    float blocked = 0.0, shift = xi.z;
    for (uint i = 0u; i < rayCount; ++i) {
        float c = sqrt((float(i) + xi.x) / float(rayCount));  // uniform in the squared cosine: all rays have the same weight
        float sine = sqrt(max(1.0 - c * c, 0.0));
        vec2 across = azimuthVector * sine;
        vec3 stride = (tangent * across.x + bitangent * across.y + up * c) * cellsPerStep;
        vec3 stridePixels = (tangentPixels * across.x + bitangentPixels * across.y + upPixels * c) * step;
        // Back to front: the last hit is the nearest.
        float hit = -1.0;
        for (uint k = 1u; k <= stepCount; ++k) {
            float t = float(stepCount - k) + shift;
            vec3 q = start + stridePixels * t, at = origin + stride * t;
            ivec2 texel;
            bool inside = texelOf(lens, q, texel);
            float slack = slackScale * (q.z * lens.scale.x + lens.scale.y);
#ifdef DEPTH_LAYERS
            // Layers are extended by the slack, because cells behind a back may contain it; rays then do not step over thin layers.
            Layers layers = unpackLayers(imageLoad(packedLayers, texel));
            float behind = q.z - layers.first, next = q.z - layers.second, size = abs(layers.firstLength) + slackCells,
                  nextSize = abs(layers.secondLength) + slackCells;
            vec3 d = surfaceAt(lens, texel, layers.first) - here, e = surfaceAt(lens, texel, layers.second) - here;
            bool two = layers.second > 0.0, isHidden = behind > size && !(two && next > -slackCells && next < nextSize);
            bool ends = inside && (countedByMethod(behind, slack, size, dot(d, d), reach2) ||
                                      two && countedByMethod(next, slack, nextSize, dot(e, e), reach2));
#else
            float zq = imageLoad(depth, texel).x;
            float behind = q.z - zq;
            vec3 d = surfaceAt(lens, texel, zq) - here;
            bool isHidden = behind > slackCells, ends = inside && countedByMethod(behind, slack, constants.thickness, dot(d, d), reach2);
#endif
            bool counts = occupied(volume, at) && (!inside || countsHidden && isHidden);
            hit = ends ? -1.0 : counts ? t : hit;
        }
        // Distance from the receiver, which is below the origin: between that to an occluder on its surface (no offset) and that to one
        // that faces the ray (lift * c).
        blocked += hit >= 0.0 ? falloff(rho, hit * step + 0.5 * lift * c) : 0.0;
        azimuthVector =
            vec2(azimuthVector.x * golden.x - azimuthVector.y * golden.y, azimuthVector.x * golden.y + azimuthVector.y * golden.x);
        shift = fract(shift + 0.754877666);
    }
    imageStore(map, p, vec4(clamp(1.0 - blocked / float(rayCount), 0.0, 1.0)));
}
