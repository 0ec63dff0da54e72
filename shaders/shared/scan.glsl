// Prefix sums of many lines, in place or from one buffer to another. The including shader defines where a line's elements are,
//     uvec4 scanLoad(uint line, uint i);               element i, called once or twice, by one invocation
//     void scanStore(uint line, uint i, uvec4 sum);    the sum of elements 0..i
// has a workgroup of kScanLines x kScanMost and calls scanLines() in all invocations. Each line is cut into `scanBlocks` blocks: an
// invocation sums its block, adds the sums of the blocks before it, and scans its block. With one block a line is read once, by one
// invocation, which is fastest on software devices. Sums wrap modulo 2^32, so the order of additions does not matter.
#ifndef OBSCURA_SCAN_GLSL
#define OBSCURA_SCAN_GLSL

layout(constant_id = 0) const uint scanBlocks = 16;  // at most kScanMost
shared uvec4 scanTotals[kScanMost][kScanLines];

// `inside`: false for invocations beyond the last line.
void scanLines(uint line, uint count, bool inside) {
    uint block = gl_LocalInvocationID.y, column = gl_LocalInvocationID.x;
    uint blockSize = (count + scanBlocks - 1u) / scanBlocks;
    uint first = min(block * blockSize, count), end = inside ? min(first + blockSize, count) : first;
    uvec4 sum = uvec4(0u);
    if (scanBlocks > 1u) {
        for (uint i = first; i < end; ++i) sum += scanLoad(line, i);
        scanTotals[block][column] = sum;
        barrier();
        sum = uvec4(0u);
        for (uint k = 0u; k < block; ++k) sum += scanTotals[k][column];
    }
    for (uint i = first; i < end; ++i) {
        sum += scanLoad(line, i);
        scanStore(line, i, sum);
    }
}

#endif
