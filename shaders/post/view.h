// How a picture is made of an image: which texels, and what their values mean.
#ifndef OBSCURA_POST_VIEW_H
#define OBSCURA_POST_VIEW_H
#include "shared/types.h"
OBSCURA_SHARED_BEGIN

struct ViewBlock {
    uvec2 visible;   // size of the picture, px
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
    float scale;     // 1 / the difference at which colours end
    uint withSign;   // 0: grey, of either sign
};
OBSCURA_SHARED_SIZE(DifferenceBlock, 16);

#ifdef __cplusplus
inline constexpr
#else
const
#endif
uint kViewColor = 0,      // linear colour, sRGB-encoded
     kViewGrey = 1,       // first channel, stored as it is
     kViewSecond = 2,     // second channel, stored as it is
     kViewDeviceDepth = 3,
     kViewLinearDepth = 4,
     kViewMotion = 5,
     kViewNormal = 6,     // 32-bit packed normals
     kViewInteger = 7,    // any other integers: their low bits
     kViewValues = 8,     // four channels, stored as they are
     kViewHistory = 9,    // ao/common/temporal.comp's past: frames gathered
     kViewRejected = 10,  // and where they begin anew
     kViewThickness = 11,  // first channel as ao::DepthLayers has it
     kViewSecondThickness = 12;  // second channel, likewise; first 0: nothing there

OBSCURA_SHARED_END
#endif
