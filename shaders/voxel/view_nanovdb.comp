// Debug view of a NanoVDB volume.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VOLUME_NANOVDB
#define VOLUME_BINDING 2
#include "voxel/view.glsl"
