// Packing of noisy visibility and edges for runtime/ao/edge_blur.h [XeGTAO]: visibility, up to kMostVisible in single pixels, and the
// connection to the four neighbours in two bits each.
#ifndef OBSCURA_EDGES_GLSL
#define OBSCURA_EDGES_GLSL

const float kMostVisible = 1.5;

// Connection (1) or edge (0) to the left, right, top and bottom neighbour, whose depths are `around`. A slope is not an edge. depth: z, or
// depthForTolerance().
vec4 edgesAt(float z, float depth, vec4 around) {
    vec4 steps = around - z;
    vec2 slope = 0.5 * (steps.yw - steps.xz);
    vec4 off = min(abs(steps), abs(steps + vec4(slope.x, -slope.x, slope.y, -slope.y)));
    return clamp(1.25 - off / (depth * 0.011), 0.0, 1.0);
}
uint packEdges(vec4 edges) {
    uvec4 e = uvec4(edges * 2.9 + 0.5);
    return e.x << 6 | e.y << 4 | e.z << 2 | e.w;
}
vec4 unpackEdges(uint noisy) { return vec4(uvec4(noisy) >> uvec4(22, 20, 18, 16) & 3u) / 3.0; }

uint packNoisy(float visibility, uint edges) { return uint(clamp(visibility / kMostVisible, 0.0, 1.0) * 65535.0 + 0.5) | edges << 16; }
float visibilityOf(uint noisy) { return float(noisy & 65535u) * (kMostVisible / 65535.0); }

#endif
