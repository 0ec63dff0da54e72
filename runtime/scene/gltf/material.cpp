// Materials, textures and samplers. An image that is used both as colour and as data is listed twice, once as sRGB.
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf/stages.h"

namespace obscura::scene::gltf {
namespace {

Wrap wrapOf(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
    if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::mirror;
    return Wrap::repeat;
}

Sampler samplerOf(const tinygltf::Sampler& from) {
    Sampler sampler;
    sampler.wrapU = wrapOf(from.wrapS);
    sampler.wrapV = wrapOf(from.wrapT);
    sampler.linearMag = from.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST;
    sampler.linearMin = from.minFilter != TINYGLTF_TEXTURE_FILTER_NEAREST &&
                        from.minFilter != TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST &&
                        from.minFilter != TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
    sampler.mipmaps = from.minFilter != TINYGLTF_TEXTURE_FILTER_NEAREST && from.minFilter != TINYGLTF_TEXTURE_FILTER_LINEAR;
    return sampler;
}

float numberOf(const tinygltf::Value& object, const char* key, size_t element, float otherwise) {
    if (!object.IsObject() || !object.Has(key)) return otherwise;
    const tinygltf::Value& value = object.Get(key);
    if (value.IsNumber()) return float(value.GetNumberAsDouble());
    if (value.IsArray() && element < value.ArrayLen()) return float(value.Get(element).GetNumberAsDouble());
    return otherwise;
}

// Collects the textures that materials use, in order of first use.
class TextureTable {
public:
    TextureTable(Context& context, const Asset& asset, Model& model) : m_context(context), m_asset(asset), m_model(model) {}

    template <class Info>
    TextureUse use(const Info& info, bool srgb, const std::string& pointer) {
        TextureUse use;
        if (info.index < 0) return use;
        use.texCoord = info.texCoord;
        if (const auto it = info.extensions.find(kTransform); it != info.extensions.end()) {
            const tinygltf::Value& t = it->second;
            use.offset = {numberOf(t, "offset", 0, 0), numberOf(t, "offset", 1, 0)};
            use.scale = {numberOf(t, "scale", 0, 1), numberOf(t, "scale", 1, 1)};
            use.rotation = numberOf(t, "rotation", 0, 0);
            use.texCoord = int(numberOf(t, "texCoord", 0, float(use.texCoord)));
        }
        if (use.texCoord > 1) {
            m_context.warn(
                pointer, fmt::format("texture coordinate set {} is not supported (0 and 1 are); the texture is ignored", use.texCoord));
            return {};
        }
        use.texture = texture(info.index, srgb, pointer);
        return use;
    }

    std::vector<ImageUse> images;

private:
    int texture(int index, bool srgb, const std::string& pointer) {
        const auto [it, isNew] = m_textures.try_emplace({index, srgb}, -1);
        if (!isNew) return it->second;
        const tinygltf::Texture& from = m_asset.gltf->textures[size_t(index)];
        if (from.source < 0) {
            m_context.warn(pointer, fmt::format("texture {} has no PNG or JPEG image; it is ignored", index));
            return -1;
        }
        for (const auto& extension : from.extensions)
            m_context.warn(pointer, fmt::format("texture {}: {} is not supported; its PNG or JPEG is used", index, extension.first));
        const auto [image, isNewImage] = m_images.try_emplace({from.source, srgb}, int(images.size()));
        if (isNewImage) images.push_back({from.source, srgb});
        Texture texture;
        texture.image = image->second;
        if (from.sampler >= 0) texture.sampler = samplerOf(m_asset.gltf->samplers[size_t(from.sampler)]);
        it->second = int(m_model.textures.size());
        m_model.textures.push_back(texture);
        return it->second;
    }

    Context& m_context;
    const Asset& m_asset;
    Model& m_model;
    std::map<std::pair<int, bool>, int> m_textures, m_images;
};

// "extras": {"obscura_shell": "solid" | "flipped" | "sheet"}. Default: sheet for double-sided alpha-masked materials, such as cards of
// leaves; else solid.
Shell shellOf(const tinygltf::Material& from, const Material& material, Context& context, const std::string& pointer) {
    const Shell fallback = material.alphaMode == AlphaMode::mask && material.doubleSided ? Shell::sheet : Shell::solid;
    if (!from.extras.IsObject() || !from.extras.Has("obscura_shell")) return fallback;
    const tinygltf::Value& value = from.extras.Get("obscura_shell");
    const std::string word = value.IsString() ? value.Get<std::string>() : "";
    for (const auto& [name, shell] :
        {std::pair("solid", Shell::solid), std::pair("flipped", Shell::flipped), std::pair("sheet", Shell::sheet)})
        if (word == name) return shell;
    context.warn(pointer + "/extras/obscura_shell", "must be \"solid\", \"flipped\" or \"sheet\"; it is ignored");
    return fallback;
}

Material materialOf(Context& context, const tinygltf::Material& from, TextureTable& textures, const std::string& pointer) {
    Material material;
    material.name = from.name;
    const auto& pbr = from.pbrMetallicRoughness;
    for (int i = 0; i < 4; ++i) material.baseColor[i] = float(pbr.baseColorFactor[size_t(i)]);
    material.metallic = float(pbr.metallicFactor);
    material.roughness = float(pbr.roughnessFactor);
    float strength = 1.0f;
    if (const auto it = from.extensions.find(kEmissiveStrength); it != from.extensions.end())
        strength = numberOf(it->second, "emissiveStrength", 0, 1.0f);
    for (int i = 0; i < 3; ++i) material.emission[i] = strength * float(from.emissiveFactor[size_t(i)]);
    material.normalScale = float(from.normalTexture.scale);
    material.occlusionStrength = float(from.occlusionTexture.strength);
    material.alphaCutoff = float(from.alphaCutoff);
    material.alphaMode = from.alphaMode == "MASK" ? AlphaMode::mask : from.alphaMode == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
    material.doubleSided = from.doubleSided;
    material.unlit = from.extensions.count(kUnlit) != 0;
    material.shell = shellOf(from, material, context, pointer);
    const std::string inner = pointer + "/pbrMetallicRoughness";
    material.baseColorTexture = textures.use(pbr.baseColorTexture, true, inner + "/baseColorTexture");
    material.metallicRoughnessTexture = textures.use(pbr.metallicRoughnessTexture, false, inner + "/metallicRoughnessTexture");
    material.normalTexture = textures.use(from.normalTexture, false, pointer + "/normalTexture");
    material.emissionTexture = textures.use(from.emissiveTexture, true, pointer + "/emissiveTexture");
    material.occlusionTexture = textures.use(from.occlusionTexture, false, pointer + "/occlusionTexture");
    return material;
}

}  // namespace

void addMaterials(Context& context, const Asset& asset, bool withImages, Model& model) {
    TextureTable textures(context, asset, model);
    for (size_t i = 0; i < asset.gltf->materials.size(); ++i)
        model.materials.push_back(materialOf(context, asset.gltf->materials[i], textures, fmt::format("/materials/{}", i)));
    model.images = decodeImages(context, asset, textures.images, withImages);
}

}  // namespace obscura::scene::gltf
