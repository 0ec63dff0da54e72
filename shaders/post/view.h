// Push constants of the passes in shaders/post: mapping of texels, and display modes.
#ifndef OBSCURA_POST_VIEW_H
#define OBSCURA_POST_VIEW_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct ViewBlock {
    uvec2 visible;   // size of the output, px
    vec2 scale;      // source texel = (pixel + 0.5) * scale + offset
    vec2 offset;
    uint mode;       // kView... below
    float exposure;
    vec4 linearize;  // as shared/view.h, for device depth
};
OBSCURA_SHARED_SIZE(ViewBlock, 48);

struct SplitBlock {
    uvec2 visible;
    uint divider;    // first column of the right side
    uint unused;
};
OBSCURA_SHARED_SIZE(SplitBlock, 16);

struct SamplesBlock {
    uvec2 count;     // of samples
    uvec2 guard;     // px before the visible part
    uint step;       // px from one sample to the next
    uint unused[3];
};
OBSCURA_SHARED_SIZE(SamplesBlock, 32);

struct DifferenceBlock {
    uvec2 visible;
    float scale;     // 1 / the difference at which colours saturate
    uint withSign;   // 0: absolute difference as grey; 1: false colours
};
OBSCURA_SHARED_SIZE(DifferenceBlock, 16);

#ifdef __cplusplus
inline constexpr
#else
const
#endif
uint kViewColor = 0,      // linear colour, sRGB-encoded
     kViewGrey = 1,       // first channel, unchanged
     kViewSecond = 2,     // second channel, unchanged
     kViewDeviceDepth = 3,
     kViewLinearDepth = 4,
     kViewMotion = 5,
     kViewNormal = 6,     // 32-bit packed normals
     kViewInteger = 7,    // other integers: the low byte of each channel
     kViewValues = 8,     // three channels, unchanged
     kViewHistory = 9,    // history of ao/common/temporal.comp: accumulated frames
     kViewRejected = 10,  // history of ao/common/temporal.comp: white where accumulation starts again
     kViewThickness = 11,  // ao::DepthLayers::thickness
     kViewSecondThickness = 12,  // thickness in ao::DepthLayers::second; black without a second layer
     kViewDirection = 13;  // d/2 + 1/2 of three signed channels

OBSCURA_SHARED_END
#endif
