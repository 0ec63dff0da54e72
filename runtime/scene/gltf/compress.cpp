// Decompression: buffer views by meshoptimizer [EXT_meshopt_compression], primitives by Draco [KHR_draco_mesh_compression].
#include <algorithm>
#include <cmath>
#include <ctime>

#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <meshoptimizer.h>
#include <tiny_gltf.h>

#include "scene/gltf/stages.h"

namespace obscura::scene::gltf {
namespace {

size_t wholeOf(const tinygltf::Value& object, const char* key) { return object.Has(key) ? size_t(object.Get(key).GetNumberAsDouble()) : 0; }

std::string textOf(const tinygltf::Value& object, const char* key) {
    return object.Has(key) ? object.Get(key).Get<std::string>() : std::string();
}

double threadSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

Bytes unpackView(Context& context, const Asset& asset, const tinygltf::Value& packed, const std::string& pointer) {
    const Bytes& buffer = asset.gltf->buffers[wholeOf(packed, "buffer")].data;
    const uint8_t* data = buffer.data() + wholeOf(packed, "byteOffset");
    const size_t length = wholeOf(packed, "byteLength");
    const size_t count = wholeOf(packed, "count"), stride = wholeOf(packed, "byteStride");
    const std::string mode = textOf(packed, "mode"), filter = textOf(packed, "filter");
    // The codecs need at least 1 byte for 64 bytes of output. A claim far above that is false and would only allocate memory.
    if (count * stride > length * 256 + 65536)
        context.fail(
            pointer, fmt::format("{} bytes cannot be stored in {} compressed ones; compress the model again", count * stride, length));
    context.spend(uint64_t(count) * stride, pointer);
    Bytes out(count * stride);
    int status = -1;
    if (mode == "ATTRIBUTES") status = meshopt_decodeVertexBuffer(out.data(), count, stride, data, length);
    if (mode == "TRIANGLES") status = meshopt_decodeIndexBuffer(out.data(), count, stride, data, length);
    if (mode == "INDICES") status = meshopt_decodeIndexSequence(out.data(), count, stride, data, length);
    if (status != 0) context.fail(pointer, "the compressed data is damaged; compress the model again");
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
    return out;
}

}  // namespace

void unpackViews(Context& context, Asset& asset) {
    const auto& views = asset.gltf->bufferViews;
    asset.unpacked.resize(views.size());
    for (size_t i = 0; i < views.size(); ++i) {
        if (const auto it = views[i].extensions.find(kMeshopt); it != views[i].extensions.end()) {
            asset.unpacked[i] = unpackView(context, asset, it->second, fmt::format("/bufferViews/{}/extensions/{}", i, kMeshopt));
            asset.views.emplace_back(asset.unpacked[i]);
        } else if (!asset.hasData[size_t(views[i].buffer)]) {
            asset.views.emplace_back();
        } else {
            const Bytes& buffer = asset.gltf->buffers[size_t(views[i].buffer)].data;
            asset.views.emplace_back(buffer.data() + views[i].byteOffset, views[i].byteLength);
        }
    }
}

std::span<const uint8_t> viewOf(const Context& context, const Asset& asset, int view) {
    const auto bytes = asset.views[size_t(view)];
    if (bytes.empty())
        context.fail(fmt::format("/bufferViews/{}/buffer", view),
            fmt::format("buffer {} has neither a uri nor a BIN chunk", asset.gltf->bufferViews[size_t(view)].buffer));
    return bytes;
}

bool hasDraco(const tinygltf::Primitive& primitive) { return primitive.extensions.count(kDraco) != 0; }

DracoMesh unpackDraco(Context& context, const Asset& asset, const tinygltf::Primitive& primitive, const std::string& pointer) {
    const std::string where = fmt::format("{}/extensions/{}", pointer, kDraco);
    const tinygltf::Value& extension = primitive.extensions.at(kDraco);
    const std::span<const uint8_t> view = viewOf(context, asset, int(wholeOf(extension, "bufferView")));
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(view.data()), view.size());
    draco::Decoder decoder;
    const double start = threadSeconds();
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    // A damaged stream can make Draco 1.5 decode 2^31 texture orientations: seconds of work that cannot be interrupted. Valid data decodes
    // 100 times faster than this limit. The model is rejected at the first primitive that exceeds it.
    if (threadSeconds() - start > 1.0 + 20e-6 * double(view.size()))
        context.fail(where, "the Draco data is damaged (it takes too long); compress the model again");
    if (!decoded.ok())
        context.fail(where, fmt::format("the Draco data is damaged ({}); compress the model again", decoded.status().error_msg()));
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();

    DracoMesh out;
    const size_t points = mesh->num_points();
    context.spend(uint64_t(mesh->num_faces()) * 12, where);
    out.indices.reserve(size_t(mesh->num_faces()) * 3);
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
        for (int k = 0; k < 3; ++k) out.indices.push_back(mesh->face(face)[size_t(k)].value());

    const tinygltf::Value& names = extension.Get("attributes");
    for (const std::string& name : names.Keys()) {
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(uint32_t(wholeOf(names, name.c_str())));
        const tinygltf::Accessor& accessor = asset.gltf->accessors[size_t(primitive.attributes.at(name))];
        const int components = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
        if (attribute == nullptr)
            context.fail(where + "/attributes/" + name, "the compressed mesh has no attribute of that id; compress the model again");
        if (points != accessor.count)
            context.fail(
                where, fmt::format("the compressed mesh has {} vertices, but the accessor of {} has {}", points, name, accessor.count));
        if (attribute->num_components() != components)
            context.fail(where + "/attributes/" + name,
                fmt::format("has {} components, but its accessor has {}", attribute->num_components(), components));
        context.spend(uint64_t(points) * uint64_t(components) * 4, where);
        std::vector<float> values(points * size_t(components));
        for (draco::PointIndex point(0); point < uint32_t(points); ++point) {
            const draco::AttributeValueIndex index = attribute->mapped_index(point);
            if (index.value() >= attribute->size() ||
                !attribute->ConvertValue<float>(index, int8_t(components), values.data() + size_t(point.value()) * size_t(components)))
                context.fail(where + "/attributes/" + name, "the compressed mesh is damaged; compress the model again");
        }
        // Draco keeps integers unchanged; the accessor says whether they are normalized.
        if (accessor.normalized && !attribute->normalized()) {
            const float largest = accessor.componentType == TINYGLTF_COMPONENT_TYPE_BYTE            ? 127.0f
                                  : accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ? 255.0f
                                  : accessor.componentType == TINYGLTF_COMPONENT_TYPE_SHORT         ? 32767.0f
                                                                                                    : 65535.0f;
            for (float& value : values) value = std::max(value / largest, -1.0f);
        }
        for (const float value : values)
            if (!std::isfinite(value)) context.fail(where + "/attributes/" + name, "has a value that is not a finite number");
        out.attributes[name] = std::move(values);
    }
    return out;
}

}  // namespace obscura::scene::gltf
