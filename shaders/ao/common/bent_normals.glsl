// Raw bent normals as methods write them for bent_normals.comp: what is blocked of the hemisphere's mean direction, and the pixel's depth.
// Also the integrals of methods that cut the hemisphere into slices through the view ray v. In a slice a direction has the angle a from v,
// towards the side o: w = cos a v + sin a o, and its weight is (n.w) sin a.
#ifndef OBSCURA_BENT_NORMALS_GLSL
#define OBSCURA_BENT_NORMALS_GLSL

const float kWholeBent = 2.0 / 3.0;  // 1/pi integral of (n.w) w dw over the hemisphere is so many times n

// x, y, z in 11, 11 and 10 bits, each from -1 to 1.
uint packBent(vec3 b) {
    ivec3 i = ivec3(round(clamp(b, -1.0, 1.0) * vec3(1023.0, 1023.0, 511.0)));
    return uint(i.x & 2047) | uint(i.y & 2047) << 11 | uint(i.z) << 22;
}
vec3 unpackBent(uint bits) {
    int i = int(bits);
    return vec3(bitfieldExtract(i, 0, 11), bitfieldExtract(i, 11, 11), i >> 22) / vec3(1023.0, 1023.0, 511.0);
}
uvec4 rawBent(float depth, vec3 blocked) { return uvec4(floatBitsToUint(depth), packBent(blocked), 0, 0); }

// Twice the integral of w (n.w) sin a from the view ray to the angle of cosine c on a side of a slice, as its parts along v and o; nv and
// no are the normal's. GTAO's bent-normal term [Jimenez 2016, alg. 2], as a function of c, so that it needs no arc cosine.
vec2 bentArc(float nv, float no, float c) {
    float s = sqrt(max(1.0 - c * c, 0.0)), s3 = s * s * s, c3 = c * c * c;
    return (2.0 / 3.0) * vec2(nv * (1.0 - c3) + no * s3, nv * s3 + no * (2.0 + c3 - 3.0 * c));
}
// Mean direction between the angles of cosines `front` and `back` <= front, weighted by (n.w) sin a: its direction is exact, its length
// that of directions that are evenly spaced over the interval, to 0.04.
vec2 meanBent(float nv, float no, float front, float back) {
    vec2 f = vec2(front, sqrt(max(1.0 - front * front, 0.0))), b = vec2(back, sqrt(max(1.0 - back * back, 0.0)));
    vec2 d = bentArc(nv, no, back) - bentArc(nv, no, front);
    float length2 = dot(d, d), halfAngleCosine = sqrt(max(0.5 + 0.5 * dot(f, b), 0.0));
    return length2 > 1e-10 ? d * (inversesqrt(length2) * (2.0 + halfAngleCosine) / 3.0) : f;
}

// Sums over slices, whose directions are off by what few slices miss of the hemisphere. The part of it that stands for open directions is
// replaced by the exact one, so that an open hemisphere has no noise. blocked, whole: of the slices' integrals, of w; open: visibility.
vec3 blockedBent(vec3 blocked, vec3 whole, vec3 n, float open) { return blocked + (1.0 - open) * (kWholeBent * n - whole); }

#endif
