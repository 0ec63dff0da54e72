#include "render/draw_list.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "render/materials.h"

namespace obscura::render {
namespace {

using scene::AlphaMode;

glm::vec4 row(const glm::mat4& m, int r) { return {m[0][r], m[1][r], m[2][r], m[3][r]}; }

float distanceTo(const scene::Bounds& box, const glm::vec3& eye) {
    return glm::length(glm::max(glm::max(box.min - eye, eye - box.max), glm::vec3(0.0f)));
}

shared::DrawItem itemOf(const Drawable& drawable, const CameraPair& camera, const glm::mat4& previousClip, bool still) {
    shared::DrawItem item{};
    const glm::mat4 eye = camera.view * drawable.world;
    const glm::mat4 before = previousClip * drawable.previousWorld;
    const glm::mat3 m(eye);
    const float side = glm::determinant(m) < 0.0f ? -1.0f : 1.0f;
    const glm::mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    // Keeps the length of interpolated normals near 1: the fragment shader normalizes, but the squares of small scales lose precision.
    const float scale = side / std::max(std::cbrt(std::abs(glm::determinant(cofactors))), 1e-20f);
    for (int r = 0; r < 3; ++r) {
        item.eye[r] = rowOf(eye, r);
        item.previous[r] = rowOf(before, r == 2 ? 3 : r);
        item.normal[r] = {cofactors[0][r] * scale, cofactors[1][r] * scale, cofactors[2][r] * scale, 0.0f};
    }
    item.normal[0].w = still ? 1.0f : 0.0f;
    item.normal[1].w = side;
    const scene::Shell shell = drawable.primitive->material->shell;
    const float number = float((drawable.primitive->primitiveIndex + 37 * drawable.model->serial) % 63 + 1);
    item.normal[2].w = shell == scene::Shell::sheet ? 0.0f : shell == scene::Shell::flipped ? -number : number;
    return item;
}

}  // namespace

shared::vec4 rowOf(const glm::mat4& m, int r) { return {m[0][r], m[1][r], m[2][r], m[3][r]}; }

Frustum::Frustum(const glm::mat4& clip) {
    const glm::vec4 x = row(clip, 0), y = row(clip, 1), z = row(clip, 2), w = row(clip, 3);
    const glm::vec4 planes[] = {w + x, w - x, w + y, w - y, w - z, z};
    std::copy(std::begin(planes), std::end(planes), m_planes);
}

bool Frustum::intersects(const scene::Bounds& box) const {
    if (box.empty) return false;
    for (const glm::vec4& plane : m_planes) {
        const glm::vec3 n(plane);
        const glm::vec3 furthest(n.x >= 0 ? box.max.x : box.min.x, n.y >= 0 ? box.max.y : box.min.y, n.z >= 0 ? box.max.z : box.min.z);
        if (glm::dot(n, furthest) + plane.w < 0.0f) return false;
    }
    return true;
}

DrawList buildDraws(std::span<const Drawable> drawables, const CameraPair& camera, const DrawOptions& options) {
    DrawList list;
    const Frustum frustum(camera.projection * camera.view);
    const glm::mat4 previousClip = camera.previousProjection * camera.previousView;

    struct Entry {
        const Drawable* drawable;
        float distance;
        int octave;
    };
    std::vector<Entry> groups[3];
    for (const Drawable& drawable : drawables) {
        const size_t triangles = drawable.primitive->indexCount / 3;
        list.triangles += triangles;
        ++list.drawables;
        const AlphaMode mode = drawable.primitive->material->alphaMode;
        if (options.skipMasked && mode == AlphaMode::mask) continue;
        if (options.cull && !frustum.intersects(drawable.bounds)) continue;
        list.drawn += triangles;
        const float distance = distanceTo(drawable.bounds, camera.eye);
        // Half octaves of distance: near to far to save shading; within one, by material and primitive.
        groups[size_t(mode)].push_back({&drawable, distance, int(2.0f * std::log2(std::max(distance, 0.05f)))});
    }
    const auto key = [](const Entry& e) {
        return std::make_tuple(
            e.octave, e.drawable->model->serial, e.drawable->primitive->materialIndex, e.drawable->primitive->serial, e.drawable->flipped);
    };
    for (const AlphaMode mode : {AlphaMode::opaque, AlphaMode::mask})
        std::stable_sort(
            groups[size_t(mode)].begin(), groups[size_t(mode)].end(), [&](const Entry& a, const Entry& b) { return key(a) < key(b); });
    std::stable_sort(groups[size_t(AlphaMode::blend)].begin(), groups[size_t(AlphaMode::blend)].end(), [&](const Entry& a, const Entry& b) {
        return glm::length(a.drawable->bounds.centre() - camera.eye) > glm::length(b.drawable->bounds.centre() - camera.eye);
    });

    std::vector<Draw>* out[] = {&list.opaque, &list.masked, &list.blended};
    for (int mode = 0; mode < 3; ++mode) {
        for (const Entry& entry : groups[mode]) {
            const Drawable& drawable = *entry.drawable;
            const uint32_t item = uint32_t(list.items.size());
            list.items.push_back(itemOf(drawable, camera, previousClip, options.cut || (drawable.still && camera.still())));
            if (!out[mode]->empty()) {
                Draw& last = out[mode]->back();
                const Drawable& before = *last.first;
                if (before.posed == kNotPosed && drawable.posed == kNotPosed && before.primitive == drawable.primitive &&
                    before.flipped == drawable.flipped) {
                    ++last.count;
                    continue;
                }
            }
            out[mode]->push_back({&drawable, item, 1});
        }
    }
    std::copy_if(list.opaque.begin(), list.opaque.end(), std::back_inserter(list.textured),
        [](const Draw& draw) { return mapsOf(*draw.first->primitive->material) != 0; });
    return list;
}

void recordDraws(VkCommandBuffer cmd, const gpu::Api& vk, std::span<const Draw> draws, const PosedBuffers& posed, uint32_t streams,
    bool cullBackFaces, const BindMaterial& bindMaterial) {
    const ModelGpu* model = nullptr;
    uint32_t material = ~0u;
    VkCullModeFlags cull = VK_CULL_MODE_FLAG_BITS_MAX_ENUM;
    VkFrontFace front = VK_FRONT_FACE_MAX_ENUM;
    for (const Draw& draw : draws) {
        const Drawable& d = *draw.first;
        const PrimitiveGpu& primitive = *d.primitive;
        if (d.model != model) vk.CmdBindIndexBuffer(cmd, d.model->indices.handle(), 0, VK_INDEX_TYPE_UINT32);
        if (bindMaterial && (d.model != model || primitive.materialIndex != material)) bindMaterial(*d.model, primitive.materialIndex);
        model = d.model;
        material = primitive.materialIndex;

        const VkCullModeFlags wantedCull = cullBackFaces && !primitive.material->doubleSided ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
        const VkFrontFace wantedFront = d.flipped ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE;
        if (wantedCull != cull) vk.CmdSetCullMode(cmd, cull = wantedCull);
        if (wantedFront != front) vk.CmdSetFrontFace(cmd, front = wantedFront);

        const bool rigid = d.posed == kNotPosed;
        VkBuffer buffers[4];
        VkDeviceSize offsets[4];
        uint32_t count = 0;
        const auto stream = [&](Streams which, VkBuffer buffer, VkDeviceSize offset) {
            if (!(streams & which)) return;
            buffers[count] = buffer;
            offsets[count++] = offset;
        };
        const VkBuffer own = d.model->vertices.handle();
        const VkDeviceSize at = rigid ? primitive.positions : VkDeviceSize(d.posed) * kPositionBytes;
        stream(kPosition, rigid ? own : posed.now, at);
        stream(kPrevious, rigid ? own : d.fresh ? posed.now : posed.before, at);
        stream(kFrame, rigid ? own : posed.frames, rigid ? primitive.frames : VkDeviceSize(d.posed) * kFrameBytes);
        stream(kCoords, own, primitive.coords);
        vk.CmdBindVertexBuffers(cmd, 0, count, buffers, offsets);
        vk.CmdDrawIndexed(cmd, primitive.indexCount, draw.count, uint32_t(primitive.indices / 4), 0, draw.item);
    }
}

}  // namespace obscura::render
