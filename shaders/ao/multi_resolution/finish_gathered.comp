// Combines the gathered, interleaved finest level with the coarser ones; see finish.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#define GATHERED
#include "finish.glsl"
