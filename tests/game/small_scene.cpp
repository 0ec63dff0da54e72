// Writes the small test scene as glTF.
#include "small_scene.h"

#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

namespace obscura::test {

using Json = nlohmann::json;

std::filesystem::path writeSmallScene(const std::filesystem::path& folder, float scale) {
    const float s = scale;
    // Floor, then the eight corners of the box, shared by its faces; the loader computes flat normals.
    const std::vector<float> positions{-4 * s, 0, -4 * s, 4 * s, 0, -4 * s, 4 * s, 0, 4 * s, -4 * s, 0, 4 * s, -.5f * s, 0, -.5f * s,
        .5f * s, 0, -.5f * s, .5f * s, 0, .5f * s, -.5f * s, 0, .5f * s, -.5f * s, s, -.5f * s, .5f * s, s, -.5f * s, .5f * s, s, .5f * s,
        -.5f * s, s, .5f * s};
    const std::vector<uint16_t> indices{0, 2, 1, 0, 3, 2,  // from here on the box, relative to its first corner
        4, 6, 5, 4, 7, 6, 3, 2, 6, 3, 6, 7, 1, 5, 6, 1, 6, 2, 0, 4, 5, 0, 5, 1, 0, 3, 7, 0, 7, 4};
    const std::vector<float> times{0, 1}, moves{-1 * s, 0, 0, 1 * s, 0, 0};
    std::ofstream bin(folder / "small.bin", std::ios::binary);
    const auto write = [&](const auto& list) {
        bin.write(reinterpret_cast<const char*>(list.data()), std::streamsize(list.size() * sizeof(list[0])));
    };
    write(positions);
    write(indices);
    write(times);
    write(moves);
    bin.close();

    const size_t indexAt = positions.size() * 4, timeAt = indexAt + indices.size() * 2, moveAt = timeAt + times.size() * 4;
    const auto view = [](size_t offset, size_t length) { return Json{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}}; };
    const auto primitive = [](int position, int index) {
        return Json{{"primitives", Json::array({{{"attributes", {{"POSITION", position}}}, {"indices", index}}})}};
    };
    const Json document{{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", Json::array({{{"nodes", {0, 1}}}})},
        {"nodes", Json::array({{{"name", "floor"}, {"mesh", 0}}, {{"name", "box"}, {"mesh", 1}}})},
        {"meshes", Json::array({primitive(0, 2), primitive(1, 3)})},
        {"animations", Json::array({{{"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}})},
                           {"samplers", Json::array({{{"input", 4}, {"output", 5}}})}}})},
        {"buffers", Json::array({{{"uri", "small.bin"}, {"byteLength", moveAt + moves.size() * 4}}})},
        {"bufferViews",
            Json::array({view(0, 48), view(48, 96), view(indexAt, 12), view(indexAt + 12, 60), view(timeAt, 8), view(moveAt, 24)})},
        {"accessors", Json::array({{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"},
                                       {"min", {-4 * s, 0, -4 * s}}, {"max", {4 * s, 0, 4 * s}}},
                          {{"bufferView", 1}, {"componentType", 5126}, {"count", 8}, {"type", "VEC3"}, {"min", {-.5f * s, 0, -.5f * s}},
                              {"max", {.5f * s, s, .5f * s}}},
                          {{"bufferView", 2}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}},
                          {{"bufferView", 3}, {"componentType", 5123}, {"count", 30}, {"type", "SCALAR"}},
                          {{"bufferView", 4}, {"componentType", 5126}, {"count", 2}, {"type", "SCALAR"}, {"min", {0}}, {"max", {1}}},
                          {{"bufferView", 5}, {"componentType", 5126}, {"count", 2}, {"type", "VEC3"}}})}};
    std::ofstream(folder / "small.gltf") << document.dump();
    return folder / "small.gltf";
}

}  // namespace obscura::test
