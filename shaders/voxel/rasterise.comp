// Triangles to the bits of a level of the volume, as runtime/voxel/rasterise.cpp, in single precision. A slack covers the rounding: no cell
// is lost, and cells that a triangle misses by less than the slack are set too. One invocation draws a small triangle; the workgroup draws
// a large one, one row per invocation. In: vertices of a primitive, or their posed positions, and indices. Out: bits, set by atomic OR,
// never cleared.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/volume.h"
#include "voxel/job.h"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Posed { float posedPositions[]; };
layout(set = 0, binding = 1, std430) buffer Bits { uint bits[]; };
layout(set = 1, binding = 0, std430) readonly buffer Vertices { float vertices[]; };
layout(set = 1, binding = 1, std430) readonly buffer Indices { uint indices[]; };
layout(push_constant) uniform Constants { VoxelJob jobConstants; };

// Largest number of cell columns of a triangle that one invocation draws.
const int kSmallColumns = 64;
const float kFarthest = 8388608.0;  // cells; above, floats have no fractions

shared uint largeCount;
shared uint large[gl_WorkGroupSize.x];

// The cross product of a triangle's edge with a box axis is a direction in the plane of the other two axes, s and t. Triangle and
// cell overlap along it while a s + b t, (s, t) the cell's lower corner, lies in [low, high].
struct Edge {
    float a, b, low, high;
};

Edge edgeOf(vec2 from, vec2 to, vec2 other, float slack, bool thin) {
    Edge e;
    e.a = from.y - to.y;
    e.b = to.x - from.x;
    float along = e.a * from.x + e.b * from.y, across = e.a * other.x + e.b * other.y;
    float sum = abs(e.a) + abs(e.b), middle = 0.5 * (e.a + e.b);
    float reach = 0.5 * (thin ? max(abs(e.a), abs(e.b)) : sum) + slack * sum;
    e.low = min(along, across) - middle - reach;
    e.high = max(along, across) - middle + reach;
    return e;
}

// Narrows a range of t to those that overlap at s.
vec2 narrow(Edge e, float s, vec2 range) {
    float from = e.low - e.a * s, to = e.high - e.a * s;
    bool constant = abs(e.b) < 1e-12;
    float inverse = 1.0 / (constant ? 1.0 : e.b), one = from * inverse, two = to * inverse;
    vec2 narrowed = vec2(max(range.x, ceil(min(one, two))), min(range.y, floor(max(one, two))));
    return constant ? (from <= 0.0 && to >= 0.0 ? range : vec2(1.0, 0.0)) : narrowed;
}

// A triangle's corner, in cells.
vec3 cornerOf(VoxelJob job, uint triangle, uint corner) {
    uint at = job.positions + indices[job.indices + 3u * triangle + corner] * 3u;
    vec4 p = job.posed != 0u ? vec4(posedPositions[at], posedPositions[at + 1u], posedPositions[at + 2u], 1.0)
                             : vec4(vertices[at], vertices[at + 1u], vertices[at + 2u], 1.0);
    return vec3(dot(job.rows[0], p), dot(job.rows[1], p), dot(job.rows[2], p));
}

// A triangle and the window's cells in its bounding box; axes rotated so that columns run along z, its normal's largest axis.
struct Shape {
    vec3 p0, p1, p2;  // cells from `low`, axes rotated
    ivec3 low, span;  // cells, axes rotated
    float slack;      // cells
    int axis;         // the original axis of z
};

ivec3 rotated(ivec3 v, int axis) { return axis == 2 ? v : axis == 0 ? v.yzx : v.zxy; }
vec3 rotated(vec3 v, int axis) { return axis == 2 ? v : axis == 0 ? v.yzx : v.zxy; }
ivec3 rotatedBack(ivec3 v, int axis) { return axis == 2 ? v : axis == 0 ? v.zxy : v.yzx; }

// False if the triangle is outside the window, too far from it, or not finite.
bool shapeOf(VoxelJob job, uint triangle, out Shape s) {
    vec3 p0 = cornerOf(job, triangle, 0u), p1 = cornerOf(job, triangle, 1u), p2 = cornerOf(job, triangle, 2u);
    vec3 lowest = min(min(p0, p1), p2), highest = max(max(p0, p1), p2), most = max(abs(lowest), abs(highest));
    float farthest = max(max(most.x, most.y), most.z);
    s.slack = max(1e-4, 4e-7 * farthest);
    vec3 total = p0 + p1 + p2;  // min and max can drop a NaN, a sum cannot
    bool valid = farthest < kFarthest && abs(total.x) + abs(total.y) + abs(total.z) < 16.0 * kFarthest;
    float side = float(job.corner.w);
    vec3 from = max(floor(lowest - s.slack), 0.0), to = min(floor(highest + s.slack), side - 1.0);
    if (!valid || any(lessThan(to, from))) return false;
    vec3 n = abs(cross(p1 - p0, p2 - p0));
    s.axis = n.z >= n.x && n.z >= n.y ? 2 : n.x >= n.y ? 0 : 1;
    s.low = rotated(ivec3(from), s.axis);
    s.span = rotated(ivec3(to), s.axis) - s.low;
    s.p0 = rotated(p0, s.axis) - vec3(s.low);
    s.p1 = rotated(p1, s.axis) - vec3(s.low);
    s.p2 = rotated(p2, s.axis) - vec3(s.low);
    return true;
}

// Draws the rows `first`, `first` + `every`, ...
void draw(VoxelJob job, Shape s, int first, int every) {
    bool thin = job.thin != 0u;
    Edge xy0 = edgeOf(s.p0.xy, s.p1.xy, s.p2.xy, s.slack, thin), xz0 = edgeOf(s.p0.xz, s.p1.xz, s.p2.xz, s.slack, thin),
         yz0 = edgeOf(s.p0.yz, s.p1.yz, s.p2.yz, s.slack, thin);
    Edge xy1 = edgeOf(s.p1.xy, s.p2.xy, s.p0.xy, s.slack, thin), xz1 = edgeOf(s.p1.xz, s.p2.xz, s.p0.xz, s.slack, thin),
         yz1 = edgeOf(s.p1.yz, s.p2.yz, s.p0.yz, s.slack, thin);
    Edge xy2 = edgeOf(s.p2.xy, s.p0.xy, s.p1.xy, s.slack, thin), xz2 = edgeOf(s.p2.xz, s.p0.xz, s.p1.xz, s.slack, thin),
         yz2 = edgeOf(s.p2.yz, s.p0.yz, s.p1.yz, s.slack, thin);

    // Height of the plane at the middle of a column, and the largest distance from it to the middle of an overlapping cell. The normal of a
    // thin triangle is inaccurate, which widens the distance; a degenerate one is decided by the edge tests alone.
    vec3 n = cross(s.p1 - s.p0, s.p2 - s.p0), size = max(abs(s.p1 - s.p0), abs(s.p2 - s.p0));
    float depth = abs(n.z), longest = max(max(size.x, size.y), size.z);
    bool hasNormal = depth > 1e-12;
    vec2 slope = hasNormal ? -n.xy / n.z : vec2(0.0);
    float reach = 0.5 + 0.5 * (thin ? 0.0 : abs(slope.x) + abs(slope.y)) + (hasNormal ? s.slack * (1.0 + 4.0 * longest / depth) : 1e9);
    for (int i = first; i <= s.span.x; i += every) {
        float x = float(i);
        vec2 across = narrow(xy2, x, narrow(xy1, x, narrow(xy0, x, vec2(0.0, s.span.y))));
        vec2 upright = narrow(xz2, x, narrow(xz1, x, narrow(xz0, x, vec2(0.0, s.span.z))));
        for (float y = across.x; y <= across.y; y += 1.0) {
            float height = s.p0.z + slope.x * (x + 0.5 - s.p0.x) + slope.y * (y + 0.5 - s.p0.y) - 0.5;
            vec2 up = vec2(max(upright.x, ceil(height - reach)), min(upright.y, floor(height + reach)));
            up = narrow(yz2, y, narrow(yz1, y, narrow(yz0, y, up)));
            for (float z = up.x; z <= up.y; z += 1.0) {
                uvec3 cell = uvec3(rotatedBack(s.low + ivec3(x, y, z), s.axis));
                Volume v;
                v.anchor = job.corner;
                uint word = job.firstWord + wordOf(v, cell, 0u), bit = 1u << bitOf(v, cell, 0u);
                if ((bits[word] & bit) == 0u) atomicOr(bits[word], bit);  // the read avoids most atomics: cells are set many times
            }
        }
    }
}

void main() {
    VoxelJob job = jobConstants;
    if (gl_LocalInvocationIndex == 0u) largeCount = 0u;
    barrier();
    uint triangle = gl_GlobalInvocationID.x;
    Shape s;
    if (triangle < job.triangles && shapeOf(job, triangle, s)) {
        if ((s.span.x + 1) * (s.span.y + 1) <= kSmallColumns) draw(job, s, 0, 1);
        else large[atomicAdd(largeCount, 1u)] = triangle;
    }
    barrier();
    for (uint i = 0u; i < largeCount; ++i)
        if (shapeOf(job, large[i], s)) draw(job, s, int(gl_LocalInvocationIndex), int(gl_WorkGroupSize.x));
}
