// Depth, normal and depth layers in the one texel that spans.glsl describes.
// In: depth, normals, what there is of the depth layers. Out: RGBA32UI, or RG32UI with ONE_SPAN.
#ifndef OBSCURA_PACK_SPANS_GLSL
#define OBSCURA_PACK_SPANS_GLSL
#include "ao/common/spans_at.glsl"
#ifdef ONE_SPAN
layout(set = 0, binding = 5, rg32ui) uniform writeonly uimage2D spans;
#else
layout(set = 0, binding = 5, rgba32ui) uniform writeonly uimage2D spans;
#endif
layout(push_constant) uniform Constants { Packing packing; };

void main() {
    View view = viewBlock;
    // Coarser levels beside the finest: each texel from the pixel that it holds.
    ivec2 stored = ivec2(gl_GlobalInvocationID.xy), padded = paddedSize(view.size), last = ivec2(view.size) - 1, cell;
    int level = mipAt(padded, stored, cell);
    if (any(greaterThan(cell << level, last))) return;
    uint normal;
    Spans result = spansAt(view, packing, pixelIn(cell, level, last), normal);
#ifdef ONE_SPAN
    imageStore(spans, stored, uvec4(packSpan(result, normal), 0u, 0u));
#else
    imageStore(spans, stored, packSpans(result, normal));
#endif
}

#endif
