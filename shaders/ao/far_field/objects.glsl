// Cells of objects, the surfaces with a known back in front of the background. A cell has means over all pixels of an interval, covered or
// not, so that cells of longer intervals and more lines are means of cells: coverage and, times coverage, unit / depth of front and back
// and the growth of the front's over the interval. One cell serves a direction and its opposite. Four halves in RG32UI.
#ifndef OBSCURA_FAR_FIELD_THINGS_GLSL
#define OBSCURA_FAR_FIELD_THINGS_GLSL

vec4 unpackObject(uvec2 cell) { return vec4(unpackHalf2x16(cell.x), unpackHalf2x16(cell.y)); }  // front, back, covered, gain
uvec2 packObject(vec4 object) { return uvec2(packHalf2x16(min(object.xy, 60000.0)), packHalf2x16(clamp(object.zw, -60000.0, 60000.0))); }

#endif
