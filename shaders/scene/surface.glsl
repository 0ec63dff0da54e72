// Geometric normal of a fragment; constant for motion that cannot be followed.
#ifndef OBSCURA_SCENE_SURFACE_GLSL
#define OBSCURA_SCENE_SURFACE_GLSL

const float kFarAway = 32000.0;  // px: motion out of any image; fits a half float

// The triangle's normal, facing the viewer. Interpolated positions, helper invocations included, are in the triangle's plane, so
// derivatives within a quad span it.
vec3 geometricNormal(vec3 eye, vec3 interpolated, bool orthographic) {
    vec3 n = cross(dFdx(eye), dFdy(eye));
    float length2 = dot(n, n);
    n = length2 > 1e-30 ? n * inversesqrt(length2) : normalize(interpolated);
    vec3 toEye = orthographic ? vec3(0.0, 0.0, 1.0) : -eye;
    return dot(n, toEye) < 0.0 ? -n : n;
}

#endif
