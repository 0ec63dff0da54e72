// Hybrid obscurance, first pass [Reinbothe 2009, eq. 4], whatever holds the volume: a cone of rays through its cells, one invocation a
// pixel of the map. In: volume, linear depth, packed normals. Out: visibility of the map's receivers, and what they are. Formulas in
// runtime/ao/methods/hybrid.cpp.
#ifndef OBSCURA_HYBRID_TRACE_GLSL
#define OBSCURA_HYBRID_TRACE_GLSL
#include "ao/common/map.glsl"
#include "ao/common/tile.glsl"
#include "shared/falloff.h"
layout(push_constant) uniform Constants {
    FalloffBlock falloffBlock;
    uint rays;
    uint steps;
    uint scale;      // pixels a map's pixel, each way
    float cone;      // cosine of the half angle that rays keep to
    float offset;    // of their origin along the normal, cells
    float jitter;    // 1: steps are shifted for each ray; 0: half a step
    float grain;     // cells a side of the noise's
    uint side;       // of the tile whose pixels share out the rays; 1: each traces all
};

const float kTwoPi = 6.28318531, kGolden = -2.39996323, kShift = 0.754877666;

void main() {
    View view = viewBlock;
    Volume volume = volumeBlock;
    FalloffBlock rho = falloffBlock;
    openVolume();
    uint rayCount = rays, stepCount = steps;
    float coneCosine = cone, offsetCells = offset, jitterOfSteps = jitter;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, imageSize(map)))) return;
    vec3 here, n;
    if (!receive(view, p, int(scale), here, n)) return;

    // From here on in cells: a step is one vector, and turning into the world is done once.
    float metres = volume.anchor.w;
    vec3 normal = cellsAlong(volume, n) * metres;
    vec3 receiver = cellOf(volume, here);
    vec3 origin = receiver + offsetCells * normal;
    // Noise of the place, not of the pixel: it rests on the surface while the camera moves.
    vec3 xi = fract(cellNoise(latticeCell(volume, receiver, normal, grain)) + frameShift(view));
    vec3 tangent, bitangent;
    around(normal, tangent, bitangent);

    float step = rho.reach / float(stepCount), cellsPerStep = step / metres;
    float lift = offsetCells * metres;
    // The azimuth turns by the golden angle from ray to ray. Of those that are shared out, each pixel has every so many.
    uint shares = side * side, share = side > 1u ? shareOf(view, p, side) : 0u;
    float azimuth = kTwoPi * xi.y + kGolden * float(share);
    vec2 turned = vec2(cos(azimuth), sin(azimuth));
    vec2 onward = side > 1u ? vec2(cos(kGolden * float(shares)), sin(kGolden * float(shares))) : vec2(-0.737368878, -0.675490294);
    // An origin that lies in a set cell is beside another surface: which half of its rays that blocks, bits do not say, so each
    // counts half, and then goes on from where the cell ends.
    bool buried = occupied(volume, origin);
    float nearest = buried ? 1.0 / cellsPerStep : 0.0, half0 = buried ? 0.5 : 0.0;
    float blocked = 0.0, total = 0.0, shift = fract(xi.z + kShift * float(share)), shiftOnward = kShift * float(shares);
    for (uint i = share; i < rayCount; i += shares) {
        float c = mix(coneCosine, 1.0, (float(i) + xi.x) / float(rayCount));
        float sine = sqrt(max(1.0 - c * c, 0.0));
        vec3 stride = (tangent * (turned.x * sine) + bitangent * (turned.y * sine) + normal * c) * cellsPerStep;
        float first = mix(0.5, shift, jitterOfSteps);
        // Back to front: the last hit is the nearest.
        float hit = -1.0;
        for (uint k = stepCount; k > 0u; --k) {
            float t = float(k - 1u) + first;
            vec3 at = origin + stride * t;
            hit = occupied(volume, at) && t >= nearest ? t : hit;
        }
        // From the receiver, not from the lifted origin: as far as to a surface that faces the ray.
        float far = hit >= 0.0 ? falloff(rho, hit * step + lift * c) : 0.0;
        blocked += c * mix(far, falloff(rho, lift * c), half0);
        total += c;
        turned = vec2(turned.x * onward.x - turned.y * onward.y, turned.x * onward.y + turned.y * onward.x);
        shift = fract(shift + shiftOnward);
    }
    // A share's rays have other cosines than the next one's: over what a share has in the mean, so that shares add up to the whole. Such
    // a part may be below 0.
    if (side > 1u) total = float(rayCount / shares) * mix(coneCosine, 1.0, (0.5 * float(rayCount - 1u) + xi.x) / float(rayCount));
    imageStore(map, p, vec4(min(1.0 - blocked / total, 1.0)));
}

#endif
