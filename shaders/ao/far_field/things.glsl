// Things: what ends before the background begins. An interval of a line keeps means over all of its pixels, covered or not, so that those of
// longer intervals and broader bands of lines are the means of theirs: the covered share, and times that share unit / depth of front and back
// and what the front's gains an interval along. One cell serves a direction and its opposite. As halves in RG32UI.
#ifndef OBSCURA_FAR_FIELD_THINGS_GLSL
#define OBSCURA_FAR_FIELD_THINGS_GLSL

vec4 unpackThing(uvec2 cell) { return vec4(unpackHalf2x16(cell.x), unpackHalf2x16(cell.y)); }  // front, back, covered, gain
uvec2 packThing(vec4 thing) { return uvec2(packHalf2x16(min(thing.xy, 60000.0)), packHalf2x16(clamp(thing.zw, -60000.0, 60000.0))); }

#endif
