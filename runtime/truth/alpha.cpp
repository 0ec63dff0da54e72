#include "truth/alpha.h"

#include <algorithm>
#include <cmath>

namespace obscura::truth {
namespace {

int wrap(int i, int size, scene::Wrap mode) {
    if (mode == scene::Wrap::clamp) return std::clamp(i, 0, size - 1);
    const int period = mode == scene::Wrap::mirror ? 2 * size : size;
    i = ((i % period) + period) % period;
    return i < size ? i : period - 1 - i;
}

}  // namespace

AlphaMask::AlphaMask(const scene::Model& model, const scene::Primitive& primitive) : m_primitive(&primitive) {
    const scene::Material& material = model.materials[size_t(primitive.material)];
    m_factor = material.baseColor.a;
    m_cutoff = material.alphaCutoff;
    const scene::TextureUse& use = material.baseColorTexture;
    if (use.texture < 0 || model.textures[size_t(use.texture)].image < 0) return;
    const scene::Texture& texture = model.textures[size_t(use.texture)];
    m_image = &model.images[size_t(texture.image)];
    if (m_image->rgba.size() < size_t(m_image->width) * m_image->height * 4 || m_image->rgba.empty()) m_image = nullptr;
    m_sampler = texture.sampler;
    m_uv = use.texCoord == 1 && !primitive.uv1.empty() ? &primitive.uv1 : &primitive.uv0;
    if (m_uv->size() != primitive.positions.size()) m_image = nullptr;
    // offset + rotation * scale [KHR_texture_transform].
    const float c = std::cos(use.rotation), s = std::sin(use.rotation);
    m_uvMatrix = glm::mat2(glm::vec2(c, -s) * use.scale.x, glm::vec2(s, c) * use.scale.y);
    m_uvOffset = use.offset;
}

float AlphaMask::texel(int x, int y) const {
    const int width = int(m_image->width), height = int(m_image->height);
    const size_t at = size_t(wrap(y, height, m_sampler.wrapV)) * size_t(width) + size_t(wrap(x, width, m_sampler.wrapU));
    return float(m_image->rgba[at * 4 + 3]) / 255.0f;
}

float AlphaMask::sample(glm::vec2 uv) const {
    const float x = uv.x * float(m_image->width), y = uv.y * float(m_image->height);
    if (!(std::fabs(x) < 1e9f && std::fabs(y) < 1e9f)) return 1.0f;
    if (!m_sampler.linearMag) return texel(int(std::floor(x)), int(std::floor(y)));
    const float fx = std::floor(x - 0.5f), fy = std::floor(y - 0.5f);
    const int ix = int(fx), iy = int(fy);
    const float tx = x - 0.5f - fx, ty = y - 0.5f - fy;
    return (1 - ty) * ((1 - tx) * texel(ix, iy) + tx * texel(ix + 1, iy)) +
           ty * ((1 - tx) * texel(ix, iy + 1) + tx * texel(ix + 1, iy + 1));
}

bool AlphaMask::open(uint32_t triangle, float u, float v) const {
    const uint32_t* corner = &m_primitive->indices[size_t(triangle) * 3];
    const float w = 1.0f - u - v;
    float alpha = m_factor;
    if (!m_primitive->colors.empty())
        alpha *= w * m_primitive->colors[corner[0]].a + u * m_primitive->colors[corner[1]].a + v * m_primitive->colors[corner[2]].a;
    if (m_image) alpha *= sample(m_uvMatrix * (w * (*m_uv)[corner[0]] + u * (*m_uv)[corner[1]] + v * (*m_uv)[corner[2]]) + m_uvOffset);
    return alpha < m_cutoff;
}

}  // namespace obscura::truth
