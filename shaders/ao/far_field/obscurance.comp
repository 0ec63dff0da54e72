// Obscurance; cells are points.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "obscurance.glsl"
