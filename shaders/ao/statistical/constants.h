// Push constants of statistical.
#ifndef OBSCURA_STATISTICAL_CONSTANTS_H
#define OBSCURA_STATISTICAL_CONSTANTS_H
#include "ao/statistical/fixed_point.h"
OBSCURA_SHARED_BEGIN

struct StatisticalExtentBlocks {  // extent_blocks.comp
    Box box;
};
OBSCURA_SHARED_SIZE(StatisticalExtentBlocks, 24);

struct StatisticalExtent {  // extent.comp
    uint count;  // blocks
};
OBSCURA_SHARED_SIZE(StatisticalExtent, 4);

struct StatisticalTexels {  // texels.comp
    Box box;
    uvec2 size;  // of the tables, texels
};
OBSCURA_SHARED_SIZE(StatisticalTexels, 32);

struct StatisticalLayers {  // layers.comp
    Box box;
    uvec2 size;          // of the tables, texels
    uint uniformLayers;  // number of layers of equal thickness; 0: one more level of two
    uint unused;
};
OBSCURA_SHARED_SIZE(StatisticalLayers, 40);

struct StatisticalEvaluate {  // evaluate.comp
    Box box;
    uvec2 size;   // of the tables, texels
    float slope;
    float gain;
    uint viewAligned;  // 1: boxes stand along the view axis, not the normal
    uint unused;
};
OBSCURA_SHARED_SIZE(StatisticalEvaluate, 48);

struct StatisticalUniform {  // uniform.comp
    Box box;
    uvec2 size;    // of the tables, texels
    float slope;
    float gain;
    uint isFirst;
    uint isLast;
    uint viewAligned;  // as in StatisticalEvaluate
    uint unused;
};
OBSCURA_SHARED_SIZE(StatisticalUniform, 56);

struct StatisticalSamples {  // samples.comp
    Box box;
    float slope;
    float gain;
    uint samples;
    uint lines;
    uint viewAligned;  // as in StatisticalEvaluate
    uint unused;
};
OBSCURA_SHARED_SIZE(StatisticalSamples, 48);

OBSCURA_SHARED_END
#endif
