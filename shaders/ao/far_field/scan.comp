// Scan: heights of every interval of every line, in both directions along it [Timonen 2013, alg. 1]. Intervals are independent: an
// invocation handles one interval (pyramid) or a run of 2^(levels - 1), whose maxima of all levels it computes.
// In: linear depth, directions. Out: cells, as points; with SUMS as prefix.comp describes.
#version 460
#extension GL_GOOGLE_include_directive : require
#pragma variant SUMS
#include "ao/far_field/grid.glsl"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, std430) readonly buffer Directions { Direction directionsOf[]; };
#define CELLS_BINDING 3
#define CELLS_ACCESS writeonly
#include "ao/far_field/cells.glsl"
layout(push_constant) uniform Block { FarFieldConstants constants; };

const uint kMaxLevels = 8u;
const float kSkyHeight = -1.0e38;  // of an interval in the image with only sky
#ifdef SUMS
const bool kSky = true;
#else
const bool kSky = false;
#endif

// Heights along `d` (xy) and along its opposite (xz) over `steps` pixels from `first`; pixels from the image centre. Of an interval that is
// only sky, kSkyHeight.
vec3 scanInterval(View view, Direction d, Axis axis, float line, float first, uint steps) {
    vec3 heights = vec3(kEmptyHeight);
    vec2 at = vec2(view.size) * 0.5 + d.along * first + vec2(-d.along.y, d.along.x) * line;
    float x = axis.from + first * axis.step;
    ivec2 last = ivec2(view.size) - 1;
    vec2 size = vec2(view.size);
    for (uint i = 0u; i < steps; ++i) {
        float z = imageLoad(depth, clamp(ivec2(at), ivec2(0), last)).x;
        bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, size)), sky = z >= view.skyDepth;
        float rise = axis.slope * x * metresAt(axis, z);
        vec3 seen = kSky && sky ? vec3(kSkyHeight) : vec3(-z, -z - rise, -z + rise);
        heights = inside && (kSky || !sky) ? max(heights, seen) : heights;
        at += d.along;
        x += axis.step;
    }
    return heights;
}

void store(Direction d, Axis axis, FarFieldConstants c, uint level, uint line, uint j, vec2 heights) {
    ivec2 at = texelOf(levelBase(d, level, kAveraging) + j * d.lines + line);
#ifdef SUMS
    uint counts = heights.x > kSkyHeight ? 0x10001u : heights.x > kEmptyHeight ? 0x10000u : 0u;
    imageStore(cells, at, uvec4(heights.x > kSkyHeight ? floatBitsToUint(heights) : uvec2(0u), counts, 0u));
#else
    float width = ldexp(c.interval, int(level));
    imageStore(cells, at, uvec4(packPoint(pointOf(axis, c, heights, middleOf(d, width, j)), ldexp(c.perInterval, -int(level)))));
#endif
}

void main() {
    View view = viewBlock;  // copies, so that the loop holds them in registers
    FarFieldConstants c = constants;
    uint k = c.first + gl_GlobalInvocationID.z;
    Direction d = directionsOf[k], back = directionsOf[k + (c.paired != 0u ? c.directions / 2u : 0u)];
    uint line = gl_GlobalInvocationID.x, run = kAveraging == kPyramid ? 1u : 1u << (c.levels - 1u);
    uint first = gl_GlobalInvocationID.y * run;
    if (line >= d.lines || first >= d.intervals) return;
    Axis axis = axisOf(view, d), backAxis = axisOf(view, back);
    float across = (float(line) + 0.5) * c.lineStep - d.origin.y;
    uint steps = uint(c.interval), lineBack = d.lines - 1u - line;
    vec3 pending[kMaxLevels];
    for (uint i = 0u; i < run; ++i) {
        vec3 heights = scanInterval(view, d, axis, across, middleOf(d, c.interval, first + i) - 0.5 * c.interval + 0.5, steps);
        for (uint n = 0u; n < c.levels; ++n) {  // two maxima combine into one of the next level
            uint j = (first + i) >> n;
            store(d, axis, c, n, line, j, heights.xy);
            if (c.paired != 0u) store(back, backAxis, c, n, lineBack, (d.intervals >> n) - 1u - j, heights.xz);
            if (((i >> n) & 1u) == 0u) {
                pending[n] = heights;
                break;
            }
            heights = max(heights, pending[n]);
        }
    }
}
