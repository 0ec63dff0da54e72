// Segments of occlusion by one span of matter a texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/layered/segments.glsl"
