// Size and layout of the falloff's table (table.comp): phi / pi over columns, b / (b + unit) over rows, both from edge to edge.
#ifndef OBSCURA_FAR_FIELD_TABLE_GLSL
#define OBSCURA_FAR_FIELD_TABLE_GLSL
const uint kTableColumns = 64u, kTableRows = 128u;
const float kPi = 3.14159265;
// Error below 7e-5; what cancels in differences is smooth.
float acosOf(float x) {
    float a = min(abs(x), 1.0);
    float r = sqrt(1.0 - a) * (1.5707288 + a * (-0.2121144 + a * (0.0742610 - a * 0.0187293)));
    return x < 0.0 ? kPi - r : r;
}
float atanOf(float y, float x) {  // y >= 0; error below 1e-5
    float t = min(y, abs(x)) / max(max(y, abs(x)), 1e-20), t2 = t * t;
    float r = t * (0.9998660 + t2 * (-0.3302995 + t2 * (0.1801410 + t2 * (-0.0851330 + t2 * 0.0208351))));
    r = y > abs(x) ? 0.5 * kPi - r : r;
    return x < 0.0 ? kPi - r : r;
}
#endif
