// GTAO from a depth buffer: two horizons for each slice of the hemisphere.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "horizons.glsl"
