// The stages of the glTF loader, private to this folder. In order: container (bytes -> JSON), check (validation), files (bytes of buffers
// and images), parse (tinygltf), compress (meshopt views), then images, materials, meshes, nodes, animations. After `check` every index in
// the file is in range.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>

#include "scene/gltf/gltf.h"

namespace tinygltf {
class Model;
struct Primitive;
}  // namespace tinygltf

namespace obscura::scene::gltf {

using Bytes = std::vector<uint8_t>;

inline constexpr const char* kDraco = "KHR_draco_mesh_compression";
inline constexpr const char* kMeshopt = "EXT_meshopt_compression";
inline constexpr const char* kTransform = "KHR_texture_transform";
inline constexpr const char* kUnlit = "KHR_materials_unlit";
inline constexpr const char* kEmissiveStrength = "KHR_materials_emissive_strength";
inline constexpr const char* kQuantization = "KHR_mesh_quantization";

// State shared by the stages: names for errors, the memory budget, warnings.
struct Context {
    std::string file;              // as shown in errors
    std::filesystem::path folder;  // of the model, canonical; empty: external files are refused
    size_t budget = 0;             // bytes that may still be decoded
    uint64_t hash = 14695981039346656037ull;
    std::vector<std::string> warnings, variants;
    std::vector<Extension> extensions;
    std::vector<glm::dvec3> shifts;  // subtracted from the translation of each node; empty: none

    [[noreturn]] void fail(std::string_view pointer, std::string_view what) const;
    void warn(std::string_view pointer, std::string_view what);
    void spend(uint64_t bytes, std::string_view pointer);  // takes bytes from the budget; fails if it is exceeded
    void addToHash(std::span<const uint8_t> bytes);
};

struct Document {
    Document();
    ~Document();
    Document(Document&&) noexcept;
    std::unique_ptr<nlohmann::json> json;
    Bytes chunk;  // BIN chunk of the binary container
    bool hasChunk = false;
};

// A tinygltf model with its buffer views resolved and decompressed.
struct Asset {
    Asset();
    ~Asset();
    Asset(Asset&&) noexcept;
    std::unique_ptr<tinygltf::Model> gltf;
    std::vector<bool> hasData;                    // per buffer; one without data only gives compressed views their size
    std::vector<std::span<const uint8_t>> views;  // per bufferView, into buffers or `unpacked`; empty without data
    std::vector<Bytes> unpacked;
};

// container.cpp
Bytes readFile(const Context& context, const std::filesystem::path& file, std::string_view pointer, uint64_t limit);
Document readDocument(Context& context, Bytes bytes);

// check.cpp, check_looks.cpp, check_nodes.cpp
void checkDocument(Context& context, const nlohmann::json& json, bool hasChunk);
void checkMaterials(Context& context, const nlohmann::json& json, bool hasChunk);  // images, samplers, textures, materials
void checkMeshes(Context& context, const nlohmann::json& json);                    // references and counts of primitives
void checkScenes(Context& context, const nlohmann::json& json);                    // cameras, nodes, skins, scenes, animations
int componentsOf(std::string_view type);                                           // "VEC3" -> 3, 0 when unknown
size_t bytesOf(int componentType);                                                 // 5126 -> 4, 0 when unknown
size_t elementBytes(std::string_view type, int componentType);                     // matrix columns padded to four bytes
size_t lastElementBytes(std::string_view type, int componentType);                 // an accessor may end before its last padding

// files.cpp: the bytes of each buffer and image, in order. Buffers are cut to their byteLength, and empty where the file gives them no
// data. Files of images that are not `wanted` must exist, but are not read.
std::vector<Bytes> readBuffers(Context& context, Document& document);
std::vector<Bytes> readImages(Context& context, const nlohmann::json& json, const std::vector<bool>& wanted);

// parse.cpp
std::vector<bool> usedImages(const nlohmann::json& json);
Asset parse(Context& context, Document& document, bool withImages);

// compress.cpp
struct DracoMesh {
    std::vector<uint32_t> indices;
    std::map<std::string, std::vector<float>> attributes;  // by glTF name; components as the accessor has them
};
void unpackViews(Context& context, Asset& asset);
std::span<const uint8_t> viewOf(const Context& context, const Asset& asset, int view);  // fails when it has no data
bool hasDraco(const tinygltf::Primitive& primitive);
DracoMesh unpackDraco(Context& context, const Asset& asset, const tinygltf::Primitive& primitive, const std::string& pointer);

// access.cpp: accessors as flat arrays, count * components; integers normalized where the accessor says so.
std::vector<float> readFloats(Context& context, const Asset& asset, int accessor);
std::vector<uint32_t> readIntegers(Context& context, const Asset& asset, int accessor);

// image.cpp, material.cpp: fill images, textures and materials.
void addMaterials(Context& context, const Asset& asset, bool withImages, Model& model);
struct ImageUse {
    int source = -1;  // glTF image
    bool srgb = false;
};
std::vector<Image> decodeImages(Context& context, const Asset& asset, const std::vector<ImageUse>& uses, bool withImages);

// mesh.cpp
void addMeshes(Context& context, const Asset& asset, Model& model);

// mesh_finish.cpp: data that the file lacks.
void addFlatNormals(Primitive& primitive);  // gives every triangle vertices of its own
void addTangents(Primitive& primitive, int texCoord);
void addBounds(Primitive& primitive);

// nodes.cpp, animation.cpp
void addNodes(Context& context, const Asset& asset, int scene, Model& model);
void addAnimations(Context& context, const Asset& asset, Model& model);

// local_origin.cpp: moves a scene that lies far from the file's origin, in double precision. After addMeshes() and addNodes(); fills
// Context::shifts and Model::origin.
void moveToLocalOrigin(Context& context, const Asset& asset, Model& model);

}  // namespace obscura::scene::gltf
