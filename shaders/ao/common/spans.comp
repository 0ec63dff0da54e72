// Packs two depth layers per pixel; layout: spans.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/pack_spans.glsl"
