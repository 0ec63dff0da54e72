// Facts of a rasterized surface point that do not depend on its material.
#ifndef OBSCURA_SCENE_SURFACE_GLSL
#define OBSCURA_SCENE_SURFACE_GLSL

const float kFarAway = 32000.0;  // px: motion that leads off any image and still fits a half

// The triangle's own normal, facing the viewer. Interpolated positions of one triangle, helper invocations included, lie
// in its plane, so any two differences within a quad span it.
vec3 geometricNormal(vec3 eye, vec3 interpolated, bool orthographic) {
    vec3 n = cross(dFdx(eye), dFdy(eye));
    float length2 = dot(n, n);
    n = length2 > 1e-30 ? n * inversesqrt(length2) : normalize(interpolated);
    vec3 toEye = orthographic ? vec3(0.0, 0.0, 1.0) : -eye;
    return dot(n, toEye) < 0.0 ? -n : n;
}

#endif
