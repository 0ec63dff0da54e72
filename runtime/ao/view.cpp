#include <algorithm>
#include <cmath>

#include "ao/view.h"

namespace obscura::ao {

// With D = -z the linear depth and P the projection (columns), perspective has w = -P[2][3] D and orthographic w = 1:
//   x = D (ndc.x w' + P[2][0]) / P[0][0],  w' = -P[2][3]      D = P[3][2] / (P[2][2] + w' d)
//   x = (ndc.x - P[3][0]) / P[0][0]                           D = (P[3][2] - d) / P[2][2]
Status viewOf(const Frame& frame, shared::View& view, const char*& reason) {
    const float* p = frame.projection;
    const uint32_t width = frame.size.width, height = frame.size.height;
    const auto fail = [&](const char* why) {
        reason = why;
        return Status::invalid;
    };
    if (width == 0 || height == 0) return fail("Frame::size is zero");
    if (2 * uint64_t(frame.guard.width) >= width || 2 * uint64_t(frame.guard.height) >= height)
        return fail("Frame::guard, on both sides, is not less than Frame::size");
    for (int i = 0; i < 16; ++i)
        if (!std::isfinite(p[i])) return fail("Frame::projection holds a value that is not finite");
    if (p[0] == 0.0f || p[5] == 0.0f) return fail("Frame::projection scales x or y to 0");
    const bool perspective = p[11] != 0.0f;
    if (perspective && (p[15] != 0.0f || (std::fabs(p[14]) == 1.0f && std::fabs(p[11]) != 1.0f)))
        return fail("Frame::projection is stored by rows: transpose it (ao.h, Space)");
    if (perspective && p[11] > 0.0f)
        return fail("Frame::projection looks down +z, eye space looks down -z: negate its third column (ao.h, Space)");
    if (!perspective && (p[15] == 0.0f || p[10] == 0.0f)) return fail("Frame::projection is neither perspective nor orthographic");

    const float w = perspective ? -p[11] : p[15];
    view = {};
    view.size = {width, height};
    view.guard = {frame.guard.width, frame.guard.height};
    view.visible = {width - 2 * frame.guard.width, height - 2 * frame.guard.height};
    view.orthographic = perspective ? 0.0f : 1.0f;
    const float offsetX = perspective ? p[8] : -p[12];
    const float offsetY = perspective ? p[9] : -p[13];
    view.unproject = {2.0f * w / (float(width) * p[0]), 2.0f * w / (float(height) * p[5]), (offsetX - w) / p[0], (offsetY - w) / p[5]};
    view.project = {
        1.0f / view.unproject.x, 1.0f / view.unproject.y, -view.unproject.z / view.unproject.x, -view.unproject.w / view.unproject.y};
    view.pixelsPerMetre = std::fabs(view.project.y);
    view.orthographicDepth = orthographicDepth(view);
    view.linearize = perspective ? shared::vec4{0.0f, p[14], w, p[10]} : shared::vec4{-w, p[14], 0.0f, p[10]};
    if (frame.depthKind == DepthKind::device && perspective && p[14] == 0.0f)
        return fail("Frame::projection gives every depth the same value");

    float farPlane = 0.0f;
    for (const float d : {0.0f, 1.0f}) {
        const float depth = (d * view.linearize.x + view.linearize.y) / (d * view.linearize.z + view.linearize.w);
        if (std::isfinite(depth) && (depth > 0.0f || !perspective)) farPlane = std::max(farPlane, depth);  // orthographic: near may be 0
        else farPlane = kSkyDepth;
    }
    view.skyDepth = std::min(kSkyDepth, frame.skyDepth > 0.0f                  ? frame.skyDepth
                                        : frame.depthKind == DepthKind::linear ? kSkyDepth
                                                                               : farPlane * 0.9999f);
    view.frame = uint32_t(frame.index);
    return Status::ok;
}

const char* unfitEyeFromWorld(const float m[16]) {
    constexpr double kTolerance = 1e-3;
    for (int i = 0; i < 16; ++i)
        if (!std::isfinite(m[i])) return "holds a value that is not finite";
    if (m[3] != 0.0f || m[7] != 0.0f || m[11] != 0.0f || m[15] != 1.0f)
        return "does not end in the row 0 0 0 1: if it is stored by rows, transpose it";
    const auto dot = [m](int a, int b) {
        return double(m[4 * a]) * m[4 * b] + double(m[4 * a + 1]) * m[4 * b + 1] + double(m[4 * a + 2]) * m[4 * b + 2];
    };
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < a; ++b)
            if (std::fabs(dot(a, b)) > kTolerance * std::sqrt(dot(a, a) * dot(b, b))) return "shears; it must be rigid";
    for (int a = 0; a < 3; ++a)
        if (std::fabs(dot(a, a) - 1.0) > kTolerance)
            return "scales; it must be rigid: take the scale out, and lengths of the falloff in units of the depth";
    return nullptr;  // a mirror is one too: that of a left-handed world
}

Status volumeOf(const Volume& volume, shared::Volume& block, const char*& reason) {
    const auto fail = [&](const char* why) {
        reason = why;
        return Status::invalid;
    };
    const uint32_t cells = volume.cells, levels = volume.levels;
    const bool hasEdge = volume.structure == VolumeStructure::dense || cells > 0;
    if (hasEdge && (cells < 8 || cells > 1024 || (cells & (cells - 1)) != 0))
        return fail("Frame::volume.cells is not a power of two from 8 to 1024");
    if (levels < 1 || levels > 8) return fail("Frame::volume.levels is not from 1 to 8");
    if (levels > 1 && cells < 32) return fail("Frame::volume.levels above 1 need 32 cells a side or more");
    const float* m = volume.cellFromEye;
    for (int i = 0; i < 16; ++i)
        if (!std::isfinite(m[i])) return fail("Frame::volume.cellFromEye holds a value that is not finite");
    const float scale = std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    if (!(scale > 0.0f)) return fail("Frame::volume.cellFromEye has scale 0");
    // Places are counted from the lowest cell of all levels, so that those inside are not negative.
    const int64_t half = cells / 2, widest = int64_t(1) << (levels - 1), below = levels > 1 ? (half + 8) * widest : half;
    float fromAnchor[3];
    uint32_t anchor[3];
    for (int axis = 0; axis < 3; ++axis) {
        const int64_t origin = volume.origin[axis], middle = origin + half;
        const int64_t lowest = levels > 1 ? (middle - below) & ~(widest - 1) : origin;
        anchor[axis] = uint32_t(lowest);
        fromAnchor[axis] = float(origin - lowest);
    }
    for (int row = 0; row < 3; ++row) block.rows[row] = {m[row], m[4 + row], m[8 + row], m[12 + row] + fromAnchor[row]};
    block.anchor = {anchor[0], anchor[1], anchor[2], cells};
    block.centre = {fromAnchor[0] + float(half), fromAnchor[1] + float(half), fromAnchor[2] + float(half), 1.0f / scale};
    block.halfSide = !hasEdge ? 1e30f : levels > 1 ? float(half - 8) : float(half);
    block.fade = levels > 1 ? 4.0f / (block.halfSide * float(widest)) : 1e30f;
    block.levels = levels;
    return Status::ok;
}

uint32_t volumeRaySteps(const shared::Volume& volume, float reach, float stride, uint32_t octave) {
    const float widest = std::ldexp(1.0f, int(volume.levels) - 1), octaveCells = std::ldexp(stride, int(octave));
    const float cells = std::min(reach / volume.centre.w, 3.5f * volume.halfSide * widest);
    const int level = std::clamp(cells < 2.0f * octaveCells ? 0 : std::ilogb(cells / octaveCells), 0, int(volume.levels) - 1);
    return (uint32_t(level) << octave) + uint32_t(std::ceil(std::ldexp(cells / stride, -level)));
}

}  // namespace obscura::ao
