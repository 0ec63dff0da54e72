// Reads the project's JSON files, up to 16 MiB; errors name the file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/json_at.h"

namespace obscura::scene {

class JsonFile {
public:
    explicit JsonFile(const std::filesystem::path& file);  // throws Error
    JsonAt root() const { return JsonAt(m_name, m_json); }

private:
    std::string m_name;
    nlohmann::json m_json;
};

glm::vec3 vector3(const JsonAt& at);               // metres, each within 1e9
float fieldOfView(const JsonAt& at);               // degrees in the file, radians here
std::vector<std::string> texts(const JsonAt& at);  // an array of strings, not empty

}  // namespace obscura::scene
