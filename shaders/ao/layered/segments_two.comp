// Segments of occlusion from two depth layers per texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TWO_LAYERS
#include "ao/layered/segments.glsl"
