// Runs obscura-evaluate through the shell and makes frames for it.
#include "command.h"

#include <algorithm>
#include <fstream>
#include <random>
#include <sstream>

namespace obscura::evaluate {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
    std::stringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

Ended runTool(const std::string& arguments) { return test::runShell(shellCommand("{} ", OBSCURA_EVALUATE) + arguments); }

truth::CapturedFrame cornerFrame() {
    truth::CapturedFrame frame = truth::emptyFrame({64, 36}, {6, 4}, 1.0471976f, 0.1f);
    constexpr float kFloor = -1.0f, kWall = -5.0f;  // y of the floor, z of the wall, m
    for (uint32_t y = 0; y < frame.size.y; ++y)
        for (uint32_t x = 0; x < frame.size.x; ++x) {
            const size_t i = frame.index(x, y);
            frame.depth[i] = 1.0f;
            const glm::vec3 ray = frame.eyePosition(x, y);  // at 1 m
            const float toFloor = ray.y < 0.0f ? kFloor / ray.y : 1e9f, toWall = kWall / ray.z;
            frame.depth[i] = std::min(toFloor, toWall);
            frame.normals[i] = toFloor < toWall ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
        }
    return frame;
}

}  // namespace obscura::evaluate
