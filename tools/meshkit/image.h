// 8-bit RGBA pictures, tileable noise, PNG encoding.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace obscura::kit {

/// An 8-bit RGBA picture.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;
};

/// Paints each pixel from its place in the unit square; colours are as stored (sRGB).
Image paint(int width, int height, const std::function<glm::vec4(glm::vec2)>& colour);

std::vector<std::uint8_t> encodePng(const Image& image);

/// Smooth noise in [0, 1] that repeats after `period` lattice cells in each direction.
float tileableNoise(glm::vec2 p, glm::ivec2 period, std::uint32_t seed);

/// Several octaves of tileable noise, in [0, 1].
float fractalNoise(glm::vec2 p, glm::ivec2 period, std::uint32_t seed, int octaves);

/// A pseudo-random number in [0, 1), a hash of the arguments.
float hash01(std::uint32_t a, std::uint32_t b = 0, std::uint32_t c = 0);

}  // namespace obscura::kit
