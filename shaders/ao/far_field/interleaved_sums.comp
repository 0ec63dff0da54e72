// Interleaved far-field obscurance; cells are prefix sums.
#version 460
#extension GL_GOOGLE_include_directive : require
#define SUMS
#include "interleaved.glsl"
