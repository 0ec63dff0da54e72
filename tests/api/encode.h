// Encodes depths and normals in every convention and format that obscura/ao.h names.
#pragma once

#include <cstring>

#include "ao/room.h"
#include "api/scene.h"

namespace obscura::test {

enum class Depth : uint8_t { linear, standard, reversed, infinite, reversedInfinite };

struct DepthCoding {
    Depth kind = Depth::linear;
    VkFormat format = VK_FORMAT_R32_SFLOAT;
    double near = 1.0, far = 20.0;  // metres at scale 1
    VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
};

struct NormalCoding {
    bool none = false;
    ao::NormalKind kind = ao::NormalKind::eye;
    ao::NormalEncoding encoding = ao::NormalEncoding::signedFloat;
    VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
};

// eye -> clip space, by columns, with the depth row of the convention. Linear depths use a reversed infinite projection.
inline void projectionOf(const Geometry& g, const DepthCoding& coding, float out[16]) {
    const double n = coding.near * g.scale, f = coding.far * g.scale;
    const double metres = g.orthographic ? Geometry::kMiddle * g.scale : 1.0, down = g.flipped ? 1.0 : -1.0;
    const double sx = 2.0 * g.focal() / g.size().width, sy = 2.0 * g.focal() / g.size().height * down;
    double a = 0.0, b = n;  // clip z = a z + b
    if (g.orthographic) {
        const double away = coding.kind == Depth::standard ? 1.0 : -1.0;
        a = -away / (f - n);
        b = (away > 0.0 ? -n : f) / (f - n);
    } else if (coding.kind == Depth::standard) {
        a = -f / (f - n);
        b = -f * n / (f - n);
    } else if (coding.kind == Depth::reversed) {
        a = n / (f - n);
        b = f * n / (f - n);
    } else if (coding.kind == Depth::infinite) {
        a = -1.0;
        b = -n;
    }
    const double p[16] = {sx / metres, 0, 0, 0, 0, sy / metres, 0, 0, g.orthographic ? 0.0 : sx * g.shift.x,
        g.orthographic ? 0.0 : sy * g.shift.y, a, g.orthographic ? 0.0 : -1.0, g.orthographic ? -sx * g.shift.x : 0.0,
        g.orthographic ? -sy * g.shift.y : 0.0, b, g.orthographic ? 1.0 : 0.0};
    std::copy(std::begin(p), std::end(p), out);
}

inline uint32_t texelBytes(VkFormat format) {  // bytes a texel in a copy of the depth or colour aspect
    switch (format) {
        case VK_FORMAT_D16_UNORM: return 2;
        case VK_FORMAT_R16G16_SFLOAT:
        case VK_FORMAT_R32_SFLOAT:
        case VK_FORMAT_R32_UINT: return 4;
        case VK_FORMAT_R32G32_SFLOAT:
        case VK_FORMAT_R16G16B16A16_SFLOAT:
        case VK_FORMAT_R16G16B16A16_SNORM:
        case VK_FORMAT_R16G16B16A16_UNORM: return 8;
        case VK_FORMAT_R32G32B32A32_SFLOAT: return 16;
        default: return 4;
    }
}

inline uint16_t toHalf(float value) {  // round to nearest; denormals and infinities do not occur
    uint32_t bits;
    std::memcpy(&bits, &value, 4);
    const uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7fffffffu;
    if (magnitude < 0x38800000u) return uint16_t(sign | uint32_t(std::lround(std::abs(double(value)) * 16777216.0)));
    return uint16_t(sign | ((magnitude - 0x38000000u + 0xfffu + (magnitude >> 13 & 1u)) >> 13));
}

template <class T> void put(std::vector<std::byte>& out, T value) {
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    out.insert(out.end(), first, first + sizeof(T));
}

inline std::vector<std::byte> encodeDepth(const Geometry& g, const DepthCoding& coding, const Picture& picture) {
    // Computed in double and rounded once when stored, as by a rasterizer.
    const double n = coding.near * g.scale, f = coding.far * g.scale;
    const auto device = [&](double depth) {
        if (depth == 0.0) return coding.kind == Depth::reversed || coding.kind == Depth::reversedInfinite ? 0.0 : 1.0;
        if (g.orthographic) return coding.kind == Depth::standard ? (depth - n) / (f - n) : (f - depth) / (f - n);
        switch (coding.kind) {
            case Depth::standard: return f / (f - n) * (1.0 - n / depth);
            case Depth::reversed: return n / (f - n) * (f / depth - 1.0);
            case Depth::infinite: return 1.0 - n / depth;
            default: return n / depth;
        }
    };
    std::vector<std::byte> bytes;
    for (const double depth : picture.depth) {
        if (coding.kind == Depth::linear) {
            put(bytes, depth == 0.0 ? float(1e4 * g.scale) : float(depth));
            continue;
        }
        const double d = device(depth);
        switch (coding.format) {
            case VK_FORMAT_D16_UNORM: put(bytes, uint16_t(std::lround(d * 65535.0))); break;
            case VK_FORMAT_X8_D24_UNORM_PACK32:
            case VK_FORMAT_D24_UNORM_S8_UINT: put(bytes, uint32_t(std::lround(d * 16777215.0))); break;
            default: put(bytes, float(d)); break;
        }
    }
    return bytes;
}

inline std::vector<std::byte> encodeNormals(const Geometry& g, const NormalCoding& coding, const Picture& picture) {
    std::vector<std::byte> bytes;
    for (const glm::dvec3& inEye : picture.normal) {
        glm::dvec3 n = coding.kind == ao::NormalKind::world ? g.camera.axes() * inEye : inEye;
        if (coding.encoding == ao::NormalEncoding::octahedral32) {
            n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
            glm::dvec2 e(n);
            if (n.z < 0.0)
                e = glm::dvec2((1.0 - std::abs(n.y)) * (n.x >= 0.0 ? 1.0 : -1.0), (1.0 - std::abs(n.x)) * (n.y >= 0.0 ? 1.0 : -1.0));
            put(bytes, int16_t(std::lround(e.x * 32767.0)));
            put(bytes, int16_t(std::lround(e.y * 32767.0)));
            continue;
        }
        if (coding.encoding == ao::NormalEncoding::biased) n = n * 0.5 + 0.5;
        const double c[4] = {n.x, n.y, n.z, 0.0};
        if (coding.format == VK_FORMAT_A2B10G10R10_UNORM_PACK32) {
            put(bytes, uint32_t(std::lround(c[0] * 1023.0)) | uint32_t(std::lround(c[1] * 1023.0)) << 10 |
                           uint32_t(std::lround(c[2] * 1023.0)) << 20);
            continue;
        }
        for (const double value : c) switch (coding.format) {
                case VK_FORMAT_R8G8B8A8_UNORM: put(bytes, uint8_t(std::lround(value * 255.0))); break;
                case VK_FORMAT_R8G8B8A8_SNORM: put(bytes, int8_t(std::lround(value * 127.0))); break;
                case VK_FORMAT_R16G16B16A16_UNORM: put(bytes, uint16_t(std::lround(value * 65535.0))); break;
                case VK_FORMAT_R16G16B16A16_SNORM: put(bytes, int16_t(std::lround(value * 32767.0))); break;
                case VK_FORMAT_R16G16B16A16_SFLOAT: put(bytes, toHalf(float(value))); break;
                default: put(bytes, float(value)); break;
            }
    }
    return bytes;
}

// Depths and normals decoded from their encoding: the exact values of the stored bits.
inline Picture decoded(const Geometry& g, const DepthCoding& depth, const NormalCoding& normals, Picture picture) {
    const auto value = [](const std::byte* at, auto kind) {
        std::memcpy(&kind, at, sizeof(kind));
        return double(kind);
    };
    const double n = depth.near * g.scale, f = depth.far * g.scale;
    const std::vector<std::byte> depths = encodeDepth(g, depth, picture);
    for (size_t i = 0; i < picture.depth.size(); ++i) {
        if (depth.kind == Depth::linear || picture.depth[i] == 0.0) continue;
        const std::byte* at = depths.data() + i * texelBytes(depth.format);
        const double d = depth.format == VK_FORMAT_D16_UNORM ? value(at, uint16_t{}) / 65535.0
                         : depth.format == VK_FORMAT_X8_D24_UNORM_PACK32 || depth.format == VK_FORMAT_D24_UNORM_S8_UINT
                             ? value(at, uint32_t{}) / 16777215.0
                             : value(at, float{});
        if (g.orthographic) picture.depth[i] = depth.kind == Depth::standard ? n + d * (f - n) : f - d * (f - n);
        else if (depth.kind == Depth::standard) picture.depth[i] = n / (1.0 - d * (f - n) / f);
        else if (depth.kind == Depth::reversed) picture.depth[i] = f / (1.0 + d * (f - n) / n);
        else picture.depth[i] = n / (depth.kind == Depth::infinite ? 1.0 - d : d);
    }
    const std::vector<std::byte> stored = encodeNormals(g, normals, picture);
    for (size_t i = 0; i < picture.normal.size(); ++i) {
        const std::byte* at = stored.data() + i * texelBytes(normals.format);
        glm::dvec3 c;
        for (int k = 0; k < 3; ++k) switch (normals.format) {
                case VK_FORMAT_R32_UINT: c[k] = k < 2 ? value(at + 2 * k, int16_t{}) / 32767.0 : 0.0; break;
                case VK_FORMAT_A2B10G10R10_UNORM_PACK32: c[k] = double(uint32_t(value(at, uint32_t{})) >> 10 * k & 1023u) / 1023.0; break;
                case VK_FORMAT_R8G8B8A8_UNORM: c[k] = value(at + k, uint8_t{}) / 255.0; break;
                case VK_FORMAT_R8G8B8A8_SNORM: c[k] = std::max(value(at + k, int8_t{}) / 127.0, -1.0); break;
                case VK_FORMAT_R16G16B16A16_UNORM: c[k] = value(at + 2 * k, uint16_t{}) / 65535.0; break;
                case VK_FORMAT_R16G16B16A16_SNORM: c[k] = std::max(value(at + 2 * k, int16_t{}) / 32767.0, -1.0); break;
                case VK_FORMAT_R16G16B16A16_SFLOAT: c[k] = halfToFloat(uint16_t(value(at + 2 * k, uint16_t{}))); break;
                default: c[k] = value(at + 4 * k, float{}); break;
            }
        if (normals.encoding == ao::NormalEncoding::biased) c = c * 2.0 - 1.0;
        if (normals.encoding == ao::NormalEncoding::octahedral32) {
            c.z = 1.0 - std::abs(c.x) - std::abs(c.y);
            const double fold = std::max(-c.z, 0.0);
            c.x -= c.x >= 0.0 ? fold : -fold;
            c.y -= c.y >= 0.0 ? fold : -fold;
        }
        picture.normal[i] = normals.kind == ao::NormalKind::world ? glm::transpose(g.camera.axes()) * c : c;
    }
    return picture;
}

}  // namespace obscura::test
