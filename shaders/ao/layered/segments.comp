// Segments of occlusion from one depth layer per texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/layered/segments.glsl"
