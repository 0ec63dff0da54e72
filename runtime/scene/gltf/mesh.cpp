// glTF meshes: attributes from accessors or Draco data, triangle lists from lists, strips and fans, morph targets; then mesh_finish.cpp.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf/stages.h"

namespace obscura::scene::gltf {
namespace {

// Attributes of one primitive by name, from accessors or Draco data.
class Source {
public:
    Source(Context& context, const Asset& asset, const tinygltf::Primitive& primitive, std::string pointer)
        : m_context(context), m_asset(asset), m_primitive(primitive), m_pointer(std::move(pointer)) {
        if (hasDraco(primitive)) m_draco = unpackDraco(context, asset, primitive, m_pointer);
    }

    bool has(const std::string& name) const { return m_primitive.attributes.count(name) != 0; }
    std::string at(const std::string& name) const { return m_pointer + "/attributes/" + name; }
    const std::string& pointer() const { return m_pointer; }

    std::vector<float> floats(const std::string& name) {
        if (const auto it = m_draco.attributes.find(name); it != m_draco.attributes.end()) return std::move(it->second);
        return readFloats(m_context, m_asset, m_primitive.attributes.at(name));
    }
    std::vector<uint32_t> integers(const std::string& name) {
        if (const auto it = m_draco.attributes.find(name); it != m_draco.attributes.end()) return {it->second.begin(), it->second.end()};
        return readIntegers(m_context, m_asset, m_primitive.attributes.at(name));
    }
    int components(const std::string& name) const {
        return m_asset.gltf->accessors[size_t(m_primitive.attributes.at(name))].type == TINYGLTF_TYPE_VEC3 ? 3 : 4;
    }
    std::vector<uint32_t> indices(size_t vertexCount) {
        std::vector<uint32_t> out;
        if (hasDraco(m_primitive)) {
            out = std::move(m_draco.indices);
        } else if (m_primitive.indices >= 0) {
            out = readIntegers(m_context, m_asset, m_primitive.indices);
        } else {
            m_context.spend(vertexCount * 4, m_pointer);
            out.resize(vertexCount);
            for (size_t i = 0; i < vertexCount; ++i) out[i] = uint32_t(i);
        }
        for (size_t i = 0; i < out.size(); ++i)
            if (out[i] >= vertexCount)
                m_context.fail(
                    m_pointer + "/indices", fmt::format("index {} at {} is out of range, there are {} vertices", out[i], i, vertexCount));
        return out;
    }

private:
    Context& m_context;
    const Asset& m_asset;
    const tinygltf::Primitive& m_primitive;
    std::string m_pointer;
    DracoMesh m_draco;
};

template <class Vector>
std::vector<Vector> asVectors(const std::vector<float>& values) {
    constexpr int kSize = Vector::length();
    std::vector<Vector> out(values.size() / size_t(kSize));
    for (size_t i = 0; i < out.size(); ++i)
        for (int k = 0; k < kSize; ++k) out[i][k] = values[i * size_t(kSize) + size_t(k)];
    return out;
}

glm::vec3 unit(const glm::vec3& v) {
    const float length = glm::length(v);
    return length > 1e-20f && std::isfinite(length) ? v / length : glm::vec3(0.0f);
}

void readJoints(Context& context, Source& source, size_t jointCount, Primitive& primitive) {
    const size_t count = primitive.positions.size();
    primitive.joints.assign(count, {});
    primitive.weights.assign(count, {});
    for (int set = 0; set < 2; ++set) {
        const std::string joints = fmt::format("JOINTS_{}", set), weights = fmt::format("WEIGHTS_{}", set);
        if (!source.has(joints)) continue;
        const std::vector<uint32_t> indices = source.integers(joints);
        const std::vector<float> values = source.floats(weights);
        for (size_t i = 0; i < count; ++i)
            for (size_t k = 0; k < 4; ++k) {
                const float weight = values[i * 4 + k];
                const uint32_t joint = indices[i * 4 + k];
                if (weight < 0.0f)
                    context.fail(source.at(weights), fmt::format("vertex {} has the negative weight {}; weights are 0 or more", i, weight));
                if (weight == 0.0f) continue;
                if (joint >= jointCount)
                    context.fail(source.at(joints), fmt::format("vertex {} follows joint {}, but the skin has {}", i, joint, jointCount));
                primitive.joints[i][size_t(set) * 4 + k] = uint16_t(joint);
                primitive.weights[i][size_t(set) * 4 + k] = weight;
            }
    }
    size_t unweighted = 0;
    for (auto& weights : primitive.weights) {
        float sum = 0.0f;
        for (const float weight : weights) sum += weight;
        if (!(sum > 0.0f) || !std::isfinite(sum)) {
            weights = {1.0f};
            ++unweighted;
        } else {
            for (float& weight : weights) weight /= sum;
        }
    }
    if (unweighted != 0)
        context.warn(source.pointer(), fmt::format("{} vertices have no joint weights; they follow the first joint", unweighted));
}

void readAttributes(Context& context, Source& source, size_t jointCount, Primitive& primitive) {
    primitive.positions = asVectors<glm::vec3>(source.floats("POSITION"));
    if (source.has("NORMAL")) {
        primitive.normals = asVectors<glm::vec3>(source.floats("NORMAL"));
        for (glm::vec3& n : primitive.normals) n = unit(n);
    }
    if (source.has("TANGENT") && source.has("NORMAL")) {
        primitive.tangents = asVectors<glm::vec4>(source.floats("TANGENT"));
        for (glm::vec4& t : primitive.tangents) t = glm::vec4(unit(glm::vec3(t)), t.w < 0.0f ? -1.0f : 1.0f);
    }
    if (source.has("TEXCOORD_0")) primitive.uv0 = asVectors<glm::vec2>(source.floats("TEXCOORD_0"));
    else primitive.uv0.resize(primitive.positions.size(), glm::vec2(0.0f));
    if (source.has("TEXCOORD_1")) primitive.uv1 = asVectors<glm::vec2>(source.floats("TEXCOORD_1"));
    if (source.has("COLOR_0")) {
        if (source.components("COLOR_0") == 4) {
            primitive.colors = asVectors<glm::vec4>(source.floats("COLOR_0"));
        } else {
            for (const glm::vec3& c : asVectors<glm::vec3>(source.floats("COLOR_0"))) primitive.colors.emplace_back(c, 1.0f);
        }
        for (glm::vec4& c : primitive.colors) c = glm::clamp(c, 0.0f, 1.0f);
    }
    if (source.has("JOINTS_0") && jointCount > 0) readJoints(context, source, jointCount, primitive);
    for (const char* name : {"TEXCOORD_2", "COLOR_1", "JOINTS_2"})
        if (source.has(name)) context.warn(source.at(name), "is not supported; it is ignored");
}

// Triangle lists from lists, strips and fans.
std::vector<uint32_t> triangles(Context& context, const std::string& pointer, int mode, const std::vector<uint32_t>& in) {
    std::vector<uint32_t> out;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        out = in;
        if (out.size() % 3 != 0)
            context.warn(pointer, fmt::format("{} indices are not a multiple of 3; the last {} are ignored", in.size(), in.size() % 3));
        out.resize(out.size() / 3 * 3);
        return out;
    }
    if (in.size() < 3) return out;
    context.spend((in.size() - 2) * 12, pointer);
    out.reserve((in.size() - 2) * 3);
    for (uint32_t i = 0; i + 2 < in.size(); ++i) {
        // Every second triangle of a strip has reversed winding [glTF 2.0, 3.7.2.1].
        const bool odd = mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1;
        const uint32_t first = mode == TINYGLTF_MODE_TRIANGLE_FAN ? in[i + 1] : in[i];
        const uint32_t second = mode == TINYGLTF_MODE_TRIANGLE_FAN ? in[i + 2] : in[i + (odd ? 2 : 1)];
        const uint32_t third = mode == TINYGLTF_MODE_TRIANGLE_FAN ? in[0] : in[i + (odd ? 1 : 2)];
        out.insert(out.end(), {first, second, third});
    }
    return out;
}

std::vector<Primitive::Target> readTargets(
    Context& context, const Asset& asset, const tinygltf::Primitive& from, const std::string& pointer) {
    std::vector<Primitive::Target> targets;
    for (size_t i = 0; i < from.targets.size(); ++i) {
        Primitive::Target target;
        for (const auto& [name, accessor] : from.targets[i]) {
            if (name == "POSITION") target.positions = asVectors<glm::vec3>(readFloats(context, asset, accessor));
            else if (name == "NORMAL") target.normals = asVectors<glm::vec3>(readFloats(context, asset, accessor));
            else if (name == "TANGENT") target.tangents = asVectors<glm::vec3>(readFloats(context, asset, accessor));
            else context.warn(fmt::format("{}/targets/{}", pointer, i), fmt::format("morphing of {} is not supported; ignored", name));
        }
        targets.push_back(std::move(target));
    }
    return targets;
}

// Replaces normals of length 0 by the area-weighted mean normal of the triangles at the vertex.
void repairNormals(Context& context, const std::string& pointer, Primitive& primitive) {
    std::vector<glm::vec3> sums;
    size_t repaired = 0;
    for (size_t v = 0; v < primitive.normals.size(); ++v) {
        if (primitive.normals[v] != glm::vec3(0.0f)) continue;
        if (sums.empty()) {
            sums.assign(primitive.positions.size(), glm::vec3(0.0f));
            for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
                const uint32_t* t = &primitive.indices[i];
                const auto& p = primitive.positions;
                const glm::vec3 n = glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
                for (int k = 0; k < 3; ++k) sums[t[k]] += n;
            }
        }
        const glm::vec3 n = unit(sums[v]);
        primitive.normals[v] = n != glm::vec3(0.0f) ? n : glm::vec3(0.0f, 1.0f, 0.0f);
        ++repaired;
    }
    if (repaired != 0) context.warn(pointer, fmt::format("{} normals have length 0; they are computed from their triangles", repaired));
}

// Per mesh, the smallest joint count of the skins that deform it: joint indices below it are valid in all of them.
std::vector<size_t> jointCounts(const tinygltf::Model& gltf) {
    std::vector<size_t> counts(gltf.meshes.size(), 0);
    for (const auto& node : gltf.nodes) {
        if (node.mesh < 0 || node.skin < 0) continue;
        const size_t joints = gltf.skins[size_t(node.skin)].joints.size();
        size_t& count = counts[size_t(node.mesh)];
        count = count == 0 ? joints : std::min(count, joints);
    }
    return counts;
}

// Bytes of a vertex with generated attributes, for the budget.
constexpr uint64_t kVertexBytes = 12 + 12 + 16 + 8;

}  // namespace

void addMeshes(Context& context, const Asset& asset, Model& model) {
    const std::vector<size_t> joints = jointCounts(*asset.gltf);
    int defaultMaterial = -1;
    for (size_t m = 0; m < asset.gltf->meshes.size(); ++m) {
        const tinygltf::Mesh& from = asset.gltf->meshes[m];
        Mesh mesh;
        mesh.name = from.name;
        for (size_t p = 0; p < from.primitives.size(); ++p) {
            const tinygltf::Primitive& source = from.primitives[p];
            const std::string pointer = fmt::format("/meshes/{}/primitives/{}", m, p);
            if (source.mode < TINYGLTF_MODE_TRIANGLES) {
                context.warn(pointer, "points and lines are not supported; the primitive is ignored");
                continue;
            }
            if (source.attributes.count("POSITION") == 0) {
                context.warn(pointer, "has no POSITION; the primitive is ignored");
                continue;
            }
            Primitive primitive;
            Source attributes(context, asset, source, pointer);
            readAttributes(context, attributes, joints[m], primitive);
            primitive.indices = triangles(context, pointer, source.mode, attributes.indices(primitive.positions.size()));
            primitive.targets = readTargets(context, asset, source, pointer);
            const uint64_t vertices = primitive.normals.empty() ? primitive.indices.size() : primitive.positions.size();
            context.spend(vertices * (kVertexBytes + (primitive.joints.empty() ? 0 : 48) + primitive.targets.size() * 24), pointer);
            if (source.material >= 0) {
                primitive.material = source.material;
            } else {
                if (defaultMaterial < 0) {
                    defaultMaterial = int(model.materials.size());
                    model.materials.emplace_back();
                }
                primitive.material = defaultMaterial;
            }
            if (primitive.normals.empty()) addFlatNormals(primitive);
            else repairNormals(context, pointer, primitive);
            const Material& material = model.materials[size_t(primitive.material)];
            addTangents(primitive, material.normalTexture.texture >= 0 ? material.normalTexture.texCoord : 0);
            addBounds(primitive);
            mesh.primitives.push_back(std::move(primitive));
        }
        const size_t targets = from.primitives.empty() ? 0 : from.primitives[0].targets.size();
        mesh.weights.assign(targets, 0.0f);
        for (size_t i = 0; i < std::min(targets, from.weights.size()); ++i) mesh.weights[i] = float(from.weights[i]);
        model.meshes.push_back(std::move(mesh));
    }
    if (model.materials.empty()) model.materials.emplace_back();
}

}  // namespace obscura::scene::gltf
