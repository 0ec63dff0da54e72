// Push constants of example.
#ifndef OBSCURA_EXAMPLE_CONSTANTS_H
#define OBSCURA_EXAMPLE_CONSTANTS_H
#include "shared/falloff.h"
OBSCURA_SHARED_BEGIN

struct ExampleSamples {  // samples.comp
    FalloffBlock falloff;
    uint samples;
    float bias;  // least sine above the tangent plane
};
OBSCURA_SHARED_SIZE(ExampleSamples, 20);

OBSCURA_SHARED_END
#endif
