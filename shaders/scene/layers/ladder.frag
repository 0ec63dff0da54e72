// Depth layers, ladder: inserts a fragment into the three nearest hits behind the visible one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/layers/ladder.glsl"

void main() { insertHit(); }
