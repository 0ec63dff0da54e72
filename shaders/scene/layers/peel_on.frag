// Depth layers, peeling: the next of three hits behind the visible one, for two layers.
#version 460
#extension GL_GOOGLE_include_directive : require
#define WHOLE_HITS
#include "scene/layers/peel.glsl"

void main() { peel(); }
