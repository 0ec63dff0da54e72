// Alpha test of masked primitives: texture alpha x factor x vertex alpha against the cutoff. Private to truth.
#pragma once

#include "scene/world.h"

namespace obscura::truth {

class AlphaMask {
public:
    AlphaMask(const scene::Model& model, const scene::Primitive& primitive);
    bool open(uint32_t triangle, float u, float v) const;  // u, v: barycentrics of the second and third corner; true: the ray passes

private:
    float texel(int x, int y) const;
    float sample(glm::vec2 uv) const;

    const scene::Primitive* m_primitive;
    const scene::Image* m_image = nullptr;  // null: no texture
    scene::Sampler m_sampler;
    const std::vector<glm::vec2>* m_uv = nullptr;
    glm::mat2 m_uvMatrix{1.0f};
    glm::vec2 m_uvOffset{0.0f};
    float m_factor = 1.0f;
    float m_cutoff = 0.5f;
};

}  // namespace obscura::truth
