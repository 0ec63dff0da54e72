// Off-screen occluders from the dense volume, with depth layers.
#version 460
#extension GL_GOOGLE_include_directive : require
#define DEPTH_LAYERS
#define VOLUME_BINDING 2
#include "trace.glsl"
