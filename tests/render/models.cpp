// Small animated test models.
#include "models.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace obscura::test {
namespace {

using scene::Primitive;

scene::Image pattern() {
    scene::Image image{"pattern", 256, 256, true, {}};
    for (uint32_t y = 0; y < 256; ++y)
        for (uint32_t x = 0; x < 256; ++x) {
            const float u = float(x) / 256.0f * 6.2831853f, v = float(y) / 256.0f * 6.2831853f;
            const float waves[] = {std::sin(6 * u), std::sin(6 * v), std::sin(4 * u + 4 * v)};
            for (const float wave : waves) image.rgba.push_back(uint8_t(std::lround(140.0f + 90.0f * wave)));
            image.rgba.push_back(255);
        }
    return image;
}

// A grid of n x m quads over p(u, v). Texture coordinates are in metres, so the pattern has the same scale on every face.
template <class Position>
void addGrid(Primitive& out, int n, int m, const Position& p, const glm::vec3& normal, const glm::vec3& tangent, const glm::vec2& metres) {
    const uint32_t first = uint32_t(out.positions.size());
    for (int j = 0; j <= m; ++j)
        for (int i = 0; i <= n; ++i) {
            const float u = float(i) / float(n), v = float(j) / float(m);
            out.positions.push_back(p(u, v));
            out.normals.push_back(normal);
            out.tangents.emplace_back(tangent, 1.0f);
            out.uv0.emplace_back(u * metres.x, v * metres.y);
        }
    for (int j = 0; j < m; ++j)
        for (int i = 0; i < n; ++i) {
            const uint32_t a = first + uint32_t(j * (n + 1) + i), b = a + 1, c = a + uint32_t(n) + 1, d = c + 1;
            out.indices.insert(out.indices.end(), {a, b, d, a, d, c});
        }
}

Primitive box(const glm::vec3& half, int along) {
    Primitive out;
    const glm::vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {1.0f, -1.0f}) {
            const glm::vec3 n = axes[axis] * side, t = axes[(axis + 1) % 3] * side, b = glm::cross(n, t);
            const auto quads = [&](const glm::vec3& d) { return std::abs(d.y) > 0.5f ? along : 1; };
            addGrid(
                out, quads(t), quads(b), [&](float u, float v) { return half * (n + t * (2 * u - 1) + b * (2 * v - 1)); }, n, t,
                2.0f * glm::vec2(glm::length(half * t), glm::length(half * b)));
        }
    return out;
}

std::shared_ptr<scene::Model> modelOf(const char* name, Primitive primitive) {
    auto model = std::make_shared<scene::Model>();
    model->name = name;
    model->images.push_back(pattern());
    scene::Texture texture{0, {}};
    texture.sampler.mipmaps = false;  // the pattern is smooth; a change of mip level would look like motion
    model->textures.push_back(texture);
    scene::Material material;
    material.metallic = 0.0f;
    material.roughness = 0.7f;
    material.baseColorTexture.texture = 0;
    model->materials.push_back(material);
    for (const glm::vec3& p : primitive.positions) {
        primitive.boundsMin = glm::min(primitive.boundsMin, p);
        primitive.boundsMax = glm::max(primitive.boundsMax, p);
    }
    scene::Mesh mesh{name, {std::move(primitive)}, {}};
    mesh.weights.assign(mesh.primitives[0].targets.size(), 0.0f);
    model->meshes.push_back(std::move(mesh));
    scene::Node node;
    node.mesh = 0;
    model->nodes.push_back(node);
    model->roots = {0};
    model->order = {0};
    return model;
}

scene::Channel channel(int node, scene::AnimatedPath path, int components, std::vector<float> times, std::vector<float> values) {
    scene::Channel out;
    out.node = node;
    out.path = path;
    out.components = components;
    out.times = std::move(times);
    out.values = std::move(values);
    return out;
}

void animate(scene::Model& model, std::vector<scene::Channel> channels) { model.animations.push_back({"move", 1.0f, std::move(channels)}); }

std::vector<float> turn(const glm::vec3& axis, float angle) {
    const glm::quat q = glm::angleAxis(angle, glm::normalize(axis));
    return {0, 0, 0, 1, q.x, q.y, q.z, q.w};
}

Primitive::Target displaced(const Primitive& primitive, const auto& by) {
    Primitive::Target target;
    for (const glm::vec3& p : primitive.positions) {
        target.positions.push_back(by(p));
        target.normals.push_back(glm::vec3(0.3f * by(p).z, 0.0f, 0.1f * by(p).x));
    }
    return target;
}

}  // namespace

std::shared_ptr<scene::Model> turningCube() {
    auto model = modelOf("cube", box(glm::vec3(0.5f), 1));
    scene::Node carrier;  // the parent travels, the child turns and is squashed
    carrier.children = {0};
    model->nodes.push_back(carrier);
    model->nodes[0].parent = 1;
    model->nodes[0].scale = {1.0f, 0.8f, 1.2f};
    model->roots = {1};
    model->order = {1, 0};
    animate(*model, {channel(0, scene::AnimatedPath::rotation, 4, {0, 1}, turn({0.3f, 1, 0.2f}, 2.4f)),
                        channel(1, scene::AnimatedPath::translation, 3, {0, 1}, {-0.3f, 0, 0, 0.5f, 0.3f, -0.6f})});
    return model;
}

std::shared_ptr<scene::Model> bendingBar() {
    constexpr int kJoints = 4;
    constexpr float kHalf = 1.0f, kStep = 2.0f * kHalf / kJoints;
    Primitive bar = box({0.2f, kHalf, 0.2f}, 24);
    for (const glm::vec3& p : bar.positions) {
        // Two joints blend linearly; zeros fill the rest.
        const float along = glm::clamp((p.y + kHalf) / kStep - 0.5f, 0.0f, float(kJoints - 1));
        const int low = std::min(int(along), kJoints - 2);
        bar.joints.push_back({uint16_t(low), uint16_t(low + 1)});
        bar.weights.push_back({1.0f - (along - float(low)), along - float(low)});
    }
    bar.targets.push_back(displaced(bar, [](const glm::vec3& p) { return glm::vec3(p.x * (1.0f - p.y * p.y), 0.0f, p.z * 0.5f); }));
    auto model = modelOf("bar", std::move(bar));
    scene::Skin skin;
    for (int j = 0; j < kJoints; ++j) {
        scene::Node joint;
        joint.parent = j == 0 ? -1 : j;
        joint.translation = {0, j == 0 ? -kHalf : kStep, 0};
        if (j + 1 < kJoints) joint.children = {j + 2};
        model->nodes.push_back(joint);
        model->order.push_back(j + 1);
        skin.joints.push_back(j + 1);
        skin.inverseBindMatrices.push_back(glm::translate(glm::mat4(1.0f), glm::vec3(0, kHalf - kStep * float(j), 0)));
    }
    model->roots = {0, 1};
    model->skins.push_back(skin);
    model->nodes[0].skin = 0;
    model->nodes[0].translation = {5, 5, 5};  // does not apply to skinned geometry
    std::vector<scene::Channel> channels{channel(0, scene::AnimatedPath::weights, 1, {0, 1}, {0.0f, 0.8f})};
    for (int j = 0; j < kJoints; ++j)
        channels.push_back(channel(j + 1, scene::AnimatedPath::rotation, 4, {0, 1}, turn({0.2f, 0.3f, 1}, 0.5f + 0.2f * float(j))));
    animate(*model, std::move(channels));
    return model;
}

std::shared_ptr<scene::Model> wavingPatch() {
    Primitive patch;
    addGrid(patch, 20, 20, [](float u, float v) { return glm::vec3(2 * u - 1, 2 * v - 1, 0); }, {0, 0, 1}, {1, 0, 0}, {2, 2});
    patch.targets.push_back(displaced(patch, [](const glm::vec3& p) { return glm::vec3(0, 0, 0.4f * std::sin(3 * p.x)); }));
    patch.targets.push_back(displaced(patch, [](const glm::vec3&) { return glm::vec3(9.0f); }));
    patch.targets.push_back(displaced(patch, [](const glm::vec3& p) { return glm::vec3(0.5f * p.y, -0.4f * p.x, 0.3f * p.x * p.y); }));
    auto model = modelOf("patch", std::move(patch));
    model->nodes[0].rotation = glm::angleAxis(0.4f, glm::vec3(0, 1, 0));
    animate(*model, {channel(0, scene::AnimatedPath::weights, 3, {0, 1}, {1.0f, 0, 0, -0.5f, 0, 1.0f})});
    return model;
}

std::shared_ptr<scene::Model> floorPlate() {
    Primitive plate;
    addGrid(plate, 4, 4, [](float u, float v) { return glm::vec3(6 * u - 3, 0, 3 - 6 * v); }, {0, 1, 0}, {1, 0, 0}, {6, 6});
    return modelOf("floor", std::move(plate));
}

std::shared_ptr<scene::Model> with(std::shared_ptr<scene::Model> model, const scene::Material& material) {
    const scene::TextureUse use = model->materials[0].baseColorTexture;
    model->materials[0] = material;
    model->materials[0].baseColorTexture = use;
    return model;
}

scene::Instance instanceOf(std::shared_ptr<const scene::Model> model, const glm::vec3& at) {
    scene::Instance instance;
    instance.model = std::move(model);
    instance.placement = glm::translate(glm::mat4(1.0f), at);
    return instance;
}

scene::World mixedWorld() {
    scene::World world;
    world.add(instanceOf(turningCube(), {-0.9f, 0.2f, 0.3f}));
    world.add(instanceOf(bendingBar(), {0.9f, 0, -0.5f}));
    world.add(instanceOf(wavingPatch(), {0, 0.3f, -1.5f}));
    world.add(instanceOf(floorPlate(), {0, -0.8f, 0}));
    scene::Instance mirrored = instanceOf(turningCube(), {0.0f, 0.9f, 0.0f});
    mirrored.placement = mirrored.placement * glm::scale(glm::mat4(1.0f), glm::vec3(-0.4f, 0.4f, 0.4f));
    world.add(mirrored);
    return world;
}

}  // namespace obscura::test
