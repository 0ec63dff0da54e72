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
#include "ao/common/volume_rays.glsl"
#include "ao/offscreen/constants.h"
#include "shared/falloff.h"
#ifdef DEPTH_LAYERS
#include "ao/common/packed_layers.glsl"
layout(set = 0, binding = 7, rgba32ui) uniform readonly uimage2D packedLayers;
#endif
layout(push_constant) uniform Block { OffscreenTrace constants; };

const float kTwoPi = 6.28318531;
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
    uint rayCount = constants.rays, stepCount = constants.steps;
    float reach2 = constants.reach * constants.reach;
    bool countsHidden = constants.hidden != 0u;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, constants.size))) return;
    vec3 here, n;
    if (!receive(view, p, int(constants.scale), here, n)) return;

    // Ray points are kept in cells and in homogeneous pixels; a step adds one vector to each. The basis of the rays is in cell axes, so
    // that it does not rotate with the camera.
    Lens lens = lensOf(view);
    vec3 up = cellsAlong(volume, n) * volume.centre.w, receiver = cellOf(volume, here);
    VolumeRays rays = volumeRays(volume, receiver, up, rho.reach, constants.offset, constants.stride, constants.octave, 0u);
    bool outside = hitWeight(volume, receiver) == 0.0;
    float metres = rays.metres, slackScale = kSlackPixels / view.pixelsPerMetre;
    uint grain = latticeSize(view, volume, rays.level, here, constants.grain);
    vec3 xi = fract(cellNoise(latticeCell(volume, receiver, up, grain)) + frameShift(view));
    vec3 tangent, bitangent;
    basisAround(up, tangent, bitangent);
    vec3 tangentPixels = toPixels(lens, eyeAlong(volume, tangent)) * metres,
         bitangentPixels = toPixels(lens, eyeAlong(volume, bitangent)) * metres, upPixels = toPixels(lens, n) * metres,
         start = toPixels(lens, here);

    // The azimuth advances by the golden angle from ray to ray.
    vec2 azimuthVector = vec2(cos(kTwoPi * xi.y), sin(kTwoPi * xi.y));
    const vec2 golden = vec2(-0.737368878, -0.675490294);
    float blocked = 0.0, shift = xi.z;
    for (uint i = 0u; i < rayCount; ++i) {
        float c = sqrt((float(i) + xi.x) / float(rayCount));  // uniform in the squared cosine: all rays have the same weight
        float sine = sqrt(max(1.0 - c * c, 0.0));
        vec2 across = azimuthVector * sine;
        vec3 ray = tangent * across.x + bitangent * across.y + up * c;
        vec3 rayPixels = tangentPixels * across.x + bitangentPixels * across.y + upPixels * c;
        float entry = outside ? entryOf(volume, rays, ray) : 0.0;
        // Back to front: the last hit is the nearest.
        uint hit = rays.count;
        for (uint k = 1u; k <= stepCount; ++k) {
            uint j = stepCount - k;
            if (j >= rays.count) continue;
            VolumeStep step = stepOf(rays, j, shift);
            vec3 q = start + rayPixels * step.t + upPixels * (constants.offset * step.grow);
            float slackCells = kSlackCells * metres * step.grow;
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
            bool counts = occupiedAt(volume, placeOf(rays, step, ray), step.level) && (!inside || countsHidden && isHidden) &&
                step.t >= entry;
            hit = ends ? rays.count : counts ? j : hit;
        }
        // Distance from the receiver, which is below the origin: between that to an occluder on its surface (no offset) and that to one
        // that faces the ray (offset * c).
        VolumeStep step = stepOf(rays, hit, shift);
        blocked += hit < rays.count
            ? hitWeight(volume, placeInWorld(rays, step, ray)) * falloff(rho, (step.t + 0.5 * constants.offset * c * step.grow) * metres)
            : 0.0;
        azimuthVector =
            vec2(azimuthVector.x * golden.x - azimuthVector.y * golden.y, azimuthVector.x * golden.y + azimuthVector.y * golden.x);
        shift = fract(shift + 0.754877666);
    }
    imageStore(map, p, vec4(clamp(1.0 - blocked / float(rayCount), 0.0, 1.0)));
}
