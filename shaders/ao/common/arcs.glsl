// Inverse trigonometric functions as polynomials, cheaper than the built-in ones.
#ifndef OBSCURA_ARCS_GLSL
#define OBSCURA_ARCS_GLSL

const float kPi = 3.14159265;

float arcCosine(float x) {  // error below 7e-5 [Abramowitz, Stegun 1964, 4.4.45]
    float a = min(abs(x), 1.0);
    float r = sqrt(1.0 - a) * (1.5707288 + a * (-0.2121144 + a * (0.0742610 - a * 0.0187293)));
    return x < 0.0 ? kPi - r : r;
}
float arcTangent(float y, float x) {  // of y / x in [0, pi], y >= 0; error below 1e-5
    float t = min(y, abs(x)) / max(max(y, abs(x)), 1e-20), t2 = t * t;
    float r = t * (0.9998660 + t2 * (-0.3302995 + t2 * (0.1801410 + t2 * (-0.0851330 + t2 * 0.0208351))));
    r = y > abs(x) ? 0.5 * kPi - r : r;
    return x < 0.0 ? kPi - r : r;
}

#endif
