// The sRGB transfer function [IEC 61966-2-1].
#ifndef OBSCURA_POST_SRGB_GLSL
#define OBSCURA_POST_SRGB_GLSL

vec3 encodeSrgb(vec3 c) {
    return mix(12.92 * c, 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

#endif
