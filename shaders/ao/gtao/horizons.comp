// Two horizons for each slice of the hemisphere, of a depth buffer.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "horizons.glsl"
