#include "render/model_gpu.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

#include <glm/gtc/packing.hpp>

#include "render/chunks.h"
#include "scene/material.h"

namespace obscura::render {
namespace {

using gpu::Status;

constexpr size_t kChunkTriangles = 2048;

// Contents of a buffer, appended array by array.
struct Blob {
    std::vector<std::byte> bytes;
    template <class T> VkDeviceSize add(const std::vector<T>& items) {
        const VkDeviceSize at = bytes.size();
        bytes.resize(at + items.size() * sizeof(T));
        if (!items.empty()) std::memcpy(bytes.data() + at, items.data(), items.size() * sizeof(T));
        return at;
    }
};

struct Frame {
    uint64_t normal, tangent;
};  // vertex stream format: snorm16 x 4 each
struct Coords {
    glm::vec2 uv0, uv1;
    uint64_t color;
};
static_assert(sizeof(Frame) == kFrameBytes && sizeof(Coords) == kCoordsBytes);

struct Influence {
    std::array<uint16_t, 8> joints;
    std::array<float, 8> weights;
};
static_assert(sizeof(Influence) == 48);

std::vector<Frame> framesOf(const scene::Primitive& primitive) {
    std::vector<Frame> frames(primitive.positions.size());
    for (size_t i = 0; i < frames.size(); ++i) {
        const glm::vec3 n = i < primitive.normals.size() ? primitive.normals[i] : glm::vec3(0, 0, 1);
        const glm::vec4 t = i < primitive.tangents.size() ? primitive.tangents[i] : glm::vec4(1, 0, 0, 1);
        frames[i] = {glm::packSnorm4x16(glm::vec4(n, 0)), glm::packSnorm4x16(t)};
    }
    return frames;
}

std::vector<Coords> coordsOf(const scene::Primitive& primitive) {
    std::vector<Coords> coords(primitive.positions.size());
    for (size_t i = 0; i < coords.size(); ++i) {
        const glm::vec2 uv0 = i < primitive.uv0.size() ? primitive.uv0[i] : glm::vec2(0);
        const glm::vec4 color = i < primitive.colors.size() ? primitive.colors[i] : glm::vec4(1);
        coords[i] = {uv0, i < primitive.uv1.size() ? primitive.uv1[i] : glm::vec2(0), glm::packHalf4x16(color)};
    }
    return coords;
}

std::vector<Influence> influencesOf(const scene::Primitive& primitive) {
    std::vector<Influence> out(primitive.positions.size());
    for (size_t i = 0; i < out.size(); ++i) out[i] = {primitive.joints[i], primitive.weights[i]};
    return out;
}

std::vector<float> targetsOf(const scene::Primitive& primitive) {
    const size_t count = primitive.positions.size();
    std::vector<float> out(primitive.targets.size() * count * 9, 0.0f);
    float* at = out.data();
    for (const scene::Primitive::Target& target : primitive.targets)
        for (size_t v = 0; v < count; ++v, at += 9) {
            const auto put = [&](int where, const std::vector<glm::vec3>& from) {
                if (v < from.size()) std::memcpy(at + where, &from[v], sizeof(glm::vec3));
            };
            put(0, target.positions);
            put(3, target.normals);
            put(6, target.tangents);
        }
    return out;
}

void addReach(PrimitiveGpu& out) {
    const scene::Primitive& primitive = *out.source;
    for (const scene::Primitive::Target& target : primitive.targets) {
        glm::vec3 reach(0.0f);
        for (const glm::vec3& p : target.positions) reach = glm::max(reach, glm::abs(p));
        out.targetReach.push_back(reach);
    }
    std::map<uint32_t, scene::Bounds> boxes;
    for (size_t v = 0; v < primitive.joints.size(); ++v)
        for (int i = 0; i < scene::Primitive::kInfluences; ++i)
            if (primitive.weights[v][i] != 0.0f) boxes[primitive.joints[v][i]].add(primitive.positions[v]);
    for (const auto& [joint, box] : boxes) out.jointBoxes.push_back({joint, box});
}

shared::vec4 toShared(const glm::vec4& v) { return {v.x, v.y, v.z, v.w}; }

shared::MaterialBlock blockOf(const scene::Material& material) {
    shared::MaterialBlock block{};
    block.baseColor = toShared(material.baseColor);
    block.emission = toShared(glm::vec4(material.emission, material.alphaCutoff));
    block.factors = {material.metallic, material.roughness, material.normalScale, material.occlusionStrength};
    block.flags = {0, material.unlit ? 1u : 0u, 0, 0};
    const scene::TextureUse* uses[5] = {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture,
        &material.emissionTexture, &material.occlusionTexture};
    for (uint32_t slot = 0; slot < 5; ++slot) {
        const scene::TextureUse& use = *uses[slot];
        if (use.texCoord == 1) block.flags.x |= 1u << slot;
        // Counter-clockwise with v pointing down [KHR_texture_transform].
        const float c = std::cos(use.rotation), s = std::sin(use.rotation);
        block.uvMatrix[slot] = {c * use.scale.x, -s * use.scale.x, s * use.scale.y, c * use.scale.y};
        block.uvOffset[slot] = {use.offset.x, use.offset.y, 0, 0};
    }
    return block;
}

Status fill(gpu::Device& device, const std::vector<std::byte>& bytes, VkBufferUsageFlags usage, const std::string& name, gpu::Buffer& out) {
    static constexpr std::byte kPlaceholder[16]{};  // descriptors need a buffer even without contents
    const std::span<const std::byte> content = bytes.empty() ? std::span<const std::byte>(kPlaceholder) : std::span(bytes);
    const Status status =
        gpu::Buffer::create(device, content.size(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::device, name.c_str(), out);
    return status == Status::ok ? gpu::upload(device, out, content) : status;
}

Status addImages(gpu::Device& device, ModelGpu& out) {
    for (const scene::Image& image : out.model->images) {
        static const std::vector<uint8_t> kWhite(4, 255);
        const bool valid = image.width > 0 && image.height > 0 && image.rgba.size() == size_t(image.width) * image.height * 4 &&
                           std::max(image.width, image.height) <= device.caps().maxImageSize;
        const uint32_t width = valid ? image.width : 1, height = valid ? image.height : 1;
        gpu::ImageDesc desc{image.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM, width, height};
        desc.mips = uint32_t(std::bit_width(std::max(width, height)));
        desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        gpu::Image made;
        Status status = gpu::Image::create(device, desc, (out.model->name + "/" + image.name).c_str(), made);
        const std::vector<uint8_t>& texels = valid ? image.rgba : kWhite;
        if (status == Status::ok)
            status = gpu::upload(device, made, std::as_bytes(std::span(texels)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        if (status != Status::ok) return status;
        out.textureBytes += made.bytes();
        out.images.push_back(std::move(made));
    }
    return Status::ok;
}

}  // namespace

Status ModelGpu::create(gpu::Device& device, std::shared_ptr<const scene::Model> source, ModelGpu& out) {
    out.model = std::move(source);
    const scene::Model& model = *out.model;
    Blob vertices, indices, rest, influences, targets, materials;
    uint32_t serial = 0, primitiveIndex = 0;

    for (const scene::Mesh& mesh : model.meshes) {
        std::vector<PrimitiveGpu>& primitives = out.meshes.emplace_back();
        for (const scene::Primitive& primitive : mesh.primitives) {
            PrimitiveGpu gpu;
            gpu.source = &primitive;
            gpu.primitiveIndex = primitiveIndex++;
            gpu.materialIndex = uint32_t(primitive.material);
            gpu.material = &model.materials[size_t(primitive.material)];
            gpu.vertexCount = uint32_t(primitive.positions.size());
            gpu.skinned = !primitive.joints.empty();
            gpu.morphed = !primitive.targets.empty();
            gpu.coords = vertices.add(coordsOf(primitive));
            gpu.positions = vertices.add(primitive.positions);
            vertices.bytes.resize((vertices.bytes.size() + 15) & ~size_t(15));
            gpu.frames = vertices.add(framesOf(primitive));
            if (gpu.deformed()) {
                gpu.restPositions = uint32_t(rest.add(primitive.positions) / 4);
                gpu.restFrames = uint32_t(rest.add(framesOf(primitive)) / 4);
                if (gpu.skinned) gpu.influences = uint32_t(influences.add(influencesOf(primitive)) / sizeof(Influence));
                gpu.targets = uint32_t(targets.add(targetsOf(primitive)) / 4);
                addReach(gpu);
            }
            const Chunks chunks = chunksOf(primitive, gpu.deformed() ? size_t(-1) : kChunkTriangles);
            const VkDeviceSize first = indices.add(chunks.indices);
            uint32_t begin = 0;
            for (const uint32_t end : chunks.ends) {
                gpu.serial = serial++;
                gpu.indices = first + begin * sizeof(uint32_t);
                gpu.indexCount = end - begin;
                gpu.bounds = {};
                for (uint32_t i = begin; i < end; ++i) gpu.bounds.add(primitive.positions[chunks.indices[i]]);
                primitives.push_back(gpu);
                begin = end;
            }
        }
    }
    for (const scene::Material& material : model.materials) {
        materials.add(std::vector<shared::MaterialBlock>{blockOf(material)});
        materials.bytes.resize((materials.bytes.size() + kMaterialStride - 1) / kMaterialStride * kMaterialStride);
    }

    const auto made = [&](const Blob& blob, VkBufferUsageFlags usage, const char* what, gpu::Buffer& buffer) {
        out.geometryBytes += blob.bytes.size();
        return fill(device, blob.bytes, usage, model.name + "/" + what, buffer);
    };
    Status status = made(vertices, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "vertices", out.vertices);
    if (status == Status::ok)
        status = made(indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "indices", out.indices);
    if (status == Status::ok) status = made(rest, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "rest", out.rest);
    if (status == Status::ok) status = made(influences, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "influences", out.influences);
    if (status == Status::ok) status = made(targets, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "targets", out.targets);
    if (status == Status::ok) status = made(materials, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, "materials", out.materials);
    return status == Status::ok ? addImages(device, out) : status;
}

}  // namespace obscura::render
