// Where levels of depth lie (runtime/ao/depth_mips.h): sides are rounded up to whole texels of the coarsest level; level 0 stands at the
// left, the others to its right from the top down, each half the one before it. Under a picture that is wider than high, from the left
// on, so that no side grows beyond what the picture's longer one needs.
#ifndef OBSCURA_DEPTH_MIPS_GLSL
#define OBSCURA_DEPTH_MIPS_GLSL

const int kDepthLevels = 5;

ivec2 paddedSize(uvec2 size) { return ivec2(size + 15u) & ~15; }
// The texel of a level that pixel q lies in.
ivec2 mipTexel(ivec2 padded, ivec2 q, int level) {
    ivec2 beside = min(level, 1) * padded, along = max(padded - (2 * padded >> level), 0);
    return (q >> level) + (padded.x > padded.y ? ivec2(along.x, beside.y) : ivec2(beside.x, along.y));
}
// The other way round: the level at a place, and its texel.
int mipAt(ivec2 padded, ivec2 place, out ivec2 texel) {
    int level = 0;
    for (int i = 1; i < kDepthLevels; ++i) level += int(all(greaterThanEqual(place, mipTexel(padded, ivec2(0), i))));
    texel = place - mipTexel(padded, ivec2(0), level);
    return level;
}

#endif
