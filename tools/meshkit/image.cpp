#include "meshkit/image.h"

#include <cmath>
#include <stdexcept>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#if defined(__GNUC__)
// stb_image_write.h defines writers for other formats, which are unused here.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace obscura::kit {

Image paint(int width, int height, const std::function<glm::vec4(glm::vec2)>& colour) {
    Image image{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::vec4 c = glm::clamp(colour((glm::vec2(x, y) + 0.5f) / glm::vec2(width, height)), 0.0f, 1.0f);
            for (int i = 0; i < 4; ++i) image.pixels.push_back(static_cast<std::uint8_t>(std::lround(c[i] * 255.0f)));
        }
    return image;
}

std::vector<std::uint8_t> encodePng(const Image& image) {
    std::vector<std::uint8_t> bytes;
    const auto append = [](void* context, void* data, int size) {
        auto& out = *static_cast<std::vector<std::uint8_t>*>(context);
        const auto* first = static_cast<const std::uint8_t*>(data);
        out.insert(out.end(), first, first + size);
    };
    if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 4, image.pixels.data(), image.width * 4) == 0)
        throw std::runtime_error("cannot encode a PNG image");
    return bytes;
}

float hash01(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    std::uint32_t h = a * 0x9E3779B1u ^ (b + 0x7F4A7C15u) * 0x85EBCA77u ^ (c + 0x165667B1u) * 0xC2B2AE3Du;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    h ^= h >> 15;
    return static_cast<float>(h >> 8) / 16777216.0f;
}

float tileableNoise(glm::vec2 p, glm::ivec2 period, std::uint32_t seed) {
    const glm::vec2 cell = glm::floor(p);
    const glm::vec2 f = p - cell;
    const glm::vec2 u = f * f * (3.0f - 2.0f * f);
    const auto corner = [&](int dx, int dy) {
        const int x = ((static_cast<int>(cell.x) + dx) % period.x + period.x) % period.x;
        const int y = ((static_cast<int>(cell.y) + dy) % period.y + period.y) % period.y;
        return hash01(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed);
    };
    return glm::mix(glm::mix(corner(0, 0), corner(1, 0), u.x), glm::mix(corner(0, 1), corner(1, 1), u.x), u.y);
}

float fractalNoise(glm::vec2 p, glm::ivec2 period, std::uint32_t seed, int octaves) {
    float sum = 0.0f;
    float weight = 0.5f;
    float total = 0.0f;
    for (int i = 0; i < octaves; ++i) {
        sum += weight * tileableNoise(p, period, seed + static_cast<std::uint32_t>(i));
        total += weight;
        weight *= 0.5f;
        p *= 2.0f;
        period *= 2;
    }
    return sum / total;
}

}  // namespace obscura::kit
