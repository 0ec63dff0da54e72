// Horizon tracing and the occlusion below the horizon [Dimitrov, sec. 3.1, 3.2, 3.5]: a line starts in the tangent plane and is raised by
// surfaces in front of it. In: linear depth, packed normals, guard band included. Out: 1 - O_T, R16F; H^2 per direction for normal rays;
// with BENT also raw bent normals of what is blocked below the horizon.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant BENT
#include "ao/horizon_split/march.glsl"
#include "shared/octahedral.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D normals;
layout(set = 0, binding = 3, r16f) uniform writeonly image2D visibility;
layout(set = 0, binding = 4, r32ui) uniform writeonly uimage2D horizons;
#ifdef BENT
layout(set = 0, binding = 5, rg32ui) uniform writeonly uimage2D bentNormals;
#endif

// State of one direction's line. `sine`, of its elevation, is H.
struct Line {
    vec3 t, along;    // tangent; the same in homogeneous pixels
    float at, l;      // the next step: fraction of the radius, metres
    float sine, cosine;
    float before;     // falloff at the start of the current strip
    float occlusion;
#ifdef BENT
    vec2 bent;        // of what is blocked, along t and the normal
#endif
};

// One step. A surface in front of the line's end raises the line.
void march(inout Line line, Origin origin, vec3 start, vec3 up, Lens lens, FalloffBlock rho, Steps walk) {
    vec3 q = start + line.l * (line.cosine * line.along + line.sine * up);
    ivec2 texel;
    bool inside = texelOf(lens, q, texel);
    float z = imageLoad(depth, texel).x;
    vec3 v = surfaceAt(lens, texel, z) - origin.position;
    float square = dot(v, v);
    float inverse = inversesqrt(max(square, 1e-20));
    float s = dot(v, origin.n) * inverse, distance = square * inverse;
    float behind = q.z - z;
    bool raises = inside && behind > 0.0 && behind < walk.thickness && distance < walk.radius && dot(v, line.t) > 0.0 && s > line.sine;
    // Before the first rise a strip starts in the tangent plane, at the line itself, so one evaluation is enough.
    float here = falloff(rho, raises ? distance : line.l);
    // H^2 gained by this strip, weighted by the mean of its two ends [Dimitrov, eq. 6, sec. 3.5].
    line.occlusion += raises ? (s * s - line.sine * line.sine) * 0.5 * (here + max(here, line.before)) : 0.0;
#ifdef BENT
    // Integral of w (n.w) over the strip; with s the sine of the elevation, w = sqrt(1 - s^2) t + s n and the measure of n.w is s ds.
    float from2 = max(1.0 - line.sine * line.sine, 0.0), to2 = max(1.0 - s * s, 0.0);
    vec2 strip = vec2(from2 * sqrt(from2) - to2 * sqrt(to2), s * s * s - line.sine * line.sine * line.sine) / 3.0;
    line.bent += raises ? strip * 0.5 * (here + max(here, line.before)) : vec2(0.0);
#endif
    line.before = raises || line.sine == 0.0 ? here : line.before;
    line.sine = raises ? s : line.sine;
    line.cosine = sqrt(max(1.0 - line.sine * line.sine, 0.0));
    line.at += walk.part;
    line.l = metresAt(walk, line.at);
}

void main() {
    View view = viewBlock;  // copies, so that the loops hold them in registers
    FalloffBlock rho = constants.falloff;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    ivec2 texel = p + ivec2(view.guard);
    float z = imageLoad(depth, texel).x;
    if (isSky(view, z)) {
        imageStore(visibility, p, vec4(1.0));
#ifdef BENT
        imageStore(bentNormals, p, rawBent(z, vec3(0.0)));
#endif
        return;
    }
    Origin origin = originAt(view, texel, z, unpackNormal(imageLoad(normals, texel).x), constants.offset);
    Noise noise = noiseAt(view, p);
    Lens lens = lensOf(view);
    vec3 start = toPixels(lens, origin.position), up = toPixels(lens, origin.n);
    Steps walk = stepsOf(constants.steps, constants.radius, constants.spacing, constants.horizonThickness);
    Share share = shareOfPixel(view, p, noise, constants.directions, constants.side);
    vec2 direction = share.first;
    uint count = share.count;

#ifdef BENT
    vec3 bent = vec3(0.0), tangents = vec3(0.0);
#endif
    float occlusion = 0.0;
    uint word = 0u;
    // Two lines at a time, because the steps of one line depend on each other.
    for (uint i = 0u; i < count; i += 2u) {
        Line lines[2];
        for (uint k = 0u; k < 2u; ++k) {
            vec3 t = direction.x * origin.b + direction.y * origin.c;
            float at = mix(0.5, fract(noise.step + float(i + k) * kNextStep), constants.jitter) * walk.part;
            lines[k] = Line(t, toPixels(lens, t), at, metresAt(walk, at), 0.0, 1.0, 1.0, 0.0
#ifdef BENT
                , vec2(0.0)
#endif
            );
            direction = share.next * direction;
        }
        for (uint j = 0u; j < walk.count; ++j) {
            march(lines[0], origin, start, up, lens, rho, walk);
            march(lines[1], origin, start, up, lens, rho, walk);
        }
        if (i + 1u == count) lines[1].sine = lines[1].occlusion = 0.0;  // odd count: no second line
#ifdef BENT
        bent += lines[0].bent.x * lines[0].t + lines[0].bent.y * origin.n;
        tangents += lines[0].t;
        if (i + 1u < count) {
            bent += lines[1].bent.x * lines[1].t + lines[1].bent.y * origin.n;
            tangents += lines[1].t;
        }
#endif
        occlusion += lines[0].occlusion + lines[1].occlusion;
        // Rounded up, so that no ray starts below the horizon and the sum of both terms is at most 1.
        uvec2 sines = uvec2(ceil(vec2(lines[0].sine * lines[0].sine, lines[1].sine * lines[1].sine) * 255.0));
        word |= (min(sines.x, 255u) | min(sines.y, 255u) << 8) << (8u * (i & 2u));
        if ((i & 2u) != 0u || i + 2u >= count) {
            if (constants.rays != 0u) imageStore(horizons, wordAt(p, i >> 2, view.visible), uvec4(word));
            word = 0u;
        }
    }
#ifdef BENT
    float blocked = clamp(occlusion / float(count), 0.0, 1.0);
    imageStore(bentNormals, p, rawBent(z, bent * (2.0 / float(count)) + blocked * missed(tangents, float(count))));
#endif
    imageStore(visibility, p, vec4(clamp(1.0 - occlusion / float(count), 0.0, 1.0)));
}
