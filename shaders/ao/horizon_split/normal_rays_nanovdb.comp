// Normal rays through a NanoVDB grid.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VOLUME_NANOVDB
#define VOLUME_BINDING 8
#include "normal_rays_voxels.glsl"
