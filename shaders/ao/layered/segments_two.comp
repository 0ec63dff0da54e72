// Segments of occlusion by two spans of matter a texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TWO_SPANS
#include "ao/layered/segments.glsl"
