// tinygltf turns the checked JSON into its structures. It reads no file itself: buffers and images are handed to it
// under names of ours, so what it asks for and how much is settled before it starts.
#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "scene/gltf_parts.h"

namespace obscura::scene::gltf {
namespace {

using Json = nlohmann::json;

// What tinygltf's file callbacks serve: "buffer<i>" and "image<i>".
struct Shelf {
    std::vector<Bytes> buffers;
    std::vector<Bytes> images;

    Bytes* find(const std::string& name) {
        for (auto [stem, list] : {std::pair("buffer", &buffers), std::pair("image", &images)}) {
            const std::string_view prefix = stem;
            if (!name.starts_with(prefix) || name.size() == prefix.size() || name.size() > prefix.size() + 9) continue;
            const size_t index = size_t(std::atol(name.c_str() + prefix.size()));
            if (index < list->size()) return &(*list)[index];
        }
        return nullptr;
    }
};

bool fileExists(const std::string& name, void* shelf) { return static_cast<Shelf*>(shelf)->find(name) != nullptr; }
std::string expandPath(const std::string& name, void*) { return name; }
bool readWhole(Bytes* out, std::string*, const std::string& name, void* shelf) {
    Bytes* bytes = static_cast<Shelf*>(shelf)->find(name);
    if (bytes == nullptr) return false;
    *out = std::move(*bytes);
    return true;
}
bool sizeOf(size_t* out, std::string*, const std::string& name, void* shelf) {
    const Bytes* bytes = static_cast<Shelf*>(shelf)->find(name);
    if (bytes) *out = bytes->size();
    return bytes != nullptr;
}
bool writeWhole(std::string*, const std::string&, const Bytes&, void*) { return false; }

// tinygltf from 2.9 on also asks how long a file is.
template <class Callbacks = tinygltf::FsCallbacks>
Callbacks callbacks(Shelf& shelf) {
    Callbacks result{fileExists, expandPath, readWhole, writeWhole};
    if constexpr (requires { result.GetFileSizeInBytes; }) result.GetFileSizeInBytes = sizeOf;
    result.user_data = &shelf;
    return result;
}

// Keeps the encoded bytes; they are decoded later, in parallel.
bool keepEncoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes, int size, void*) {
    image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

// Rewrites the checked document into what tinygltf takes without complaint. Returns the accessors lent a bufferView, a spare
// one at the end of the list.
std::vector<int> prepare(Json& json, Shelf& shelf) {
    json.erase("extensions");
    json.erase("extras");
    // tinygltf takes no empty file, and what stands for one is never looked at.
    for (size_t i = 0; json.contains("buffers") && i < json["buffers"].size(); ++i) {
        if (shelf.buffers[i].empty()) shelf.buffers[i].resize(1);
        json["buffers"][i] = {{"uri", fmt::format("buffer{}", i)}, {"byteLength", shelf.buffers[i].size()}};
    }
    for (size_t i = 0; json.contains("images") && i < json["images"].size(); ++i) {
        Json& image = json["images"][i];
        if (!image.contains("uri")) continue;
        image["uri"] = fmt::format("image{}", i);
        if (shelf.images[i].empty()) shelf.images[i].resize(1);
    }
    // tinygltf refuses indices without a bufferView, which Draco and sparse accessors may have.
    std::vector<int> lent;
    const size_t spare = json.contains("bufferViews") ? json["bufferViews"].size() : 0;
    json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
    for (Json& mesh : json.contains("meshes") ? json["meshes"] : Json::array())
        for (Json& primitive : mesh["primitives"]) {
            if (!primitive.contains("indices")) continue;
            Json& accessor = json["accessors"][primitive["indices"].get<size_t>()];
            if (accessor.contains("bufferView")) continue;
            accessor["bufferView"] = spare;
            lent.push_back(primitive["indices"].get<int>());
        }
    // Channels without a node would vanish and shift the others.
    for (Json& animation : json.contains("animations") ? json["animations"] : Json::array())
        for (Json& channel : animation["channels"])
            if (!channel["target"].contains("node")) channel["target"]["node"] = -1;
    return lent;
}

}  // namespace

Asset::Asset() = default;
Asset::~Asset() = default;
Asset::Asset(Asset&&) noexcept = default;

std::vector<bool> usedImages(const Json& json) {
    std::vector<bool> used(json.contains("images") ? json["images"].size() : 0, false);
    const auto take = [&](const Json& owner, const char* key) {
        if (!owner.contains(key)) return;
        const Json& texture = json["textures"][owner[key]["index"].get<size_t>()];
        if (texture.contains("source")) used[texture["source"].get<size_t>()] = true;
    };
    for (const Json& material : json.contains("materials") ? json["materials"] : Json::array()) {
        for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) take(material, key);
        if (!material.contains("pbrMetallicRoughness")) continue;
        for (const char* key : {"baseColorTexture", "metallicRoughnessTexture"}) take(material["pbrMetallicRoughness"], key);
    }
    return used;
}

Asset parse(Context& context, Document& document, bool withImages) {
    Json& json = *document.json;
    std::vector<bool> wanted = usedImages(json);
    if (!withImages) wanted.assign(wanted.size(), false);
    Shelf shelf;
    shelf.buffers = readBuffers(context, document);
    shelf.images = readImages(context, json, wanted);
    std::vector<bool> hasData;
    for (const Bytes& buffer : shelf.buffers) hasData.push_back(!buffer.empty());
    const std::vector<int> lent = prepare(json, shelf);

    Asset asset;
    asset.hasData = std::move(hasData);
    asset.gltf = std::make_unique<tinygltf::Model>();
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(callbacks(shelf));
    loader.SetImageLoader(keepEncoded, nullptr);
    std::string error, warning;
    bool done = false;
    try {
        const std::string text = json.dump();
        if (text.size() > 0xffffffffu) context.fail("", "holds more than four gigabytes of JSON");
        done = loader.LoadASCIIFromString(asset.gltf.get(), &error, &warning, text.data(), unsigned(text.size()), "", 0);
    } catch (const Json::exception& exception) {
        context.fail("", fmt::format("is not valid JSON: {}", exception.what()));
    }
    if (!done) context.fail("", fmt::format("cannot be read: {}", error));
    asset.gltf->bufferViews.pop_back();
    for (const int accessor : lent) asset.gltf->accessors[size_t(accessor)].bufferView = -1;
    document.json.reset();
    return asset;
}

}  // namespace obscura::scene::gltf
