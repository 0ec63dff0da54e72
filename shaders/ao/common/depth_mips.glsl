// Layout of the depth levels in one image (runtime/ao/depth_mips.h). Sides are rounded up to whole texels of the coarsest level. Level 0 is
// at the top, each level below the one before, at the left, half as wide and high.
#ifndef OBSCURA_DEPTH_MIPS_GLSL
#define OBSCURA_DEPTH_MIPS_GLSL

const int kDepthLevels = 5;

ivec2 paddedSize(uvec2 size) { return ivec2(size + 15u) & ~15; }
// The texel of a level that contains pixel q. Level n begins at row end - (end >> n), where `end` is the row that the levels converge to.
ivec2 mipTexel(ivec2 padded, ivec2 q, int level) {
    int end = 2 * padded.y;
    return (q >> level) + ivec2(0, end - (end >> level));
}
// The same in one instruction less where the level differs between invocations, and more where it does not.
ivec2 mipTexelOfSample(ivec2 padded, ivec2 q, int level) {
    int end = 2 * padded.y;
    return ivec2(q.x >> level, (q.y - end >> level) + end);
}

#endif
