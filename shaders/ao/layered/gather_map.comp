// Gathers interleaved shares to the pixels of the map.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TO_MAP
#include "ao/layered/gather.glsl"
