// Combines the finest level with the coarser ones; no interleaving. See finish.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "finish.glsl"
