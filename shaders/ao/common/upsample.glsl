// Weights of joint bilateral upsampling along one axis [Reinbothe 2009, eqs. 5 to 8], for upsample_rows.comp and upsample_columns.comp.
#ifndef OBSCURA_UPSAMPLE_GLSL
#define OBSCURA_UPSAMPLE_GLSL

// Wendland's function [Wendland 1995]: 1 at 0, 0 from 1 on.
float wendland(float t) {
    float s = max(1.0 - t, 0.0);
    return s * s * s * s * (4.0 * t + 1.0);
}

// pixels: distance / window; facing: cosine between the normals; metres: distance / range; difference: of visibility. The constant keeps
// the sum above 0 if no neighbour fits.
float bilateral(float pixels, float facing, float metres, float difference) {
    return wendland(pixels) * wendland(0.5 - 0.5 * facing) * wendland(metres) * wendland(abs(difference)) + 1e-6;
}

#endif
