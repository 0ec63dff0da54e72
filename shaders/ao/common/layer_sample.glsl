// A sample of packed depth layers as a receiver sees it, for horizon methods: a layer covers the arc from its front to its back.
// Vectors are in eye space, from the receiver, metres.
#ifndef OBSCURA_LAYER_SAMPLE_GLSL
#define OBSCURA_LAYER_SAMPLE_GLSL
#include "ao/common/packed_layers.glsl"
#include "shared/octahedral.glsl"
#include "shared/view.h"

struct LayerSample {
    Layers layers;
    vec3 ray;            // view ray, per metre of depth
    vec3 first, second;  // fronts of the layers
    vec2 cosines;        // between each front and the axis
    vec2 heights;        // sines of their elevation above the tangent plane
    bool joined;         // to the sample before: the slope between them allows that both are on one surface
};
// texel: packed layers of pixel q; n: the receiver's normal; axis: unit vector; before: front of the sample before.
LayerSample layerSampleAt(View view, uvec4 texel, ivec2 q, vec3 here, vec3 n, vec3 axis, vec3 before) {
    LayerSample s;
    s.layers = unpackLayers(texel);
    s.first = eyePosition(view, vec2(q) + 0.5, s.layers.first) - here;
    s.ray = eyePosition(view, vec2(q) + 0.5, s.layers.first + 1.0) - here - s.first;
    s.second = s.first + (s.layers.second - s.layers.first) * s.ray;
    vec2 inverse = vec2(inversesqrt(max(dot(s.first, s.first), 1e-20)), inversesqrt(max(dot(s.second, s.second), 1e-20)));
    s.cosines = vec2(dot(s.first, axis), dot(s.second, axis)) * inverse;
    s.heights = vec2(dot(s.first, n), dot(s.second, n)) * inverse;
    vec3 from = s.first - before;
    vec2 across = from.xy + from.z * s.ray.xy;  // difference of the view rays, at the depth of the sample before
    s.joined = from.z * from.z < s.layers.steepest * s.layers.steepest * dot(across, across);
    return s;
}

// Cosine between the axis and the back of a layer with that front; size: its packed length.
float backCosine(vec3 front, vec3 ray, float size, vec3 axis) {
    vec3 b = front + abs(size) * ray;
    return dot(b, axis) * inversesqrt(max(dot(b, b), 1e-20));
}
// Distance to the nearest point of a solid, or to the front of a sheet, metres.
float layerDistance(vec3 front, vec3 ray, float size) {
    float along = size > 0.0 ? clamp(-dot(front, ray) / dot(ray, ray), 0.0, size) : 0.0;
    return length(front + along * ray);
}

#endif
