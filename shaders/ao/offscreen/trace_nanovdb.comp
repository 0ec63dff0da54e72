// Off-screen occluders from a NanoVDB grid.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VOLUME_NANOVDB
#define VOLUME_BINDING 2
#include "trace.glsl"
