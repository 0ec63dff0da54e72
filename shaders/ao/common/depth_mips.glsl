// Layout of the depth levels in one image (runtime/ao/depth_mips.h). Sides are rounded up to whole texels of the coarsest level. Level 0 is
// at the top, each level below the one before, at the left, half as wide and high.
#ifndef OBSCURA_DEPTH_MIPS_GLSL
#define OBSCURA_DEPTH_MIPS_GLSL

const int kDepthLevels = 5;

ivec2 paddedSize(uvec2 size) { return ivec2(size + 15u) & ~15; }
// First row of a level; the texel of a level that contains pixel q.
int levelRow(ivec2 padded, int level) { return 2 * padded.y - (2 * padded.y >> level); }
ivec2 mipTexel(ivec2 padded, ivec2 q, int level) { return (q >> level) + ivec2(0, levelRow(padded, level)); }

#endif
