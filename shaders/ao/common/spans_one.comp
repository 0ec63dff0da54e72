// One span of matter a pixel, as spans.glsl describes it.
#version 460
#extension GL_GOOGLE_include_directive : require
#define ONE_SPAN
#include "ao/common/pack_spans.glsl"
