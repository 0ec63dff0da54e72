#include "atrium/atrium_textures.h"

#include "meshkit/track.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace obscura::atrium {

using namespace kit;

namespace {

constexpr float kTau = glm::two_pi<float>();

}  // namespace

Image paintStone() {
    return paint(256, 256, [](glm::vec2 uv) {
        const float beds = fractalNoise({uv.x * 3.0f, uv.y * 14.0f}, {3, 14}, 5, 3);
        const float grain = fractalNoise(uv * 48.0f, {48, 48}, 9, 2);
        const float tone = 0.86f + 0.12f * (beds - 0.5f) + 0.08f * (grain - 0.5f);
        return glm::vec4(glm::vec3(0.96f, 0.91f, 0.82f) * tone, 1.0f);
    });
}

Image paintPlaster() {
    return paint(256, 256, [](glm::vec2 uv) {
        const float stain = fractalNoise(uv * 4.0f, {4, 4}, 21, 4);
        const float grain = fractalNoise(uv * 64.0f, {64, 64}, 3, 2);
        const glm::vec3 colour = glm::mix(glm::vec3(0.87f, 0.76f, 0.61f), glm::vec3(0.94f, 0.86f, 0.73f), stain);
        return glm::vec4(colour * (0.95f + 0.09f * (grain - 0.5f)), 1.0f);
    });
}

Image paintMarble() {
    return paint(256, 256, [](glm::vec2 uv) {
        const float warp = fractalNoise(uv * 5.0f, {5, 5}, 40, 4);
        const float vein = 1.0f - std::abs(std::sin(kTau * (uv.x + uv.y + 1.4f * warp)));
        const float tone = 0.88f + 0.1f * (warp - 0.5f) - 0.18f * std::pow(vein, 6.0f);
        return glm::vec4(glm::vec3(0.97f, 0.94f, 0.9f) * tone, 1.0f);
    });
}

Image paintCloth() {
    return paint(256, 512, [](glm::vec2 uv) {
        const float weave = 0.94f + 0.06f * std::sin(kTau * 64.0f * uv.x) * std::sin(kTau * 128.0f * uv.y);
        const float inset = std::min({uv.x, 1.0f - uv.x, 2.0f * uv.y, 2.0f * (1.0f - uv.y)});
        const bool isBorder = inset > 0.05f && inset < 0.09f;
        // A row of lozenges down the middle.
        const float across = std::abs(uv.x - 0.5f) * 2.0f;
        const float down = std::abs(uv.y * 5.0f - std::floor(uv.y * 5.0f) - 0.5f) * 2.0f;
        const bool isLozenge = across / 0.42f + down / 0.8f < 1.0f && across / 0.28f + down / 0.52f > 1.0f;
        const glm::vec3 gold(1.0f, 0.86f, 0.5f);
        return glm::vec4((isBorder || isLozenge ? gold : glm::vec3(0.72f)) * weave, 1.0f);
    });
}

Image paintLeaf() {
    return paint(128, 512, [](glm::vec2 uv) {
        constexpr float kLeaflets = 11.0f;
        const float across = std::abs(uv.x - 0.5f) * 2.0f;
        const float up = 1.0f - uv.y;
        // Leaflets slant towards the tip and shorten along the frond.
        const float place = (up - 0.1f * across) * kLeaflets;
        const float within = std::abs(place - std::floor(place) - 0.5f) * 2.0f;
        const float reach = 0.95f * std::sin(glm::pi<float>() * std::min(1.0f, 0.12f + 0.86f * up));
        const float width = 0.8f * std::sqrt(std::max(0.0f, 1.0f - across / std::max(reach, 0.01f)));
        const bool isLeaflet = across < reach && within < width;
        const bool isStem = across < 0.07f * (1.2f - up);
        const float rib = smoothStep(0.0f, 0.12f, within);
        const float tone = isStem ? 0.75f : 0.8f + 0.2f * rib;
        const float tint = fractalNoise(uv * 16.0f, {16, 16}, 77, 2);
        const glm::vec3 green = glm::mix(glm::vec3(0.3f, 0.5f, 0.2f), glm::vec3(0.45f, 0.62f, 0.26f), tint);
        return glm::vec4(green * tone, isLeaflet || isStem ? 1.0f : 0.0f);
    });
}

}  // namespace obscura::atrium
