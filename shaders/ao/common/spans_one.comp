// Packs the first depth layer per pixel; layout: spans.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#define ONE_LAYER
#include "ao/common/pack_spans.glsl"
