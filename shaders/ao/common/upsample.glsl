// Joint bilateral upsampling along one axis [Reinbothe 2009, eqs. 5 to 8]: what upsample_rows.comp and upsample_columns.comp share.
#ifndef OBSCURA_UPSAMPLE_GLSL
#define OBSCURA_UPSAMPLE_GLSL

// [Wendland 1995]: 1 at 0, 0 from 1 on.
float bump(float t) {
    float s = max(1.0 - t, 0.0);
    return s * s * s * s * (4.0 * t + 1.0);
}

// Pixels apart over the window, normals, metres apart over the range, difference in visibility. The least keeps what is near where
// nothing fits.
float bilateral(float pixels, float facing, float metres, float difference) {
    return bump(pixels) * bump(0.5 - 0.5 * facing) * bump(metres) * bump(abs(difference)) + 1e-6;
}

#endif
