// What each slice of the hemisphere holds, of depth layers: what ends blocks no more than from its front to its back.
#version 460
#extension GL_GOOGLE_include_directive : require
#define DEPTH_LAYERS
#include "horizons.glsl"
