// Accessors to flat arrays: every component type, normalized integers, strides, padded matrices, sparse accessors. The check stage has
// validated ranges; here only values can be wrong.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf/stages.h"

namespace obscura::scene::gltf {
namespace {

std::string_view typeName(int type) {
    switch (type) {
        case TINYGLTF_TYPE_SCALAR: return "SCALAR";
        case TINYGLTF_TYPE_VEC2: return "VEC2";
        case TINYGLTF_TYPE_VEC3: return "VEC3";
        case TINYGLTF_TYPE_VEC4: return "VEC4";
        case TINYGLTF_TYPE_MAT2: return "MAT2";
        case TINYGLTF_TYPE_MAT3: return "MAT3";
        default: return "MAT4";
    }
}

// Memory layout of an accessor's elements.
struct Layout {
    int components = 1;
    int rows = 1;            // components in a column
    size_t columnBytes = 0;  // with padding
    size_t elementBytes = 0;
};

Layout layoutOf(const tinygltf::Accessor& accessor) {
    const std::string_view type = typeName(accessor.type);
    Layout layout;
    layout.components = componentsOf(type);
    layout.elementBytes = elementBytes(type, accessor.componentType);
    const int columns = type == "MAT2" ? 2 : type == "MAT3" ? 3 : 1;
    layout.rows = layout.components / columns;
    layout.columnBytes = layout.elementBytes / size_t(columns);
    return layout;
}

// Normalized integers; the lowest signed value is clamped to -1 [glTF 2.0, 3.6.2.2].
template <class From, class To>
To convert(From value, bool normalized) {
    if constexpr (std::is_floating_point_v<To> && std::is_integral_v<From> && sizeof(From) < 4) {
        if (normalized) return std::max(To(value) / To(std::numeric_limits<From>::max()), To(-1));
    }
    return To(value);
}

template <class From, class To>
void copyElements(const uint8_t* source, size_t stride, const Layout& layout, bool normalized, size_t count, To* out) {
    for (size_t i = 0; i < count; ++i, source += stride)
        for (int k = 0; k < layout.components; ++k) {
            From value;
            std::memcpy(
                &value, source + size_t(k / layout.rows) * layout.columnBytes + size_t(k % layout.rows) * sizeof(From), sizeof(From));
            *out++ = convert<From, To>(value, normalized);
        }
}

template <class To>
void copyAny(const tinygltf::Accessor& accessor, const Layout& layout, const uint8_t* source, size_t stride, size_t count, To* out) {
    switch (accessor.componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: return copyElements<int8_t>(source, stride, layout, accessor.normalized, count, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return copyElements<uint8_t>(source, stride, layout, accessor.normalized, count, out);
        case TINYGLTF_COMPONENT_TYPE_SHORT: return copyElements<int16_t>(source, stride, layout, accessor.normalized, count, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return copyElements<uint16_t>(source, stride, layout, accessor.normalized, count, out);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return copyElements<uint32_t>(source, stride, layout, false, count, out);
        default:
            // The check stage allows float accessors only where floats are read.
            if constexpr (std::is_floating_point_v<To>) copyElements<float>(source, stride, layout, false, count, out);
    }
}

template <class To>
void applySparse(Context& context, const Asset& asset, int index, const Layout& layout, std::vector<To>& out) {
    const tinygltf::Accessor& accessor = asset.gltf->accessors[size_t(index)];
    const auto& sparse = accessor.sparse;
    if (!sparse.isSparse) return;
    const size_t count = size_t(sparse.count);
    const std::string pointer = fmt::format("/accessors/{}/sparse", index);
    context.spend(count * (4 + layout.elementBytes), pointer);
    tinygltf::Accessor indices;
    indices.componentType = sparse.indices.componentType;
    std::vector<uint32_t> where(count);
    Layout scalar;
    scalar.columnBytes = scalar.elementBytes = bytesOf(indices.componentType);
    copyAny(indices, scalar, viewOf(context, asset, sparse.indices.bufferView).data() + sparse.indices.byteOffset, scalar.elementBytes,
        count, where.data());
    const uint8_t* values = viewOf(context, asset, sparse.values.bufferView).data() + sparse.values.byteOffset;
    for (size_t i = 0; i < count; ++i) {
        if (where[i] >= accessor.count || (i > 0 && where[i] <= where[i - 1]))
            context.fail(pointer + "/indices",
                fmt::format("index {} at {} is out of range or not above the one before; indices must increase and be below {}", where[i],
                    i, accessor.count));
        copyAny(accessor, layout, values + i * layout.elementBytes, layout.elementBytes, 1,
            out.data() + size_t(where[i]) * size_t(layout.components));
    }
}

template <class To>
std::vector<To> read(Context& context, const Asset& asset, int index) {
    const tinygltf::Accessor& accessor = asset.gltf->accessors[size_t(index)];
    const Layout layout = layoutOf(accessor);
    const std::string pointer = fmt::format("/accessors/{}", index);
    const uint64_t total = uint64_t(accessor.count) * uint64_t(layout.components);
    if (accessor.bufferView < 0) {
        // Zeros take no space in the file: a few bytes of JSON must not allocate gigabytes.
        constexpr size_t kMaxZeros = size_t(1) << 22;
        if (accessor.count > kMaxZeros)
            context.fail(
                pointer + "/count", fmt::format("{} elements without a bufferView; at most {} are supported", accessor.count, kMaxZeros));
    }
    context.spend(total * sizeof(To), pointer);
    std::vector<To> out(total);
    if (accessor.bufferView >= 0) {
        const size_t view = size_t(accessor.bufferView);
        const size_t stride = asset.gltf->bufferViews[view].byteStride;
        copyAny(accessor, layout, viewOf(context, asset, accessor.bufferView).data() + accessor.byteOffset,
            stride != 0 ? stride : layout.elementBytes, accessor.count, out.data());
    }
    applySparse(context, asset, index, layout, out);
    return out;
}

}  // namespace

std::vector<float> readFloats(Context& context, const Asset& asset, int accessor) {
    std::vector<float> values = read<float>(context, asset, accessor);
    for (size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i]))
            context.fail(fmt::format("/accessors/{}", accessor), fmt::format("value {} is not a finite number", i));
    return values;
}

std::vector<uint32_t> readIntegers(Context& context, const Asset& asset, int accessor) { return read<uint32_t>(context, asset, accessor); }

}  // namespace obscura::scene::gltf
