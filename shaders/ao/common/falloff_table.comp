// The falloff's table, computed when the falloff changes: integrals along a line at distance b from the receiver, from its far end to angle
// phi,
//     A0, A1, A2 (phi, b) = integral from 0 to phi of rho(b / sin t) {1, cos 2t, sin 2t} dt
// A texel holds each of them at its own phi and at the next one, as halves, so that one fetch is enough for linear interpolation. One
// invocation per row.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "ao/common/constants.h"
#include "ao/common/falloff_table.glsl"
#include "shared/falloff.h"
layout(local_size_x = 32) in;
layout(set = 0, binding = 0, rgba32ui) uniform writeonly uimage2D table;
layout(push_constant) uniform Block { FalloffTable constants; };

const uint kSteps = 128u;  // from column to column

void main() {
    uint row = gl_GlobalInvocationID.x;
    if (row >= kTableRows) return;
    FalloffBlock rho = constants.falloff;
    float v = float(row) / float(kTableRows - 1u);
    float b = v * constants.unit / max(1.0 - v, 1e-6), step = kPi / float((kTableColumns - 1u) * kSteps);
    vec3 before = vec3(0.0);
    for (uint column = 0u; column < kTableColumns; ++column) {
        vec3 sum = vec3(0.0);
        for (uint i = 0u; i < kSteps; ++i) {
            float t = (float(column * kSteps + i) + 0.5) * step;
            float weight = row + 1u < kTableRows ? falloffOf(constants.kind, rho, b / max(sin(t), 1e-9)) : 0.0;
            sum += weight * vec3(1.0, cos(2.0 * t), sin(2.0 * t));
        }
        vec3 after = before + sum * step;
        imageStore(table, ivec2(column, row),
            uvec4(packHalf2x16(vec2(before.x, after.x)), packHalf2x16(vec2(before.y, after.y)), packHalf2x16(vec2(before.z, after.z)), 0));
        before = after;
    }
}
