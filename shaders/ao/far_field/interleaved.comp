// Interleaved far-field obscurance; cells are points.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interleaved.glsl"
