// Gathers interleaved shares to the pixels of the image.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/layered/gather.glsl"
