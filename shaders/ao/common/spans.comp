// Up to two spans of matter a pixel, as spans.glsl describes them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/pack_spans.glsl"
