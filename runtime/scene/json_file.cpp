#include "scene/json_file.h"

#include <fstream>

#include <fmt/format.h>

namespace obscura::scene {

JsonFile::JsonFile(const std::filesystem::path& file) : m_name(file.string()) {
    constexpr uintmax_t kLargest = 16u << 20;
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) throw Error(errorLine(m_name, "", "is missing or not a file"));
    if (std::filesystem::file_size(file, error) > kLargest) throw Error(errorLine(m_name, "", "is larger than 16 MiB"));
    std::ifstream in(file, std::ios::binary);
    try {
        m_json = nlohmann::json::parse(in);
    } catch (const nlohmann::json::exception& exception) {
        std::string_view what = exception.what();
        if (const size_t end = what.find("] "); end != what.npos) what.remove_prefix(end + 2);
        throw Error(errorLine(m_name, "", fmt::format("is not valid JSON: {}", what)));
    }
}

glm::vec3 vector3(const JsonAt& at) {
    constexpr double kFarthest = 1e9;  // squares of such lengths are finite
    at.expectNumbers(3);
    glm::vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = float(at.at(size_t(i)).number(-kFarthest, kFarthest));
    return v;
}

// The lenses of files may be narrower than a game's; beyond 170 degrees a picture is all edge.
float fieldOfView(const JsonAt& at) {
    constexpr double kNarrowest = 1e-3, kWidest = 170.0;
    return float(glm::radians(at.number(kNarrowest, kWidest)));
}

std::vector<std::string> texts(const JsonAt& at) {
    std::vector<std::string> list;
    at.expectArray();
    for (size_t i = 0; i < at.size(); ++i) list.push_back(at.at(i).text());
    if (list.empty()) at.fail("must have at least one string");
    return list;
}

}  // namespace obscura::scene
