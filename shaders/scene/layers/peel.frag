// Depth layers, peeling: the nearest hit behind the visible one, for the first layer alone.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/layers/peel.glsl"

void main() { peel(); }
