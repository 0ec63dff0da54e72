// Push constants of the passes that methods share.
#ifndef OBSCURA_COMMON_CONSTANTS_H
#define OBSCURA_COMMON_CONSTANTS_H
#include "shared/falloff.h"
OBSCURA_SHARED_BEGIN

struct BentNormals {  // bent_normals.comp
    uint scale;    // picture pixels per pixel of the raw bent normals, each way
    float covers;  // half the window's width, pixels of the raw bent normals
    uint taps;     // pixels read each way
};
OBSCURA_SHARED_SIZE(BentNormals, 12);

struct Crop {  // crop.comp
    ivec2 origin;  // px
};
OBSCURA_SHARED_SIZE(Crop, 8);

struct Linearize {  // linearize.comp
    uint linear;  // 1: the source has linear depth already
};
OBSCURA_SHARED_SIZE(Linearize, 4);

struct ConvertNormals {  // normals.comp and normals_packed.comp
    vec4 rows[3];    // eye from source
    uint encoding;   // 0: xyz, 1: xyz * 0.5 + 0.5; normals_packed.comp: unused
    uint unused[3];
};
OBSCURA_SHARED_SIZE(ConvertNormals, 64);

struct DepthMips {  // depth_mips.comp
    float range;  // metres: texels nearer than the farthest by more have weight 0
    float fade;   // fraction of `range` over which weights fall from 1 to 0
};
OBSCURA_SHARED_SIZE(DepthMips, 8);

struct EdgeBlur {  // edge_blur.comp
    float centre;  // weight of the pixel itself; a neighbour's is at most 1
};
OBSCURA_SHARED_SIZE(EdgeBlur, 4);

struct Gather {  // gather.comp
    uint side;  // of the interleaving tile, px
};
OBSCURA_SHARED_SIZE(Gather, 4);

struct GatherMap {  // gather_map.comp
    uint side;    // of the interleaving tile, map pixels
    float scale;  // image pixels per map pixel, each way
};
OBSCURA_SHARED_SIZE(GatherMap, 8);

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
    vec4 previousFromEye[3];  // rows
    vec2 motionScale;         // to px
    vec2 motionOffset;        // px
    float history;            // largest weight of the history
    float depthTolerance;     // relative
    float normalTolerance;    // cosine
    float clip;               // standard deviations
    float clipFloor;          // least deviation
    uint valid;               // 0: there is no history
    uint unused[2];
};
OBSCURA_SHARED_SIZE(Reproject, 96);

struct Upsample {  // upsample_rows.comp and upsample_columns.comp
    int scale;     // image pixels per map pixel
    float window;  // width of the filter, px
    float range;   // metres; points farther apart are not averaged
};
OBSCURA_SHARED_SIZE(Upsample, 12);

struct FalloffTable {  // falloff_table.comp
    FalloffBlock falloff;
    float unit;            // metres: the falloff's length
    uint kind;             // FalloffKind
};
OBSCURA_SHARED_SIZE(FalloffTable, 20);

OBSCURA_SHARED_END
#endif
