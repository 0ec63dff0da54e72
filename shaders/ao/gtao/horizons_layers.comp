// GTAO from depth layers: in each slice of the hemisphere a sample blocks from its front to its back.
#version 460
#extension GL_GOOGLE_include_directive : require
#define DEPTH_LAYERS
#include "horizons.glsl"
