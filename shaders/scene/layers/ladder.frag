// The hits behind the visible one, sorted as they come.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/layers/ladder.glsl"

void main() { climb(); }
