// Validation of a glTF file's JSON, 2 of 3: images, samplers, textures, materials and meshes. Checks references, types and counts; values
// in the binary data are checked when they are decoded.
#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/gltf/stages.h"
#include "scene/json_at.h"

namespace obscura::scene::gltf {
namespace {

size_t countOf(const JsonAt& root, const char* key) { return root.has(key) ? root.at(key).size() : 0; }

void optionalNumber(const JsonAt& at, const char* key, double low, double high) {
    if (const auto value = at.find(key)) value->number(low, high);
}

void optionalNumbers(const JsonAt& at, const char* key, size_t count, double low, double high) {
    if (const auto value = at.find(key)) {
        value->expectNumbers(count);
        for (size_t i = 0; i < count; ++i) value->at(i).number(low, high);
    }
}

void checkTextureInfo(const JsonAt& root, const JsonAt& material, const char* key) {
    const auto at = material.find(key);
    if (!at) return;
    at->at("index").index(countOf(root, "textures"), "texture");
    if (const auto set = at->find("texCoord")) set->whole(0, 255);
    optionalNumber(*at, "scale", -FLT_MAX, FLT_MAX);
    optionalNumber(*at, "strength", 0, 1);
    const auto extensions = at->find("extensions");
    if (!extensions) return;
    if (const auto transform = extensions->find(kTransform)) {
        optionalNumbers(*transform, "offset", 2, -FLT_MAX, FLT_MAX);
        optionalNumbers(*transform, "scale", 2, -FLT_MAX, FLT_MAX);
        optionalNumber(*transform, "rotation", -FLT_MAX, FLT_MAX);
        if (const auto set = transform->find("texCoord")) set->whole(0, 255);
    }
}

// Checks that `at` refers to an accessor of one of the types and component types, with `count` elements (0: any number).
size_t checkAccessor(const JsonAt& root, const JsonAt& at, std::initializer_list<const char*> types,
    std::initializer_list<uint64_t> components, uint64_t count) {
    const size_t index = at.index(countOf(root, "accessors"), "accessor");
    const JsonAt accessor = root.at("accessors").at(index);
    const std::string type = accessor.at("type").text();
    if (std::find(types.begin(), types.end(), type) == types.end())
        at.fail(fmt::format("accessor {} is {}, must be {}", index, type, fmt::join(types, " or ")));
    const uint64_t component = accessor.at("componentType").whole();
    if (std::find(components.begin(), components.end(), component) == components.end())
        at.fail(fmt::format("accessor {} has component type {}, must be {}", index, component, fmt::join(components, " or ")));
    const uint64_t has = accessor.at("count").whole();
    if (count != 0 && has != count) at.fail(fmt::format("accessor {} has {} elements, must have {}", index, has, count));
    return index;
}

bool endsInNumber(std::string_view name, std::string_view stem) {
    return name.starts_with(stem) && name.size() > stem.size() && name.size() < stem.size() + 3 &&
           std::all_of(
               name.begin() + ptrdiff_t(stem.size()), name.end(), [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; });
}

// "_NAME", or "EXTENSION:NAME" of an extension that the file uses.
bool isCustom(const JsonAt& root, const std::string& name) {
    if (name.starts_with('_')) return true;
    const size_t colon = name.find(':');
    const auto used = root.find("extensionsUsed");
    for (size_t i = 0; colon != name.npos && used && i < used->size(); ++i)
        if (used->at(i).text() == name.substr(0, colon)) return true;
    return false;
}

void checkAttribute(const JsonAt& root, const JsonAt& at, const std::string& name, uint64_t count) {
    // KHR_mesh_quantization allows every integer type. They are accepted without the extension too.
    if (name == "POSITION" || name == "NORMAL") checkAccessor(root, at, {"VEC3"}, {5126, 5120, 5121, 5122, 5123}, count);
    else if (name == "TANGENT") checkAccessor(root, at, {"VEC4"}, {5126, 5120, 5122}, count);
    else if (endsInNumber(name, "TEXCOORD_")) checkAccessor(root, at, {"VEC2"}, {5126, 5120, 5121, 5122, 5123}, count);
    else if (endsInNumber(name, "COLOR_")) checkAccessor(root, at, {"VEC3", "VEC4"}, {5126, 5121, 5123}, count);
    else if (endsInNumber(name, "JOINTS_")) checkAccessor(root, at, {"VEC4"}, {5121, 5123}, count);
    else if (endsInNumber(name, "WEIGHTS_")) checkAccessor(root, at, {"VEC4"}, {5126, 5121, 5123}, count);
    else if (!isCustom(root, name))
        at.fail("is not a glTF attribute; names of custom attributes start with an underscore, or with an extension in use and a colon");
    else at.index(countOf(root, "accessors"), "accessor");
}

void checkPrimitive(const JsonAt& root, const JsonAt& at) {
    const JsonAt attributes = at.at("attributes").expectObject();
    uint64_t count = 0;
    if (attributes.has("POSITION")) {
        const JsonAt position = attributes.at("POSITION");
        checkAccessor(root, position, {"VEC3"}, {5126, 5120, 5121, 5122, 5123}, 0);
        count = root.at("accessors").at(position.index(countOf(root, "accessors"), "accessor")).at("count").whole();
    }
    for (const auto& item : attributes.json().items()) checkAttribute(root, attributes.at(item.key().c_str()), item.key(), count);
    for (int i = 0; i < 2; ++i)
        if (attributes.has(fmt::format("JOINTS_{}", i).c_str()) != attributes.has(fmt::format("WEIGHTS_{}", i).c_str()))
            attributes.fail(fmt::format("JOINTS_{} and WEIGHTS_{} must come together", i, i));
    if (const auto indices = at.find("indices")) {
        checkAccessor(root, *indices, {"SCALAR"}, {5121, 5123, 5125}, 0);
    }
    if (const auto material = at.find("material")) material->index(countOf(root, "materials"), "material");
    if (const auto mode = at.find("mode")) mode->whole(0, 6);
    for (size_t i = 0; at.has("targets") && i < at.at("targets").expectArray().size(); ++i) {
        const JsonAt target = at.at("targets").at(i).expectObject();
        for (const auto& item : target.json().items()) {
            const JsonAt value = target.at(item.key().c_str());
            const std::string& name = item.key();
            if (name == "POSITION" || name == "NORMAL" || name == "TANGENT")
                checkAccessor(root, value, {"VEC3"}, {5126, 5120, 5121, 5122, 5123}, count);
            else value.index(countOf(root, "accessors"), "accessor");
        }
    }
    const auto extensions = at.find("extensions");
    if (!extensions) return;
    if (const auto draco = extensions->expectObject().find(kDraco)) {
        draco->at("bufferView").index(countOf(root, "bufferViews"), "bufferView");
        const uint64_t mode = at.has("mode") ? at.at("mode").whole() : 4;
        if (mode != 4 && mode != 5) at.at("mode").fail("Draco supports triangle lists (4) and strips (5) only");
        const JsonAt packed = draco->at("attributes").expectObject();
        for (const auto& item : packed.json().items()) {
            packed.at(item.key().c_str()).whole(0, 65535);
            if (!attributes.has(item.key().c_str())) packed.fail(fmt::format("{} is not among the primitive's attributes", item.key()));
        }
    }
}

}  // namespace

void checkMaterials(Context& context, const nlohmann::json& json, bool hasChunk) {
    const JsonAt root(context.file, json);
    const size_t views = countOf(root, "bufferViews");
    for (size_t i = 0; i < countOf(root, "images"); ++i) {
        const JsonAt at = root.at("images").at(i);
        if (at.has("uri") == at.has("bufferView")) at.fail("must have a uri or a bufferView, and not both");
        if (const auto uri = at.find("uri")) uri->text();
        if (const auto type = at.find("mimeType")) type->text();
        if (const auto view = at.find("bufferView")) {
            const size_t index = view->index(views, "bufferView");
            if (!at.has("mimeType")) at.fail("an image in a bufferView must have a mimeType");
            const JsonAt source = root.at("bufferViews").at(index);
            if (source.has("extensions") && source.at("extensions").has(kMeshopt))
                view->fail(fmt::format("an image must not be in a view with {}", kMeshopt));
            const uint64_t buffer = source.at("buffer").whole();
            if (!root.at("buffers").at(size_t(buffer)).has("uri") && !(buffer == 0 && hasChunk))
                view->fail(fmt::format("buffer {} has neither a uri nor a BIN chunk", buffer));
        }
    }
    const auto oneOf = [](const JsonAt& at, const char* key, std::initializer_list<uint64_t> values) {
        if (const auto value = at.find(key); value && std::find(values.begin(), values.end(), value->whole()) == values.end())
            value->fail(fmt::format("{} is unknown; use one of {}", value->whole(), fmt::join(values, ", ")));
    };
    for (size_t i = 0; i < countOf(root, "samplers"); ++i) {
        const JsonAt at = root.at("samplers").at(i);
        oneOf(at, "magFilter", {9728, 9729});
        oneOf(at, "minFilter", {9728, 9729, 9984, 9985, 9986, 9987});
        oneOf(at, "wrapS", {33071, 33648, 10497});
        oneOf(at, "wrapT", {33071, 33648, 10497});
    }
    for (size_t i = 0; i < countOf(root, "textures"); ++i) {
        const JsonAt at = root.at("textures").at(i);
        if (const auto source = at.find("source")) source->index(countOf(root, "images"), "image");
        if (const auto sampler = at.find("sampler")) sampler->index(countOf(root, "samplers"), "sampler");
    }
    for (size_t i = 0; i < countOf(root, "materials"); ++i) {
        const JsonAt at = root.at("materials").at(i);
        for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) checkTextureInfo(root, at, key);
        if (const auto pbr = at.find("pbrMetallicRoughness")) {
            checkTextureInfo(root, *pbr, "baseColorTexture");
            checkTextureInfo(root, *pbr, "metallicRoughnessTexture");
            optionalNumbers(*pbr, "baseColorFactor", 4, 0, 1);
            optionalNumber(*pbr, "metallicFactor", 0, 1);
            optionalNumber(*pbr, "roughnessFactor", 0, 1);
        }
        optionalNumbers(at, "emissiveFactor", 3, 0, 1);
        optionalNumber(at, "alphaCutoff", 0, FLT_MAX);
        if (const auto mode = at.find("alphaMode"); mode && mode->text() != "OPAQUE" && mode->text() != "MASK" && mode->text() != "BLEND")
            mode->fail(fmt::format("\"{}\" is unknown; use OPAQUE, MASK or BLEND", mode->text()));
        if (const auto sides = at.find("doubleSided")) sides->truth();
        if (const auto extensions = at.find("extensions"))
            if (const auto strength = extensions->find(kEmissiveStrength)) optionalNumber(*strength, "emissiveStrength", 0, FLT_MAX);
    }
}

void checkMeshes(Context& context, const nlohmann::json& json) {
    const JsonAt root(context.file, json);
    for (size_t i = 0; i < countOf(root, "meshes"); ++i) {
        const JsonAt at = root.at("meshes").at(i);
        const JsonAt primitives = at.at("primitives").expectArray();
        size_t targets = 0;
        for (size_t k = 0; k < primitives.size(); ++k) {
            const JsonAt primitive = primitives.at(k).expectObject();
            checkPrimitive(root, primitive);
            const size_t count = primitive.has("targets") ? primitive.at("targets").size() : 0;
            if (k == 0) targets = count;
            if (count != targets)
                primitive.fail(fmt::format("has {} morph targets, but the first primitive of its mesh has {}", count, targets));
        }
        if (const auto weights = at.find("weights")) weights->expectNumbers(targets);
    }
}

}  // namespace obscura::scene::gltf
