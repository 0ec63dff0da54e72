// Cells: the depth field of an interval of a line, reduced to two heights as seen at two receiver angles [Timonen 2013, sec. 6],
//     m0 = max z,   m1 = max(z - s x)
// (x along the direction, z up towards the camera), which define the virtual point z = m0, x = (m0 - m1) / s. Points are averaged over
// lines as (unit / depth, x / depth in pixels from the interval's middle): the sky is 0 and slanted planes stay planes.
#ifndef OBSCURA_FAR_FIELD_GRID_GLSL
#define OBSCURA_FAR_FIELD_GRID_GLSL
#include "ao/far_field/constants.h"
#include "shared/view.h"

const uint kSingle = 0u, kPrefix = 1u, kPyramid = 2u, kDirect = 3u;  // averaging; direct: points are single texels, without cells

const float kEmptyHeight = -3.0e38;  // heights of an interval that is only sky or outside

// The image plane at depth 1 along a direction: x = from + pixels * step, pixels counted from the image centre.
struct Axis {
    float from, step;
    vec2 scale;  // factor to metres: depth * scale.x + scale.y
};
Axis axisOf(View view, vec2 along) {
    vec2 g = along * view.unproject.xy;
    float step = length(g);
    return Axis(dot(vec2(view.size) * 0.5 * view.unproject.xy + view.unproject.zw, g / step), step,
        view.orthographic > 0.5 ? vec2(0, 1) : vec2(1, 0));
}
float metresAt(Axis axis, float depth) { return depth * axis.scale.x + axis.scale.y; }

ivec2 texelOf(uint cell) { return ivec2(cell & (kCellsWide - 1u), cell / kCellsWide); }
// First cell of level n of a direction. With the pyramid a level has (lines >> n) x (intervals >> n) cells, else lines x (intervals >> n).
// `total` is a multiple of 4^levels (else 2^levels) and at least 4/3 (else 2) of level 0, so levels do not overlap.
uint levelBase(Direction d, uint n, uint averaging) { return d.base + d.total - (d.total >> (averaging == kPyramid ? 2u * n : n)); }

// The middle of interval j of a level with intervals of `width` px, in pixels from the image centre.
float middleOf(Direction d, float width, uint j) { return (float(j) + 0.5) * width - d.origin.x; }

// Virtual point of two heights: (unit / depth, pixels from `middle`).
vec2 pointOf(Axis axis, FarFieldConstants c, vec2 heights, float middle) {
    float depth = -heights.x;
    float x = (heights.x - heights.y) / c.slope;
    float pixels = (x / metresAt(axis, depth) - axis.from) / axis.step - middle;
    return heights.x > kEmptyHeight ? vec2(c.unit / depth, pixels) : vec2(0.0);
}
vec2 heightsOf(Axis axis, FarFieldConstants c, vec2 point, float middle) {
    float depth = c.unit / max(point.x, 1e-30);
    float x = ((point.y + middle) * axis.step + axis.from) * metresAt(axis, depth);
    return point.x > 0.0 ? vec2(-depth, -depth - c.slope * x) : vec2(kEmptyHeight);
}
uint packPoint(vec2 point) { return packHalf2x16(vec2(min(point.x, 60000.0), clamp(point.y, -60000.0, 60000.0))); }

#endif
