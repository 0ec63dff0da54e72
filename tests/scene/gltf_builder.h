// Builds small glTF files for tests: editable JSON, and one buffer that accessors append to.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/gltf/gltf.h"

namespace obscura::scene::test {

using Json = nlohmann::json;

class GltfBuilder {
public:
    Json json = Json{{"asset", {{"version", "2.0"}}}};

    // A bufferView over `values`; stride 0: tightly packed.
    template <class T>
    int view(const std::vector<T>& values, int stride = 0) {
        while (m_bytes.size() % 4 != 0) m_bytes.push_back(0);
        const size_t offset = m_bytes.size(), size = values.size() * sizeof(T);
        m_bytes.resize(offset + size);
        std::memcpy(m_bytes.data() + offset, values.data(), size);
        Json view{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}};
        if (stride != 0) view["byteStride"] = stride;
        json["bufferViews"].push_back(view);
        return int(json["bufferViews"].size()) - 1;
    }
    int accessor(Json fields) {
        json["accessors"].push_back(std::move(fields));
        return int(json["accessors"].size()) - 1;
    }
    template <class T>
    int accessor(const std::vector<T>& values, const char* type, int componentType, int components, bool normalized = false) {
        Json fields{
            {"bufferView", view(values)}, {"componentType", componentType}, {"type", type}, {"count", values.size() / size_t(components)}};
        if (normalized) fields["normalized"] = true;
        return accessor(fields);
    }
    int scalars(const std::vector<float>& values) { return accessor(values, "SCALAR", 5126, 1); }
    int vec3(const std::vector<float>& values) { return accessor(values, "VEC3", 5126, 3); }
    int vec4(const std::vector<float>& values) { return accessor(values, "VEC4", 5126, 4); }
    int mat4(const std::vector<float>& values) { return accessor(values, "MAT4", 5126, 16); }

    // One mesh whose first primitive has these attributes, with a node and a scene.
    Json& mesh(const Json& attributes) {
        json["meshes"].push_back({{"primitives", Json::array({{{"attributes", attributes}}})}});
        json["nodes"].push_back({{"mesh", json["meshes"].size() - 1}});
        json["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
        return json["meshes"].back()["primitives"][0];
    }
    // A triangle in the plane z = 0.
    Json& triangle() { return mesh({{"POSITION", vec3({0, 0, 0, 1, 0, 0, 0, 1, 0})}}); }

    std::string text() const {
        Json out = json;
        if (!m_bytes.empty() && !out.contains("buffers"))
            out["buffers"] = Json::array({{{"byteLength", m_bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64()}}});
        return out.dump();
    }
    std::string binary() const {
        Json out = json;
        out["buffers"] = Json::array({{{"byteLength", m_bytes.size()}}});
        std::string head = out.dump(), body(m_bytes.begin(), m_bytes.end());
        while (head.size() % 4 != 0) head += ' ';
        while (body.size() % 4 != 0) body += '\0';
        const auto word = [](uint32_t value) { return std::string(reinterpret_cast<const char*>(&value), 4); };
        return "glTF" + word(2) + word(uint32_t(28 + head.size() + body.size())) + word(uint32_t(head.size())) + "JSON" + head +
               word(uint32_t(body.size())) + std::string("BIN\0", 4) + body;
    }
    const std::vector<uint8_t>& bytes() const { return m_bytes; }
    std::shared_ptr<const Model> load(const LoadOptions& options = {}) const { return loadText(text(), options); }

    static std::shared_ptr<const Model> loadText(const std::string& text, const LoadOptions& options = {}) {
        return loadGltfMemory({reinterpret_cast<const uint8_t*>(text.data()), text.size()}, "built.gltf", options);
    }
    // The error of loading, or an empty string.
    static std::string errorOf(const std::string& text, const LoadOptions& options = {}) {
        try {
            loadText(text, options);
            return {};
        } catch (const Error& error) {
            return error.what();
        }
    }
    std::string error(const LoadOptions& options = {}) const { return errorOf(text(), options); }

private:
    std::string base64() const {
        static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string out;
        for (size_t i = 0; i < m_bytes.size(); i += 3) {
            uint32_t bits = uint32_t(m_bytes[i]) << 16;
            if (i + 1 < m_bytes.size()) bits |= uint32_t(m_bytes[i + 1]) << 8;
            if (i + 2 < m_bytes.size()) bits |= m_bytes[i + 2];
            for (size_t k = 0; k < 4; ++k) out += i + k > m_bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
        }
        return out;
    }
    std::vector<uint8_t> m_bytes;
};

inline bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

}  // namespace obscura::scene::test
