// Hybrid obscurance, first pass, through the dense volume.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VOLUME_BINDING 2
#include "trace.glsl"
