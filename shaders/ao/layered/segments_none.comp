// Segments of occlusion from the depth buffer alone, with an assumed thickness.
#version 460
#extension GL_GOOGLE_include_directive : require
#define NO_LAYERS
#include "ao/layered/segments.glsl"
