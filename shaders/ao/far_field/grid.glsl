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
    float slope;  // s
};
Axis axisOf(View view, Direction d) { return Axis(d.from, d.step, view.orthographic > 0.5 ? vec2(0, 1) : vec2(1, 0), d.slope); }
float metresAt(Axis axis, float depth) { return depth * axis.scale.x + axis.scale.y; }

// Directions of a batch: their number, and number i.
uint batchOf(FarFieldConstants c) { return c.paired != 0u ? 2u * c.count : c.count; }
uint directionOf(FarFieldConstants c, uint i) { return c.first + i + (i < c.count ? 0u : c.directions / 2u - c.count); }
bool inBatch(FarFieldConstants c, uint k) { return (c.paired != 0u ? k % (c.directions / 2u) : k) - c.first < c.count; }

ivec2 texelOf(uint cell) { return ivec2(cell & (kCellsWide - 1u), cell / kCellsWide); }
// First cell of level n of a direction. With the pyramid a level has (lines >> n) x (intervals >> n) cells, else lines x (intervals >> n).
// `total` is a multiple of 4^levels (else 2^levels) and at least 4/3 (else 2) of level 0, so levels do not overlap.
uint levelBase(Direction d, uint n, uint averaging) { return d.base + d.total - (d.total >> (averaging == kPyramid ? 2u * n : n)); }

// The beginning (for heightsOf()) and the middle of interval j of a level with intervals of `width` px, in pixels from the image centre.
float startOf(Direction d, float width, uint j) { return (float(j) + 0.5 / 256.0) * width - d.origin.x; }
float middleOf(Direction d, float width, uint j) { return (float(j) + 0.5) * width - d.origin.x; }

const float kLeastPoint = 1.0e-30;  // of unit / depth; less is no point

// Virtual point of two heights: (unit / depth, pixels from `middle`).
vec2 pointOf(Axis axis, FarFieldConstants c, vec2 heights, float middle) {
    float depth = -heights.x;
    float x = (heights.x - heights.y) / axis.slope;
    float pixels = (x / metresAt(axis, depth) - axis.from) / axis.step - middle;
    return heights.x > kEmptyHeight ? vec2(c.unit / depth, pixels) : vec2(0.0);
}
// A cell without SUMS: unit / depth as a float, whose lowest byte is the point's place in the interval, in 256ths of its length. The byte
// stays when the depth is read, so depths are exact to 2^-15. No point: depth 0, in the middle.
uint packPoint(vec2 point, float perWidth) {  // perWidth: 256 / length of the interval
    return bitfieldInsert(floatBitsToUint(point.x), uint(clamp(point.y * perWidth + 128.0, 0.0, 255.0)), 0, 8);
}
float placeIn(uint cell) { return float(cell & 255u); }  // half a 256th less than the point's place

// Heights of a cell without SUMS, whose interval begins `start` pixels from the image centre, and half a 256th of its length.
vec2 heightsOf(Axis axis, FarFieldConstants c, uint cell, float width, float start) {
    float point = uintBitsToFloat(cell), depth = c.unit / max(point, kLeastPoint);
    float x = ((placeIn(cell) * (width / 256.0) + start) * axis.step + axis.from) * metresAt(axis, depth);
    return point > kLeastPoint ? vec2(-depth, -depth - axis.slope * x) : vec2(kEmptyHeight);
}

#endif
