#include "tools.h"

#include <fstream>
#include <sstream>

namespace obscura::test {

void write(const fs::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

std::string textOf(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

GltfBuilder roomScene(float s) {
    GltfBuilder b;
    const std::vector<uint16_t> quad{0, 1, 2, 0, 2, 3};
    const std::vector<uint16_t> block{
        0, 3, 2, 0, 2, 1, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
    const float h = 0.5f * s, f = 4.0f * s;
    const int floor = b.vec3({-f, 0, f, f, 0, f, f, 0, -f, -f, 0, -f});
    const int corners = b.vec3({-h, 0, h, h, 0, h, h, 0, -h, -h, 0, -h, -h, s, h, h, s, h, h, s, -h, -h, s, -h});
    b.mesh({{"POSITION", floor}})["indices"] = b.accessor(quad, "SCALAR", 5123, 1);
    b.mesh({{"POSITION", corners}})["indices"] = b.accessor(block, "SCALAR", 5123, 1);
    b.json["scenes"] = Json::array({{{"nodes", Json::array({0, 1})}}});
    return b;
}

}  // namespace obscura::test
