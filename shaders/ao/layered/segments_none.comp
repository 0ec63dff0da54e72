// Segments of occlusion where there are no depth layers.
#version 460
#extension GL_GOOGLE_include_directive : require
#define NO_SPANS
#include "ao/layered/segments.glsl"
