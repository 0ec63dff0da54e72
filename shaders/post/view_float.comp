// Debug view of a float or normalized image; modes in post/view.h.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "post/view.h"
#include "post/srgb.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, rgba8) writeonly uniform image2D picture;

layout(push_constant) uniform Constants { ViewBlock view; };

// Logarithmic, near is bright: 1/8 m is white, 2 km is black, 1/14 of the range per octave.
vec3 depthColor(float depth) { return vec3(clamp(1.0 - (log2(max(depth, 1e-6)) + 3.0) / 14.0, 0.0, 1.0)); }

// Logarithmic: 1 mm is black, 10 m is white. Sheets are blue, endless solids red.
vec3 thicknessColor(float t) {
    return t <= 0.0 ? vec3(0.1, 0.25, 0.9) : t >= 65504.0 ? vec3(0.6, 0.1, 0.05) : vec3(clamp((log2(t) * 0.30103 + 3.0) / 4.0, 0.0, 1.0));
}

vec3 valueOf(vec4 texel) {
    switch (view.mode) {
        case kViewColor: return encodeSrgb(clamp(texel.rgb, 0.0, 1.0));
        case kViewSecond: return texel.ggg;
        case kViewDeviceDepth: {
            vec4 l = view.linearize;
            return texel.x <= 0.0 ? vec3(0.0) : depthColor((texel.x * l.x + l.y) / (texel.x * l.z + l.w));
        }
        case kViewLinearDepth: return texel.x <= 0.0 ? vec3(0.0) : depthColor(texel.x);
        case kViewThickness: return thicknessColor(texel.x);
        case kViewSecondThickness: return texel.x <= 0.0 ? vec3(0.0) : thicknessColor(texel.y);
        // Grey at 0; red is horizontal, green vertical, saturated at 32 px. The square root makes small motion visible.
        case kViewMotion: return vec3(0.5 + 0.5 * sign(texel.xy) * sqrt(min(abs(texel.xy) / 32.0, 1.0)), 0.5);
        case kViewDirection: return texel.rgb * 0.5 + 0.5;
        case kViewValues: return texel.rgb;
        default: return texel.rrr;
    }
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(view.visible)))) return;
    ivec2 from = clamp(ivec2((vec2(at) + 0.5) * view.scale + view.offset), ivec2(0), textureSize(source, 0) - 1);
    imageStore(picture, at, vec4(clamp(valueOf(texelFetch(source, from, 0)), 0.0, 1.0), 1.0));
}
