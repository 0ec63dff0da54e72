// Normal rays through the window of bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VOLUME_BINDING 8
#include "normal_rays_voxels.glsl"
