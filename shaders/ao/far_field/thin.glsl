// Surfaces of finite thickness, for which a single horizon is not enough. The arc of a segment from the tangent plane to the zenith is cut
// into 32 bins. Each point blocks the still open bins between its front and its back; runs of new bins are integrated by the table along
// the slab [the paper's sec. 11 keeps one angle and does not converge].
#ifndef OBSCURA_FAR_FIELD_THIN_GLSL
#define OBSCURA_FAR_FIELD_THIN_GLSL
#include "ao/far_field/estimator.glsl"
#include "shared/view.h"

struct Bins {
    uint blocked;
    float step;    // angle of a bin; bin i is centred at (i + 0.5) step from the zenith
    float sum;     // integral of the blocked bins, times |n_k|
};
Bins binsBelow(float cosine) { return Bins(0u, arcCosine(cosine) / 32.0, 0.0); }

float angleOf(vec2 v) { return arcCosine(v.y * inversesqrt(max(dot(v, v), 1e-30))); }

// point: from the receiver; slab: unit, away from the camera, of `thickness` metres.
void addSlab(inout Bins h, vec2 point, vec2 slab, float thickness, bool exists, vec2 n, float unit) {
    exists = exists && point.x > 0.0;
    float front = angleOf(point), back = angleOf(point + slab * thickness);
    int first = int(clamp(ceil(front / h.step - 0.5), 0.0, 32.0)), end = int(clamp(ceil(back / h.step - 0.5), 0.0, 32.0));
    uint bits = (end >= 32 ? ~0u : (1u << end) - 1u) & (first >= 32 ? 0u : ~0u << first);
    bits = exists && end > first ? bits & ~h.blocked : 0u;
    h.blocked |= bits;
    float c = angleOf(slab), b = max(slab.x * point.y - slab.y * point.x, 0.0), v = b / (b + unit);
    vec2 twice = vec2(2.0 * slab.x * slab.y, slab.y * slab.y - slab.x * slab.x);
    vec3 weights = 0.5 * vec3(n.x, twice.x * n.y - twice.y * n.x, -(twice.y * n.y + twice.x * n.x));
    while (bits != 0u) {
        int from = findLSB(bits);
        uint rest = ~(bits >> from);
        int count = rest == 0u ? 32 : findLSB(rest);
        float phi1 = max(c - float(from + count) * h.step, 0.0), phi2 = max(c - float(from) * h.step, phi1);
        h.sum += dot(weights, tableDifference(phi1, phi2, v));
        bits &= count >= 32 ? 0u : ~(((1u << count) - 1u) << from);
    }
}

// Rotation (cosine and sine) of all directions of a pixel, within +-halfWidth * jitter: interleaved gradient noise [Jimenez 2014], shifted
// from frame to frame with temporal reprojection.
vec2 jitterAt(View view, ivec2 texel, float halfWidth, float jitter) {
    float noise = fract(52.9829189 * fract(dot(vec2(texel), vec2(0.06711056, 0.00583715))) + frameShift(view).x);
    float angle = (2.0 * noise - 1.0) * halfWidth * jitter;
    return vec2(cos(angle), sin(angle));
}

#endif
