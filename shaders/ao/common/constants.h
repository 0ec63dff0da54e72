// Push constants of the passes that methods share.
#ifndef OBSCURA_COMMON_CONSTANTS_H
#define OBSCURA_COMMON_CONSTANTS_H
#include "shared/falloff.h"
OBSCURA_SHARED_BEGIN

struct BentNormals {  // bent_normals.comp
    uint scale;    // picture pixels per pixel of the raw bent normals, each way
    uint middle;   // of those, the one that it stands for, each way
    float covers;  // half the window's width, pixels of the raw bent normals
    uint taps;     // pixels read each way
};
OBSCURA_SHARED_SIZE(BentNormals, 16);

struct Crop {  // crop.comp
    ivec2 origin, size;  // px
    int stride;    // px of the source per px of the part
    int shift;     // 1: the source has a texel for every other pixel
};
OBSCURA_SHARED_SIZE(Crop, 24);

struct Reduce {  // reduce.comp
    ivec2 first;  // px of the frame that reduced pixel 0 is
    ivec2 size;   // reduced pixels
    int scale;    // px of the frame per reduced pixel
    int unused;
};
OBSCURA_SHARED_SIZE(Reduce, 24);

struct Enlarge {  // enlarge.comp
    float perScale;  // 1 / scale
};
OBSCURA_SHARED_SIZE(Enlarge, 4);

struct Controls {  // controls.comp
    float intensity;  // factor on obscurance
    float power;      // exponent on visibility
    float lowest;     // visibility
    float fadeTo;     // linear depth from which on all is open, metres
    float perFade;    // 1 / (depth over which obscurance fades)
};
OBSCURA_SHARED_SIZE(Controls, 20);

struct Whole {  // passes over a whole image: output_r8.comp, ssao/box.comp
    ivec2 size;  // px
};
OBSCURA_SHARED_SIZE(Whole, 8);

struct Linearize {  // linearize.comp
    uint linear;  // 1: the source has linear depth already
};
OBSCURA_SHARED_SIZE(Linearize, 4);

struct ConvertNormals {  // normals.comp and normals_packed.comp
    vec4 rows[3];    // eye from source
    ivec2 size;      // px
    uint encoding;   // 0: xyz, 1: xyz * 0.5 + 0.5; normals_packed.comp: unused
    uint unused;
};
OBSCURA_SHARED_SIZE(ConvertNormals, 64);

struct DepthMips {  // depth_mips.comp
    ivec2 size;   // of the depths, px
    float range;  // metres: texels nearer than the farthest by more have weight 0
    float fade;   // fraction of `range` over which weights fall from 1 to 0
};
OBSCURA_SHARED_SIZE(DepthMips, 16);

struct EdgeBlur {  // edge_blur.comp
    ivec2 size;    // px
    float centre;  // weight of the pixel itself; a neighbour's is at most 1
    uint unused;
};
OBSCURA_SHARED_SIZE(EdgeBlur, 16);

struct Gather {  // gather.comp
    uint side;  // of the interleaving tile, px
};
OBSCURA_SHARED_SIZE(Gather, 4);

struct GatherMap {  // gather_map.comp
    ivec2 size;   // of the map, px
    uint side;    // of the interleaving tile, map pixels
    float scale;  // image pixels per map pixel, each way
};
OBSCURA_SHARED_SIZE(GatherMap, 16);

struct PackLayers {  // pack_layers.comp, and far_field/fields.comp
    float sheet;  // thickness of open sheets, metres
    uint shift;   // 1: the second layer is of half size
};
OBSCURA_SHARED_SIZE(PackLayers, 8);

struct SumRows {  // sum_rows.comp
    uvec2 size;    // texels
    uint layers;
    uint masked;   // 0: codes are not read, every texel counts in every layer
    uvec4 masks;   // a layer sums the texels with (code & mask) == value
    uvec4 values;
};
OBSCURA_SHARED_SIZE(SumRows, 48);

struct SumColumns {  // sum_columns.comp
    uint columns;  // of the table, times layers
    uint rows;     // of texels
};
OBSCURA_SHARED_SIZE(SumColumns, 8);

struct Reproject {  // temporal.comp
    // Texels count from the upper left of each frame's visible part, whole numbers at their centres.
    vec4 previousFromEye[3];  // rows
    vec4 previousUnproject;   // last frame's eye.xy = (its texel * xy + zw) * (orthographic ? 1 : depth)
    vec4 previousTexel;       // last frame's texel = this frame's * xy + zw + motion * motionScale; CAMERA: from last frame's
                              // eye.xy / (orthographic ? 1 : depth) * xy + zw
    vec2 motionScale;         // to px of last frame
    uvec2 previousVisible;    // px
    float previousOrthographicDepth;
    float history;            // largest weight of the history
    float depthTolerance;     // relative
    float normalTolerance;    // cosine
    float clip;               // standard deviations
    float clipFloor;          // least deviation
    uint valid;               // 0: there is no history
    uint unused;
};
OBSCURA_SHARED_SIZE(Reproject, 128);

struct Upsample {  // upsample_rows.comp and upsample_columns.comp
    ivec2 size;    // of the map, px
    int scale;     // image pixels per map pixel
    float window;  // width of the filter, px
    float range;   // metres; points farther apart are not averaged
    uint unused;
};
OBSCURA_SHARED_SIZE(Upsample, 24);

struct FalloffTable {  // falloff_table.comp
    FalloffBlock falloff;
    float unit;            // metres: the falloff's length
    uint kind;             // FalloffKind
};
OBSCURA_SHARED_SIZE(FalloffTable, 20);

OBSCURA_SHARED_END
#endif
