// Runs tinygltf on the validated JSON. It reads no files: buffers and images are in memory already, and its file callbacks serve them under
// the names "buffer<i>" and "image<i>".
#include <cstdlib>

#include <fmt/format.h>
#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

#include "scene/gltf/stages.h"
#include "scene/json_text.h"

namespace obscura::scene::gltf {
namespace {

using Json = nlohmann::json;

// The in-memory files that tinygltf's file callbacks serve: "buffer<i>" and "image<i>".
struct MemoryFiles {
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

bool fileExists(const std::string& name, void* files) { return static_cast<MemoryFiles*>(files)->find(name) != nullptr; }
std::string expandPath(const std::string& name, void*) { return name; }
bool readWhole(Bytes* out, std::string*, const std::string& name, void* files) {
    Bytes* bytes = static_cast<MemoryFiles*>(files)->find(name);
    if (bytes == nullptr) return false;
    *out = std::move(*bytes);
    return true;
}
[[maybe_unused]] bool sizeOf(size_t* out, std::string*, const std::string& name, void* files) {
    const Bytes* bytes = static_cast<MemoryFiles*>(files)->find(name);
    if (bytes) *out = bytes->size();
    return bytes != nullptr;
}
bool writeWhole(std::string*, const std::string&, const Bytes&, void*) { return false; }

// tinygltf 2.9 and later also ask for the size of a file.
template <class Callbacks = tinygltf::FsCallbacks>
Callbacks callbacks(MemoryFiles& files) {
    Callbacks result{fileExists, expandPath, readWhole, writeWhole};
    if constexpr (requires { result.GetFileSizeInBytes; }) result.GetFileSizeInBytes = sizeOf;
    result.user_data = &files;
    return result;
}

// Keeps the encoded bytes; they are decoded later, in parallel.
bool keepEncoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes, int size, void*) {
    image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

// Rewrites the validated document into one that tinygltf accepts. Returns the accessors that got a placeholder bufferView, which it appends
// to the list.
std::vector<int> prepare(Json& json, MemoryFiles& files) {
    json.erase("extensions");
    json.erase("extras");
    // tinygltf rejects empty files. The byte that replaces them is never read.
    for (size_t i = 0; json.contains("buffers") && i < json["buffers"].size(); ++i) {
        if (files.buffers[i].empty()) files.buffers[i].resize(1);
        json["buffers"][i] = {{"uri", fmt::format("buffer{}", i)}, {"byteLength", files.buffers[i].size()}};
    }
    for (size_t i = 0; json.contains("images") && i < json["images"].size(); ++i) {
        Json& image = json["images"][i];
        if (!image.contains("uri")) continue;
        image["uri"] = fmt::format("image{}", i);
        if (files.images[i].empty()) files.images[i].resize(1);
    }
    // tinygltf rejects index accessors without a bufferView, which glTF allows for Draco and sparse data.
    std::vector<int> patched;
    const size_t placeholder = json.contains("bufferViews") ? json["bufferViews"].size() : 0;
    json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
    for (Json& mesh : json.contains("meshes") ? json["meshes"] : Json::array())
        for (Json& primitive : mesh["primitives"]) {
            if (!primitive.contains("indices")) continue;
            Json& accessor = json["accessors"][primitive["indices"].get<size_t>()];
            if (accessor.contains("bufferView")) continue;
            accessor["bufferView"] = placeholder;
            patched.push_back(primitive["indices"].get<int>());
        }
    // tinygltf drops channels without a node, which would shift the indices of the others.
    for (Json& animation : json.contains("animations") ? json["animations"] : Json::array())
        for (Json& channel : animation["channels"])
            if (!channel["target"].contains("node")) channel["target"]["node"] = -1;
    return patched;
}

}  // namespace

Asset::Asset() = default;
Asset::~Asset() = default;
Asset::Asset(Asset&&) noexcept = default;

std::vector<bool> usedImages(const Json& json) {
    std::vector<bool> used(json.contains("images") ? json["images"].size() : 0, false);
    const auto markUsed = [&](const Json& owner, const char* key) {
        if (!owner.contains(key)) return;
        const Json& texture = json["textures"][owner[key]["index"].get<size_t>()];
        if (texture.contains("source")) used[texture["source"].get<size_t>()] = true;
    };
    for (const Json& material : json.contains("materials") ? json["materials"] : Json::array()) {
        for (const char* key : {"normalTexture", "occlusionTexture", "emissiveTexture"}) markUsed(material, key);
        if (!material.contains("pbrMetallicRoughness")) continue;
        for (const char* key : {"baseColorTexture", "metallicRoughnessTexture"}) markUsed(material["pbrMetallicRoughness"], key);
    }
    return used;
}

Asset parse(Context& context, Document& document, bool withImages) {
    Json& json = *document.json;
    std::vector<bool> wanted = usedImages(json);
    if (!withImages) wanted.assign(wanted.size(), false);
    MemoryFiles files;
    files.buffers = readBuffers(context, document);
    files.images = readImages(context, json, wanted);
    std::vector<bool> hasData;
    for (const Bytes& buffer : files.buffers) hasData.push_back(!buffer.empty());
    const std::vector<int> patched = prepare(json, files);

    Asset asset;
    asset.hasData = std::move(hasData);
    asset.gltf = std::make_unique<tinygltf::Model>();
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(callbacks(files));
    loader.SetImageLoader(keepEncoded, nullptr);
    std::string error, warning;
    bool done = false;
    try {
        const std::string text = dump(json);
        if (text.size() > 0xffffffffu) context.fail("", "has more than 4 GiB of JSON");
        done = loader.LoadASCIIFromString(asset.gltf.get(), &error, &warning, text.data(), unsigned(text.size()), "", 0);
    } catch (const Json::exception& exception) {
        context.fail("", fmt::format("is not valid JSON: {}", exception.what()));
    }
    if (!done) context.fail("", fmt::format("cannot be parsed: {}", error));
    asset.gltf->bufferViews.pop_back();
    for (const int accessor : patched) asset.gltf->accessors[size_t(accessor)].bufferView = -1;
    document.json.reset();
    return asset;
}

}  // namespace obscura::scene::gltf
