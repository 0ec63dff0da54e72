// The next hit behind one already known, of several.
#version 460
#extension GL_GOOGLE_include_directive : require
#define WHOLE_HITS
#include "scene/layers/peel.glsl"

void main() { peel(); }
