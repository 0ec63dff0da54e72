// Prefix sums of many lines at once, in place or from one place to another. The including shader says where a line's
// elements are,
//     uvec4 scanLoad(uint line, uint i);               element i, called once or twice, by one invocation
//     void scanStore(uint line, uint i, uvec4 sum);    the sum of elements 0..i
// has a workgroup of kScanLines x kScanMost and calls scanLines() in all its invocations. Each line is cut into `scanParts`
// parts: an invocation adds up its part, learns what the parts before it hold, and goes over its part once more. With one
// part a line is read once, by one invocation: right for a processor with few threads. Sums are modular 32-bit integers, so
// the order of additions cannot show.
#ifndef OBSCURA_SCAN_GLSL
#define OBSCURA_SCAN_GLSL

layout(constant_id = 0) const uint scanParts = 16;  // at most kScanMost
shared uvec4 scanTotals[kScanMost][kScanLines];

// `live` is false for invocations beyond the last line.
void scanLines(uint line, uint count, bool live) {
    uint part = gl_LocalInvocationID.y, column = gl_LocalInvocationID.x;
    uint share = (count + scanParts - 1u) / scanParts;
    uint first = min(part * share, count), end = live ? min(first + share, count) : first;
    uvec4 sum = uvec4(0u);
    if (scanParts > 1u) {
        for (uint i = first; i < end; ++i) sum += scanLoad(line, i);
        scanTotals[part][column] = sum;
        barrier();
        sum = uvec4(0u);
        for (uint k = 0u; k < part; ++k) sum += scanTotals[k][column];
    }
    for (uint i = first; i < end; ++i) {
        sum += scanLoad(line, i);
        scanStore(line, i, sum);
    }
}

#endif
