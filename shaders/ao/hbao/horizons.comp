// Horizon-based ambient occlusion [Bavoil 2008] from a depth buffer.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "horizons.glsl"
