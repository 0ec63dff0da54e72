// Unit vectors in 32 bits: octahedral map, two signed 16-bit components [Cigolle 2014, A Survey of Efficient
// Representations for Independent Unit Vectors]. The largest error is about 0.004 degrees.
#ifndef OBSCURA_OCTAHEDRAL_GLSL
#define OBSCURA_OCTAHEDRAL_GLSL

vec2 toOctahedron(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? n.xy : folded;
}
// The unpacked vector without normalisation, for callers that divide by its length anyway. `one`: the packed value of 1.
vec3 directionOf(vec2 e, float one) {
    vec3 n = vec3(e, one - abs(e.x) - abs(e.y));
    float t = max(-n.z, 0.0);
    return vec3(n.xy - vec2(n.x >= 0.0 ? t : -t, n.y >= 0.0 ? t : -t), n.z);
}
vec3 fromOctahedron(vec2 e) { return normalize(directionOf(e, 1.0)); }

uint packNormal(vec3 n) { return packSnorm2x16(toOctahedron(n)); }
vec3 unpackNormal(uint bits) { return fromOctahedron(unpackSnorm2x16(bits)); }
vec3 directionOf(uint bits) { return directionOf(vec2(int(bits << 16) >> 16, int(bits) >> 16) * (1.0 / 32767.0), 1.0); }

#endif
