// The next hit behind one already known.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/layers/peel.glsl"

void main() { peel(); }
