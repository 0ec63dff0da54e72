// Sums over a pixel's window, cut into one cell or four quadrants, from a summed-area table.
//
// Window edges are at any position between table lines: what lies between the lines before and behind an edge counts by the part inside, as
// is exact for an image of constant texels. A rectangle's sum, of four entries, is exact as an integer modulo 2^32.
#ifndef OBSCURA_STATISTICAL_WINDOW_GLSL
#define OBSCURA_STATISTICAL_WINDOW_GLSL
#include "ao/statistical/fixed_point.h"
#include "shared/octahedral.glsl"
#include "shared/view.h"

layout(constant_id = 0) const uint split = 2;  // cells along each side of a window: 1 or 2

// A table's line or column before a window's edge, and the edge's fraction between that and the next one.
struct Edge {
    uint line;
    float part;
};
Edge edgeAt(float at, uint size) {
    int whole = min(int(at), int(size) - 1);  // signed conversion is faster on CPUs
    return Edge(uint(whole), at - float(whole));
}

// Edges of a column of a window, table texels. With quadrants it is cut at y1 into an upper and a lower cell; else it ends there.
struct Column { float x0, x1, y0, y1, y2; };

// Sums over a column's two cells: heights above the tangent plane's parallel through the tables' origin, metres; number of pixels.
struct Sums { vec2 height, count; };
Sums minus(Sums a, Sums b) { return Sums(a.height - b.height, a.count - b.count); }

// The integer sum of a rectangle: (height, count).
vec2 seen(uvec4 sum, vec3 up) { return vec2(dot(up, vec3(ivec3(sum.xyz))), float(int(sum.w))); }

// Sums NAME(layer, c, size, up): of layer `layer`, from a buffer `table` of that size with `layers` layers per entry.
// up: the normal, metres per unit. A loop over lines, because compilers fetch all lines of unrolled code at once, into as many registers.
#define WINDOW_SUMS(NAME, table, layers)                                                                           \
Sums NAME(uint layer, Column c, uvec2 size, vec3 up) {                                                             \
    Edge x0 = edgeAt(c.x0, size.x), x1 = edgeAt(c.x1, size.x);                                                     \
    Sums cells = Sums(vec2(0.0), vec2(0.0));                                                                       \
    uvec4 s0 = uvec4(0u), s1 = s0, s2 = s0;  /* up to the line before: about x0, between the edges, about x1 */    \
    [[dont_unroll]] for (uint i = 0u; i < 2u + 2u * split; ++i) {                                                  \
        Edge y = edgeAt(i < 2u ? c.y0 : i < 4u ? c.y1 : c.y2, size.y);                                             \
        uint row = (y.line + (i & 1u)) * (size.x + 1u);                                                            \
        uint at0 = (row + x0.line) * layers + layer, at1 = (row + x1.line) * layers + layer;                       \
        uvec4 behind = table[at0 + layers], before = table[at1], next = behind - table[at0];                       \
        vec2 sum = (1.0 - x0.part) * seen(next - s0, up);                                                          \
        s0 = next;                                                                                                 \
        next = before - behind;                                                                                    \
        sum += seen(next - s1, up);                                                                                \
        s1 = next;                                                                                                 \
        next = table[at1 + layers] - before;                                                                       \
        sum += x1.part * seen(next - s2, up);                                                                      \
        s2 = next;                                                                                                 \
        vec2 weight = i == 1u ? vec2(1.0 - y.part, 0.0) : i == 3u ? vec2(y.part, 1.0 - y.part)                     \
                    : vec2(i == 2u ? 1.0 : 0.0, i == 4u ? 1.0 : i == 5u ? y.part : 0.0);                           \
        cells.height += sum.x * weight;                                                                            \
        cells.count += sum.y * weight;                                                                             \
    }                                                                                                              \
    return cells;                                                                                                  \
}

// The box of a pixel.
struct Shape {
    vec3 up;          // axis, metres per unit: the normal, or [eq. 4] the view axis
    float base;       // height of the pixel above the tangent plane's parallel through the tables' origin, metres
    float height;     // of the box, metres
    float slope;
};
Shape shapeOf(View view, Box box, Extent extent, vec2 pixel, float z, uint normal, float slope, bool viewAligned) {
    vec3 here = eyePosition(view, pixel, z), n = viewAligned ? vec3(0, 0, 1) : unpackNormal(normal);
    if (dot(n, towardsEye(view, here)) < 0.0) n = -n;
    return Shape(n / unitsPerMetre(view, box, extent), dot(vec3(here.xy, originOf(view, extent) - z), n), boxHeight(view, box, z), slope);
}

// Blocked fraction of a box by mean height: 1 at 1, 0 from 1 + 1 / slope on [Hendrickx, sec. 3.3].
float psi(float x, float slope) { return max(0.0, min(x, 1.0 + slope - slope * x)); }

// Blocked count of one layer, one component per cell: psi of its mean height above the tangent plane, times its count [Hendrickx, eq. 6,
// 7].
vec2 blockedBy(Sums sums, Shape s) {
    vec2 height = (sums.height / max(sums.count, 0.25) - s.base) / s.height;
    vec2 blocked = vec2(psi(height.x, s.slope), psi(height.y, s.slope)) * sums.count;
    return mix(vec2(0.0), blocked, greaterThanEqual(sums.count, vec2(0.25)));  // counts below are rounding of an empty cell
}

// The column `index` of a pixel's window.
Column columnAt(vec2 centre, vec2 reach, uvec2 size, uint index) {
    vec2 last = vec2(size), low = clamp(centre - reach, vec2(0.0), last), high = clamp(centre + reach, vec2(0.0), last);
    vec2 middle = split == 2u ? clamp(centre, vec2(0.0), last) : high;
    return Column(index == 0u ? low.x : middle.x, index == 0u ? middle.x : high.x, low.y, middle.y, high.y);
}

// 1 for each of a column's two cells, 0 if it is empty: at the frame's edge, or below if there is no lower cell.
vec2 cellsOf(Column c) { return vec2(c.x1 > c.x0 && c.y1 > c.y0, c.x1 > c.x0 && c.y2 > c.y1); }

// Pixels of a column's two cells, open ones too, at least a quarter.
vec2 pixelsOf(Box box, Column c) {
    float area = float(box.texelSide * box.texelSide);
    return max(area * (c.x1 - c.x0) * vec2(c.y1 - c.y0, c.y2 - c.y1), vec2(0.25));
}

#endif
