// Sums over a pixel's window, cut into one cell or four quadrants, from a summed-area table.
//
// Window edges are at any position: interpolating the exclusive table between its entries is the exact integral of an image of constant
// texels. Differences of entries against the window's first row and column are exact as integers modulo 2^32; they are converted to float
// only for interpolation.
#ifndef OBSCURA_STATISTICAL_WINDOW_GLSL
#define OBSCURA_STATISTICAL_WINDOW_GLSL

layout(constant_id = 0) const uint split = 2;  // cells along each side of a window: 1 or 2

// Table lines before and behind each edge, and the edge's fraction between the two.
struct Axis {
    uint a0, b0, a1, b1, a2, b2;
    float part0, part1, part2;
    vec2 width;  // of the cells, texels
};

Axis axisOf(float centre, float reach, uint size) {
    vec3 edges = clamp(centre + reach * vec3(-1.0, split == 2u ? 0.0 : 1.0, 1.0), 0.0, float(size));
    ivec3 whole = min(ivec3(edges), int(size) - 1);  // signed conversion is faster on CPUs
    vec3 part = edges - vec3(whole);
    uvec3 lines = uvec3(whole);
    return Axis(lines.x, lines.x + 1u, lines.y, lines.y + 1u, lines.z, lines.z + 1u, part.x, part.y, part.z, edges.yz - edges.xy);
}

// Sums above one table line, of the left and the right cells.
struct Halves { vec4 left, right; };

Halves mix(Halves a, Halves b, float t) { return Halves(mix(a.left, b.left, t), mix(a.right, b.right, t)); }

// mat4 NAME(layer, x, y, pitch): sums of the cells of layer `layer`, one per column, row by row, from a buffer `table` with `layers` layers
// per entry and `pitch` entries per row. Unrolled by hand, because compilers that do not unroll loops would keep the arrays in memory.
#define WINDOW_SUMS(NAME, table, layers)                                                                                 \
Halves NAME##Line(uint row, uint layer, Axis x, uvec4 top[6]) {                                                          \
    uvec4 left = table[(row + x.a0) * layers + layer];                                                                   \
    vec4 edge0 = x.part0 * vec4(ivec4(table[(row + x.b0) * layers + layer] - left - top[1]));                            \
    vec4 edge1 = mix(vec4(ivec4(table[(row + x.a1) * layers + layer] - left - top[2])),                                  \
                     vec4(ivec4(table[(row + x.b1) * layers + layer] - left - top[3])), x.part1);                        \
    if (split == 1u) return Halves(edge1 - edge0, vec4(0.0));                                                            \
    vec4 edge2 = mix(vec4(ivec4(table[(row + x.a2) * layers + layer] - left - top[4])),                                  \
                     vec4(ivec4(table[(row + x.b2) * layers + layer] - left - top[5])), x.part2);                        \
    return Halves(edge1 - edge0, edge2 - edge1);                                                                         \
}                                                                                                                        \
mat4 NAME(uint layer, Axis x, Axis y, uint pitch) {                                                                      \
    uint row = y.a0 * pitch;                                                                                             \
    uvec4 top[6];                                                                                                        \
    top[0] = table[(row + x.a0) * layers + layer];                                                                       \
    top[1] = table[(row + x.b0) * layers + layer] - top[0];                                                              \
    top[2] = table[(row + x.a1) * layers + layer] - top[0];                                                              \
    top[3] = table[(row + x.b1) * layers + layer] - top[0];                                                              \
    if (split == 2u) top[4] = table[(row + x.a2) * layers + layer] - top[0];                                             \
    if (split == 2u) top[5] = table[(row + x.b2) * layers + layer] - top[0];                                             \
    Halves edge0 = NAME##Line(y.b0 * pitch, layer, x, top);                                                              \
    edge0 = Halves(y.part0 * edge0.left, y.part0 * edge0.right);                                                         \
    Halves edge1 = mix(NAME##Line(y.a1 * pitch, layer, x, top), NAME##Line(y.b1 * pitch, layer, x, top), y.part1);       \
    if (split == 1u) return mat4(edge1.left - edge0.left, vec4(0.0), vec4(0.0), vec4(0.0));                              \
    Halves edge2 = mix(NAME##Line(y.a2 * pitch, layer, x, top), NAME##Line(y.b2 * pitch, layer, x, top), y.part2);       \
    return mat4(edge1.left - edge0.left, edge1.right - edge0.right, edge2.left - edge1.left, edge2.right - edge1.right); \
}

// The box of a pixel.
struct Shape {
    vec3 here, n;     // of the pixel
    float metres;     // per unit
    float height;     // of the box, metres
    float slope;
};

// Blocked fraction of a box by mean height: 1 at 1, 0 from 1 + 1 / slope on [Hendrickx, sec. 3.3].
vec4 psi(vec4 x, float slope) { return max(vec4(0.0), min(x, 1.0 + slope - slope * x)); }

vec4 counts(mat4 sums) { return vec4(sums[0].w, sums[1].w, sums[2].w, sums[3].w); }

// Blocked count of one layer, one component per cell: psi of its mean height above the tangent plane, times its count [Hendrickx, eq. 6,
// 7].
vec4 blockedBy(mat4 sums, Shape s) {
    vec4 count = counts(sums);
    vec4 height = vec4(s.n * s.metres, 0.0) * sums / max(count, 0.25) - dot(s.here, s.n);
    // Counts below 0.25 are rounding of an empty cell.
    return mix(vec4(0.0), psi(height / s.height, s.slope) * count, greaterThanEqual(count, vec4(0.25)));
}

// Mean over the non-empty cells of blocked / count; cells can be empty at the frame's edge.
float meanOfCells(vec4 blocked, vec4 count, Axis x, Axis y) {
    vec4 nonEmpty = vec4(greaterThan(vec4(x.width.xyxy * y.width.xxyy), vec4(0.0)));
    if (split == 1u) nonEmpty = vec4(1.0, 0.0, 0.0, 0.0);
    return dot(blocked / max(count, 0.25), nonEmpty) / max(dot(nonEmpty, vec4(1.0)), 1.0);
}

#endif
