// Layout of the depth levels in one image (runtime/ao/depth_mips.h). Sides are rounded up to whole texels of the coarsest level. Level 0 is
// at the upper left; the other levels are to its right from the top down, each half as large as the one before. If the image is wider than
// high they are below level 0 from the left on, so that the longer side does not grow.
#ifndef OBSCURA_DEPTH_MIPS_GLSL
#define OBSCURA_DEPTH_MIPS_GLSL

const int kDepthLevels = 5;

ivec2 paddedSize(uvec2 size) { return ivec2(size + 15u) & ~15; }
// The texel of a level that contains pixel q.
ivec2 mipTexel(ivec2 padded, ivec2 q, int level) {
    ivec2 beside = min(level, 1) * padded, along = max(padded - (2 * padded >> level), 0);
    return (q >> level) + (padded.x > padded.y ? ivec2(along.x, beside.y) : ivec2(beside.x, along.y));
}
// The inverse: the level at a place of the image, and its texel.
int mipAt(ivec2 padded, ivec2 place, out ivec2 texel) {
    int level = 0;
    for (int i = 1; i < kDepthLevels; ++i) level += int(all(greaterThanEqual(place, mipTexel(padded, ivec2(0), i))));
    texel = place - mipTexel(padded, ivec2(0), level);
    return level;
}

#endif
