// Morphing, then skinning, of one primitive of one instance [glTF 2.0, 3.7.2.2 and 3.7.3]; CPU version: scene::deform(). In: rest pose,
// influences, targets. Out: posed positions and tangent frames, model space.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene/frame.h"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, std430) readonly buffer Joints { vec4 joints[]; };          // three rows per matrix
layout(set = 0, binding = 1, std430) readonly buffer Weights { ActiveWeight weights[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Positions { float positions[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Frames { uvec4 frames[]; };        // normal, tangent: snorm16 x 8

struct Influence {
    uvec4 joints;  // eight 16-bit indices
    vec4 low;      // weights 0..3
    vec4 high;     // weights 4..7
};
layout(set = 1, binding = 0, std430) readonly buffer Rest { uint rest[]; };
layout(set = 1, binding = 1, std430) readonly buffer Influences { Influence influences[]; };
layout(set = 1, binding = 2, std430) readonly buffer Targets { float targets[]; };       // position, normal, tangent

layout(push_constant) uniform Job { DeformJob job; };

vec3 restVec(uint at) { return vec3(uintBitsToFloat(rest[at]), uintBitsToFloat(rest[at + 1u]), uintBitsToFloat(rest[at + 2u])); }
vec3 targetVec(uint at) { return vec3(targets[at], targets[at + 1u], targets[at + 2u]); }

void addJoint(uint joint, float weight, inout vec4 x, inout vec4 y, inout vec4 z) {
    uint at = (job.joints + joint) * 3u;
    x += weight * joints[at];
    y += weight * joints[at + 1u];
    z += weight * joints[at + 2u];
}

void main() {
    uint v = gl_GlobalInvocationID.x;
    if (v >= job.vertices) return;

    vec3 position = restVec(job.positions + v * 3u);
    uint f = job.frames + v * 4u;
    vec3 normal = vec3(unpackSnorm2x16(rest[f]), unpackSnorm2x16(rest[f + 1u]).x);
    vec4 tangent = vec4(unpackSnorm2x16(rest[f + 2u]), unpackSnorm2x16(rest[f + 3u]));

    for (uint i = 0u; i < job.weightCount; ++i) {
        ActiveWeight w = weights[job.weights + i];
        uint at = job.targets + (w.target * job.vertices + v) * 9u;
        position += w.weight * targetVec(at);
        normal += w.weight * targetVec(at + 3u);
        tangent.xyz += w.weight * targetVec(at + 6u);
    }

    if (job.influences != ~0u) {
        Influence influence = influences[job.influences + v];
        vec4 x = vec4(0.0), y = vec4(0.0), z = vec4(0.0);
        for (uint i = 0u; i < 8u; ++i) {
            float weight = i < 4u ? influence.low[i] : influence.high[i - 4u];
            if (weight == 0.0) continue;
            uint packed = influence.joints[i >> 1u];
            addJoint((i & 1u) == 0u ? packed & 0xffffu : packed >> 16u, weight, x, y, z);
        }
        vec4 p = vec4(position, 1.0);
        position = vec3(dot(x, p), dot(y, p), dot(z, p));
        // Cofactor matrix: correct for normals under any scale.
        vec3 a = cross(y.xyz, z.xyz), b = cross(z.xyz, x.xyz), c = cross(x.xyz, y.xyz);
        float side = dot(x.xyz, a) < 0.0 ? -1.0 : 1.0;
        normal = side * vec3(dot(a, normal), dot(b, normal), dot(c, normal));
        tangent.xyz = vec3(dot(x.xyz, tangent.xyz), dot(y.xyz, tangent.xyz), dot(z.xyz, tangent.xyz));
    }

    normal /= max(length(normal), 1e-20);
    tangent.xyz /= max(length(tangent.xyz), 1e-20);
    uint o = (job.posed + v) * 3u;
    positions[o] = position.x;
    positions[o + 1u] = position.y;
    positions[o + 2u] = position.z;
    frames[job.posed + v] = uvec4(packSnorm2x16(normal.xy), packSnorm2x16(vec2(normal.z, 0.0)),
                                  packSnorm2x16(tangent.xy), packSnorm2x16(vec2(tangent.z, tangent.w)));
}
