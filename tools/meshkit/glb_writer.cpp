#include "meshkit/glb_writer.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>

namespace obscura::kit {

namespace {

using Json = nlohmann::json;

enum ComponentType { kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };
enum Target { kNoTarget = 0, kVertices = 34962, kIndices = 34963 };

const char* typeName(std::size_t width) {
    switch (width) {
        case 1: return "SCALAR";
        case 2: return "VEC2";
        case 3: return "VEC3";
        case 4: return "VEC4";
        case 16: return "MAT4";
        default: throw std::logic_error("no accessor type of this width");
    }
}

const char* pathName(Path path) {
    switch (path) {
        case Path::Translation: return "translation";
        case Path::Rotation: return "rotation";
        case Path::Scale: return "scale";
        case Path::Weights: return "weights";
    }
    throw std::logic_error("unknown animation path");
}

const char* interpolationName(Interpolation interpolation) {
    switch (interpolation) {
        case Interpolation::Linear: return "LINEAR";
        case Interpolation::Step: return "STEP";
        case Interpolation::CubicSpline: return "CUBICSPLINE";
    }
    throw std::logic_error("unknown interpolation");
}

/// One primitive's accessors, shared by every mesh that uses the geometry.
struct Primitive {
    std::uint32_t material = 0;
    Json attributes = Json::object();
    int indices = kNone;
    Json targets = Json::array();
};

class Writer {
public:
    explicit Writer(const Scene& scene) : m_scene(scene) {}

    std::vector<std::uint8_t> write();

private:
    int addView(std::span<const std::uint8_t> bytes, Target target);
    int addAccessor(std::span<const std::uint8_t> bytes, ComponentType type, std::size_t width, std::size_t count, Target target);
    int addFloats(std::span<const float> values, std::size_t width, Target target, bool withBounds);
    int addVectors(const std::vector<glm::vec3>& values, bool withBounds);

    bool usesTexcoords(int geometry, std::uint32_t slot) const;
    Primitive writePrimitive(int geometry, std::uint32_t slot);
    void writeImages();
    void writeMaterials();
    void writeMeshes();
    void writeNodes();
    void writeSkins();
    void writeAnimation();
    std::vector<std::uint8_t> pack() const;

    const Scene& m_scene;
    Json m_json;
    std::vector<std::uint8_t> m_binary;
    std::map<std::vector<float>, int> m_timeAccessors;
};

int Writer::addView(std::span<const std::uint8_t> bytes, Target target) {
    m_binary.resize((m_binary.size() + 3) / 4 * 4, 0);
    Json view{{"buffer", 0}, {"byteOffset", m_binary.size()}, {"byteLength", bytes.size()}};
    if (target != kNoTarget) view["target"] = static_cast<int>(target);
    m_binary.insert(m_binary.end(), bytes.begin(), bytes.end());
    m_json["bufferViews"].push_back(std::move(view));
    return static_cast<int>(m_json["bufferViews"].size() - 1);
}

int Writer::addAccessor(std::span<const std::uint8_t> bytes, ComponentType type, std::size_t width, std::size_t count, Target target) {
    m_json["accessors"].push_back(Json::object(
        {{"bufferView", addView(bytes, target)}, {"componentType", static_cast<int>(type)}, {"count", count}, {"type", typeName(width)}}));
    return static_cast<int>(m_json["accessors"].size() - 1);
}

int Writer::addFloats(std::span<const float> values, std::size_t width, Target target, bool withBounds) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
    const int accessor = addAccessor({bytes, values.size_bytes()}, kFloat, width, values.size() / width, target);
    if (withBounds) {
        std::vector<float> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width));
        std::vector<float> high = low;
        for (std::size_t i = 0; i < values.size(); ++i) {
            low[i % width] = std::min(low[i % width], values[i]);
            high[i % width] = std::max(high[i % width], values[i]);
        }
        m_json["accessors"][accessor]["min"] = low;
        m_json["accessors"][accessor]["max"] = high;
    }
    return accessor;
}

int Writer::addVectors(const std::vector<glm::vec3>& values, bool withBounds) {
    return addFloats({&values.front().x, values.size() * 3}, 3, kVertices, withBounds);
}

bool Writer::usesTexcoords(int geometry, std::uint32_t slot) const {
    return std::any_of(m_scene.meshes.begin(), m_scene.meshes.end(),
        [&](const MeshUse& use) { return use.geometry == geometry && m_scene.materials[use.materials.at(slot)].image != kNone; });
}

Primitive Writer::writePrimitive(int geometryIndex, std::uint32_t slot) {
    const Geometry& geometry = m_scene.geometries[geometryIndex];
    std::vector<std::uint32_t> sources;
    std::vector<std::uint32_t> indices;
    std::map<std::uint32_t, std::uint32_t> renumbered;
    for (const Triangle& triangle : geometry.mesh.triangles) {
        if (triangle.material != slot) continue;
        for (std::uint32_t corner : triangle.corner) {
            const auto [entry, isNew] = renumbered.try_emplace(corner, static_cast<std::uint32_t>(sources.size()));
            if (isNew) sources.push_back(corner);
            indices.push_back(entry->second);
        }
    }
    const auto gather = [&](const auto& pick) {
        std::vector<glm::vec3> result(sources.size());
        std::transform(sources.begin(), sources.end(), result.begin(), pick);
        return result;
    };

    Primitive primitive;
    primitive.material = slot;
    primitive.attributes["POSITION"] = addVectors(gather([&](std::uint32_t i) { return geometry.mesh.vertices[i].position; }), true);
    primitive.attributes["NORMAL"] = addVectors(gather([&](std::uint32_t i) { return geometry.mesh.vertices[i].normal; }), false);
    if (usesTexcoords(geometryIndex, slot)) {
        std::vector<float> texcoords;
        for (std::uint32_t source : sources) {
            const glm::vec2 uv = geometry.mesh.vertices[source].texcoord;
            texcoords.insert(texcoords.end(), {uv.x, uv.y});
        }
        primitive.attributes["TEXCOORD_0"] = addFloats(texcoords, 2, kVertices, false);
    }
    if (!geometry.skin.empty()) {
        std::vector<std::uint8_t> joints;
        std::vector<float> weights;
        for (std::uint32_t source : sources)
            for (int k = 0; k < 4; ++k) {
                joints.push_back(geometry.skin[source].joints[k]);
                weights.push_back(geometry.skin[source].weights[k]);
            }
        primitive.attributes["JOINTS_0"] = addAccessor(joints, kUnsignedByte, 4, sources.size(), kVertices);
        primitive.attributes["WEIGHTS_0"] = addFloats(weights, 4, kVertices, false);
    }
    for (const MorphTarget& morph : geometry.morphs) {
        Json target;
        target["POSITION"] = addVectors(gather([&](std::uint32_t i) { return morph.positionDeltas[i]; }), true);
        target["NORMAL"] = addVectors(gather([&](std::uint32_t i) { return morph.normalDeltas[i]; }), false);
        primitive.targets.push_back(std::move(target));
    }
    constexpr std::size_t kShortIndexLimit = 65535;
    if (sources.size() <= kShortIndexLimit) {
        const std::vector<std::uint16_t> shorts(indices.begin(), indices.end());
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(shorts.data());
        primitive.indices = addAccessor({bytes, shorts.size() * 2}, kUnsignedShort, 1, shorts.size(), kIndices);
    } else {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(indices.data());
        primitive.indices = addAccessor({bytes, indices.size() * 4}, kUnsignedInt, 1, indices.size(), kIndices);
    }
    return primitive;
}

void Writer::writeImages() {
    for (std::size_t i = 0; i < m_scene.images.size(); ++i) {
        const std::vector<std::uint8_t> png = encodePng(m_scene.images[i].image);
        m_json["images"].push_back(
            Json::object({{"name", m_scene.images[i].name}, {"mimeType", "image/png"}, {"bufferView", addView(png, kNoTarget)}}));
        m_json["textures"].push_back(Json::object({{"sampler", 0}, {"source", i}}));
    }
    constexpr int kLinear = 9729;
    constexpr int kLinearMipmapLinear = 9987;
    constexpr int kRepeat = 10497;
    if (!m_scene.images.empty())
        m_json["samplers"].push_back(
            Json::object({{"magFilter", kLinear}, {"minFilter", kLinearMipmapLinear}, {"wrapS", kRepeat}, {"wrapT", kRepeat}}));
}

void Writer::writeMaterials() {
    for (const Material& material : m_scene.materials) {
        Json surface{{"baseColorFactor", {material.baseColor.r, material.baseColor.g, material.baseColor.b, material.baseColor.a}},
            {"metallicFactor", material.metallic}, {"roughnessFactor", material.roughness}};
        if (material.image != kNone) surface["baseColorTexture"] = {{"index", material.image}};
        Json entry{{"name", material.name}, {"pbrMetallicRoughness", std::move(surface)}};
        if (material.emissive != glm::vec3(0.0f)) entry["emissiveFactor"] = {material.emissive.r, material.emissive.g, material.emissive.b};
        if (material.masked) {
            entry["alphaMode"] = "MASK";
            entry["alphaCutoff"] = 0.5;
        }
        if (material.doubleSided) entry["doubleSided"] = true;
        m_json["materials"].push_back(std::move(entry));
    }
}

void Writer::writeMeshes() {
    std::vector<std::vector<Primitive>> written(m_scene.geometries.size());
    for (std::size_t g = 0; g < m_scene.geometries.size(); ++g) {
        std::uint32_t slots = 0;
        for (const Triangle& triangle : m_scene.geometries[g].mesh.triangles) slots = std::max(slots, triangle.material + 1);
        for (std::uint32_t slot = 0; slot < slots; ++slot)
            if (std::any_of(m_scene.geometries[g].mesh.triangles.begin(), m_scene.geometries[g].mesh.triangles.end(),
                    [&](const Triangle& triangle) { return triangle.material == slot; }))
                written[g].push_back(writePrimitive(static_cast<int>(g), slot));
    }
    for (const MeshUse& use : m_scene.meshes) {
        Json mesh{{"name", use.name}, {"primitives", Json::array()}};
        for (const Primitive& primitive : written[use.geometry]) {
            Json entry{
                {"attributes", primitive.attributes}, {"indices", primitive.indices}, {"material", use.materials.at(primitive.material)}};
            if (!primitive.targets.empty()) entry["targets"] = primitive.targets;
            mesh["primitives"].push_back(std::move(entry));
        }
        const std::size_t morphs = m_scene.geometries[use.geometry].morphs.size();
        if (morphs > 0) mesh["weights"] = std::vector<float>(morphs, 0.0f);
        m_json["meshes"].push_back(std::move(mesh));
    }
}

void Writer::writeNodes() {
    Json roots = Json::array();
    for (const Node& node : m_scene.nodes) {
        Json entry = Json::object();
        entry["name"] = node.name;
        if (node.translation != glm::vec3(0.0f)) entry["translation"] = {node.translation.x, node.translation.y, node.translation.z};
        if (node.rotation != glm::quat(1.0f, 0.0f, 0.0f, 0.0f))
            entry["rotation"] = {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
        if (node.scale != glm::vec3(1.0f)) entry["scale"] = {node.scale.x, node.scale.y, node.scale.z};
        if (node.mesh != kNone) entry["mesh"] = node.mesh;
        if (node.skin != kNone) entry["skin"] = node.skin;
        if (node.camera != kNone) entry["camera"] = node.camera;
        const std::size_t index = m_json["nodes"].size();
        if (node.parent == kNone) roots.push_back(index);
        else m_json["nodes"][node.parent]["children"].push_back(index);
        m_json["nodes"].push_back(std::move(entry));
    }
    for (const Camera& camera : m_scene.cameras)
        m_json["cameras"].push_back(Json::object({{"name", camera.name}, {"type", "perspective"},
            {"perspective", {{"yfov", camera.verticalFov}, {"znear", camera.nearPlane}}}}));
    m_json["scenes"].push_back(Json::object({{"name", m_scene.name}, {"nodes", std::move(roots)}}));
    m_json["scene"] = 0;
}

void Writer::writeSkins() {
    for (const Skin& skin : m_scene.skins) {
        const std::span<const float> matrices{&skin.inverseBind.front()[0][0], skin.inverseBind.size() * 16};
        m_json["skins"].push_back(Json::object({{"name", skin.name}, {"skeleton", skin.skeletonRoot}, {"joints", skin.joints},
            {"inverseBindMatrices", addFloats(matrices, 16, kNoTarget, false)}}));
    }
}

void Writer::writeAnimation() {
    Json animation{{"name", m_scene.animation}, {"channels", Json::array()}, {"samplers", Json::array()}};
    for (const Channel& channel : m_scene.channels) {
        const auto [input, isNew] = m_timeAccessors.try_emplace(channel.times, kNone);
        if (isNew) input->second = addFloats(channel.times, 1, kNoTarget, true);
        // Morph weights are one long run of scalars.
        const std::size_t width = channel.path == Path::Weights ? 1 : m_scene.channelWidth(channel);
        animation["channels"].push_back(Json::object(
            {{"sampler", animation["samplers"].size()}, {"target", {{"node", channel.node}, {"path", pathName(channel.path)}}}}));
        animation["samplers"].push_back(Json::object({{"input", input->second}, {"interpolation", interpolationName(channel.interpolation)},
            {"output", addFloats(channel.values, width, kNoTarget, false)}}));
    }
    m_json["animations"].push_back(std::move(animation));
}

std::vector<std::uint8_t> Writer::pack() const {
    constexpr std::uint32_t kMagic = 0x46546C67;
    constexpr std::uint32_t kVersion = 2;
    constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
    constexpr std::uint32_t kBinaryChunk = 0x004E4942;

    std::string text = m_json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<std::uint8_t> binary = m_binary;
    binary.resize((binary.size() + 3) / 4 * 4, 0);

    std::vector<std::uint8_t> file;
    const auto word = [&](std::size_t value) {
        for (int shift = 0; shift < 32; shift += 8) file.push_back(static_cast<std::uint8_t>(value >> shift));
    };
    constexpr std::size_t kHeaderSize = 12;
    constexpr std::size_t kChunkHeaderSize = 8;
    word(kMagic);
    word(kVersion);
    word(kHeaderSize + 2 * kChunkHeaderSize + text.size() + binary.size());
    word(text.size());
    word(kJsonChunk);
    file.insert(file.end(), text.begin(), text.end());
    word(binary.size());
    word(kBinaryChunk);
    file.insert(file.end(), binary.begin(), binary.end());
    return file;
}

std::vector<std::uint8_t> Writer::write() {
    m_json["asset"] = {{"version", "2.0"}, {"generator", "Obscura meshkit"}};
    writeImages();
    writeMaterials();
    writeMeshes();
    writeNodes();
    writeSkins();
    writeAnimation();
    m_json["buffers"].push_back(Json::object({{"byteLength", m_binary.size()}}));
    return pack();
}

}  // namespace

std::vector<std::uint8_t> writeGlb(const Scene& scene) { return Writer(scene).write(); }

}  // namespace obscura::kit
