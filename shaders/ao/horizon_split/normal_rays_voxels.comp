// Normal rays through the dense volume.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VOLUME_BINDING 8
#include "normal_rays_voxels.glsl"
