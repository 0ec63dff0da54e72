// Types and macros for headers that declare structs for both C++ and GLSL. In C++ the GLSL types are plain data of the same size. Blocks
// follow std430/std140, so keep members in 16-byte groups; every struct asserts its size.
#ifndef OBSCURA_SHARED_TYPES_H
#define OBSCURA_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>
namespace obscura::shared {
using uint = uint32_t;
struct alignas(8) vec2 { float x, y; };
struct alignas(16) vec4 { float x, y, z, w; };
struct alignas(8) uvec2 { uint32_t x, y; };
struct alignas(16) uvec4 { uint32_t x, y, z, w; };
struct alignas(8) ivec2 { int32_t x, y; };
struct mat4 { float m[16]; };  // columns
inline ivec2 sizeOf(uint32_t width, uint32_t height) { return {int32_t(width), int32_t(height)}; }
}  // namespace obscura::shared
#define OBSCURA_SHARED_BEGIN namespace obscura::shared {
#define OBSCURA_SHARED_END }
#define OBSCURA_SHARED_SIZE(type, bytes) static_assert(sizeof(type) == bytes, #type)
#else
#define OBSCURA_SHARED_BEGIN
#define OBSCURA_SHARED_END
#define OBSCURA_SHARED_SIZE(type, bytes)
#endif

#endif
