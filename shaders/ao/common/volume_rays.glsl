// Rays through the levels of the volume. Steps grow with the distance, and the cells that a step reads grow alike, so that a step is never
// longer than `stride` cells of its level, and the number of steps grows with the logarithm of the reach. From the receiver's level on,
//     step i of n = 2^octave steps an octave, level l = max(i / n, 1) - 1 above it: distance 2^l stride (i - n l + shift) cells
// so the first two octaves read the receiver's level, the third the next one, and so on. The receiver's level is the finest that holds the
// receiver and its first two octaves; each next level then holds its own.
// The includer defines VOLUME_BINDING (shared/volume.h).
#ifndef OBSCURA_VOLUME_RAYS_GLSL
#define OBSCURA_VOLUME_RAYS_GLSL
#include "shared/volume.h"

struct VolumeRays {  // of a receiver
    uint level;      // the receiver's
    uint above;      // levels above it that steps may read
    float stride;    // cells of the receiver's level, of the first steps
    uint octave;
    uint count;      // steps to the reach; volumeRaySteps() of runtime/ao/view.h is the most of them
    float metres;    // per cell of the receiver's level
    vec3 receiver;   // in cells of the receiver's level
    vec3 lift;       // cells of any level: how far above the surface samples are taken. Larger cells end higher above a plane
};

struct VolumeStep {
    float t;     // distance from the receiver's lifted place, cells of the receiver's level
    float grow;  // cells of the receiver's level per cell of this step's level
    uint level;
};

// receiver: place; up: normal, unit length in cells; reach: metres; stride: cells; equal: not 0: so many equal steps in one level.
VolumeRays volumeRays(Volume v, vec3 receiver, vec3 up, float reach, float lift, float stride, uint octave, uint equal) {
    const float kSlack = 4.0;  // cells, for lift and shift
    VolumeRays r;
    float far = farFromMiddle(v, receiver), cells = reach / v.centre.w, early = ldexp(stride, int(octave) + 1) + kSlack;
    uint wholly = levelWithin(v, far + cells + kSlack);
    r.level = equal > 0u ? wholly : min(wholly, ceilLog2(far / max(v.halfSide - early, 1.0)));
    r.level = min(r.level, v.levels - 1u);
    r.above = v.levels - 1u - r.level;
    r.metres = ldexp(v.centre.w, int(r.level));
    r.receiver = ldexp(receiver, ivec3(-int(r.level)));
    r.lift = up * lift;
    cells = ldexp(cells, -int(r.level));
    r.stride = stride;
    r.octave = octave;
    if (equal > 0u) {
        r.stride = cells / float(equal);
        r.octave = 31u;
        r.count = equal;
        return r;
    }
    // No ray is longer than the diagonal of the last level.
    cells = min(cells, 3.5 * ldexp(v.halfSide, int(r.above)));
    uint l = min(max(ceilLog2(ldexp(cells / stride, -int(octave))), 1u) - 1u, r.above);
    r.count = (l << octave) + uint(ceil(ldexp(cells / stride, -int(l))));
    return r;
}

VolumeStep stepOf(VolumeRays r, uint i, float shift) {
    VolumeStep s;
    uint l = min(max(i >> r.octave, 1u) - 1u, r.above);
    s.level = r.level + l;
    s.t = ldexp(r.stride * (float(i - (l << r.octave)) + shift), int(l));
    s.grow = ldexp(1.0, int(l));
    return s;
}
// Where step s of a ray is, in cells of its level; ray: unit length in cells.
vec3 placeOf(VolumeRays r, VolumeStep s, vec3 ray) { return (r.receiver + ray * s.t) * (1.0 / s.grow) + r.lift; }
// The same in cells of level 0.
vec3 placeInWorld(VolumeRays r, VolumeStep s, vec3 ray) { return ldexp(placeOf(r, s, ray), ivec3(int(s.level))); }
// Where a ray enters the last level, in cells of the receiver's level; 0 if the receiver is inside. Cells before it are those of elsewhere.
float entryOf(Volume v, VolumeRays r, vec3 ray) {
    vec3 from = r.receiver + r.lift, middle = ldexp(v.centre.xyz, ivec3(-int(r.level)));
    float half_ = ldexp(v.halfSide, int(r.above));
    vec3 inverse = 1.0 / mix(ray, vec3(1e-7), lessThan(abs(ray), vec3(1e-7)));
    vec3 entry = (middle - sign(inverse) * half_ - from) * inverse;
    return max(max(max(entry.x, entry.y), entry.z), 0.0);
}

#endif
