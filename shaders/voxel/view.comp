// Debug view of the volume: ray-traced from the camera, shaded by the cell's face, with a random grey per cell; or a map of one layer of
// cells, with outlines of bricks and a cross at the camera. Each place shows the finest level that holds it. In: the volume.
// Out: an image of the visible size.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant VOLUME_NANOVDB
#define VOLUME_BINDING 2
#include "shared/view.h"
#include "shared/volume.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, std140) uniform VolumeBlock { Volume volumeBlock; };
layout(set = 0, binding = 3, rgba8) uniform writeonly image2D picture;
layout(push_constant) uniform Constants {
    int axis;     // normal of the layer, 0 to 2; -1: view from the camera
    float layer;  // position along the axis, in cells from the window's lowest corner
    float shown;  // cells along the shorter side of the map
};

float greyOf(ivec3 cell) {
    uvec3 v = uvec3(cell) * uvec3(73856093u, 19349663u, 83492791u);
    uint h = (v.x ^ v.y ^ v.z) * 2654435761u;
    return 0.86 + 0.14 * float(h >> 16 & 255u) / 255.0;
}

vec3 traced(View view, Volume volume, ivec2 p) {
    vec2 pixel = vec2(p + ivec2(view.guard)) + 0.5;
    bool parallel = view.orthographic > 0.5;
    vec3 from = cellOf(volume, parallel ? eyePosition(view, pixel, 0.0) : vec3(0.0));
    vec3 along = normalize(cellsAlong(volume, parallel ? vec3(0, 0, -1) : eyePosition(view, pixel, 1.0)));
    vec3 inverse = 1.0 / mix(along, vec3(1e-7), lessThan(abs(along), vec3(1e-7)));
    float half_ = ldexp(volume.halfSide, int(volume.levels) - 1) * 0.9999;
    vec3 low = volume.centre.xyz - half_, high = volume.centre.xyz + half_;
    vec3 one = (low - from) * inverse, two = (high - from) * inverse, near = min(one, two), far = max(one, two);
    const float kNudge = 2e-3;  // cells, into the next cell
    float t = max(max(max(near.x, near.y), near.z), 0.0) + kNudge, end = min(min(far.x, far.y), far.z);
    int side = near.x >= near.y && near.x >= near.z ? 0 : near.y >= near.z ? 1 : 2;
    for (int i = 0; i < 2048 && t < end; ++i) {
        vec3 at = from + along * t;
        float size = emptySide(volume, at);
        if (size == 0.0) {
            vec3 n = vec3(0.0);
            n[side] = -sign(along[side]);
            float cell = ldexp(1.0, int(levelWithin(volume, farFromMiddle(volume, at))));
            vec3 inCell = abs(fract(at / cell) - 0.5);
            inCell[side] = 0.0;
            // Outlines where a cell is wider than 5 pixels.
            float pixels = cell * view.pixelsPerMetre * volume.centre.w / max(parallel ? 1.0 : t * volume.centre.w, 1e-3);
            float outline = pixels > 5.0 && max(max(inCell.x, inCell.y), inCell.z) > 0.5 - 0.6 / pixels ? 0.75 : 1.0;
            float light = 0.62 + 0.26 * n.y + 0.12 * abs(n.x);
            vec3 tint = mix(vec3(0.95), n * 0.5 + 0.5, 0.35);
            return tint * (light * outline * greyOf(ivec3(floor(at / cell))));
        }
        // To the end of the empty cube, which is aligned to its size.
        vec3 begin = cubeBegin(volume, at, size);
        vec3 leave = (begin + step(0.0, along) * size - from) * inverse;
        side = leave.x <= leave.y && leave.x <= leave.z ? 0 : leave.y <= leave.z ? 1 : 2;
        t = max(leave[side], t) + kNudge;
    }
    return vec3(0.07, 0.08, 0.10);
}

vec3 layerMap(View view, Volume volume, ivec2 p) {
    vec2 size = vec2(view.visible);
    vec2 at = (vec2(p) + 0.5 - 0.5 * size) * (shown / min(size.x, size.y));
    vec3 eye = cellOf(volume, vec3(0.0)), middle = volume.anchor.w > 0u ? volume.centre.xyz : eye;
    // Seen along y: x to the right, z down. Seen along x or z: y up.
    vec3 place = middle + (axis == 1 ? vec3(at.x, 0, at.y) : axis == 0 ? vec3(0, -at.y, at.x) : vec3(at.x, -at.y, 0));
    place[axis] = layer;
    vec3 apart = abs(place - eye) * (min(size.x, size.y) / shown);  // pixels
    apart[axis] = 0.0;
    vec2 cross_ = axis == 1 ? apart.xz : axis == 0 ? apart.yz : apart.xy;
    if (min(cross_.x, cross_.y) < 1.0 && max(cross_.x, cross_.y) < 9.0) return vec3(1.0, 0.3, 0.2);
    uint level = levelWithin(volume, farFromMiddle(volume, place));
    if (level >= volume.levels) return vec3(0.03);
    vec3 inLevel = ldexp(place, ivec3(-int(level))), inBrick = fract(inLevel / 8.0) * 8.0;
    if (occupied(volume, place)) return vec3(0.93, 0.88, 0.72) * greyOf(ivec3(floor(inLevel)));
    inBrick[axis] = 8.0;
    float line = ldexp(shown / min(size.x, size.y), -int(level));
    return min(min(inBrick.x, inBrick.y), inBrick.z) < line ? vec3(0.17, 0.20, 0.25) : vec3(0.10, 0.12, 0.15);
}

void main() {
    View view = viewBlock;
    Volume volume = volumeBlock;
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(view.visible)))) return;
    openVolume();
    imageStore(picture, p, vec4(axis < 0 ? traced(view, volume, p) : layerMap(view, volume, p), 1.0));
}
