// Gather of interleaved shares [Timonen 2013, sec. 10]: mean over the side x side neighbours on this pixel's surface. For an even side the
// window is one pixel wider and its outer pixels have half weight, so that all shares weigh the same and the window is centred.
// In: visibility of shares or, with kWeighted, (w obscurance, w), whose mean is subtracted from `open`. Out: visibility.
// The includer defines ivec2 pixels(view), the size, and float depth = surfaceAt(view, pixel, out here, out normal).
#ifndef OBSCURA_GATHER_GLSL
#define OBSCURA_GATHER_GLSL

void main() {
    View view = viewBlock;  // a copy, so that the loop holds it in registers
    ivec2 p = ivec2(gl_GlobalInvocationID.xy), last = pixels(view) - 1;
    if (any(greaterThan(p, last))) return;
    int reach = int(constants.side) / 2;
    float outer = (constants.side & 1u) != 0u ? 1.0 : 0.5;
    vec3 here, n;
    float depthHere = depthForTolerance(view, surfaceAt(view, p, here, n));
    vec2 sum = vec2(0.0);
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            ivec2 at = p + ivec2(x, y), q = clamp(at, ivec2(0), last);
            vec3 there, m;
            surfaceAt(view, q, there, m);
            bool same = at == q && ofSurface(here, n, depthHere, there, m);
            float w = same || (x == 0 && y == 0) ? (abs(x) == reach ? outer : 1.0) * (abs(y) == reach ? outer : 1.0) : 0.0;
            vec2 share = texelFetch(shares, q, 0).xy;
            sum += w * (kWeighted ? share : vec2(share.x, 1.0));
        }
    }
    float mean = sum.x / max(sum.y, 1e-6);
    imageStore(visibility, p, vec4(clamp(kWeighted ? texelFetch(open, p, 0).x - mean : mean, 0.0, 1.0)));
}

#endif
