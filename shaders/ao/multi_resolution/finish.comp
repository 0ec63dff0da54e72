// The finest level, whose pixels took all samples, joined with the coarser ones; see finish.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "finish.glsl"
