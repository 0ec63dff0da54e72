// Where levels of depth lie (runtime/ao/depth_mips.h): sides are rounded up to whole texels of the coarsest level; level 0 stands at the
// left, the others to its right from the top down, each half the one before it.
#ifndef OBSCURA_DEPTH_MIPS_GLSL
#define OBSCURA_DEPTH_MIPS_GLSL

const int kDepthLevels = 5;

ivec2 paddedSize(uvec2 size) { return ivec2(size + 15u) & ~15; }
// The texel of a level that pixel q lies in.
ivec2 mipTexel(ivec2 padded, ivec2 q, int level) {
    return (q >> level) + ivec2(min(level, 1) * padded.x, max(padded.y - (2 * padded.y >> level), 0));
}

#endif
