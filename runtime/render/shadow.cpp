#include "render/shadow.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace obscura::render {
namespace {

using gpu::Status;

// Negative, since depth is reversed. Covers the depth range of a texel; scene/shade.glsl adds an offset along the normal.
constexpr float kDepthBiasSlope = -1.5f;

glm::mat4 lightAxes(const glm::vec3& toSun) {
    const glm::vec3 aside = std::abs(toSun.y) < 0.95f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 x = glm::normalize(glm::cross(aside, toSun)), y = glm::cross(toSun, x);
    return glm::transpose(glm::mat4(glm::vec4(x, 0), glm::vec4(y, 0), glm::vec4(toSun, 0), glm::vec4(0, 0, 0, 1)));
}

scene::Bounds boundsAlong(const glm::mat4& axes, const scene::Bounds& box) {
    scene::Bounds out;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z);
        out.add(glm::vec3(axes * glm::vec4(p, 1.0f)));
    }
    return out;
}

// The map's square and depth range in light space. Both change in steps: of whole texels, so that shadows of static objects do not crawl,
// and of many texels, so that moving objects rarely change the map of settled ones.
struct Fit {
    glm::vec2 centre;
    float side, low, high;
};
Fit fit(const scene::Bounds& world, const glm::vec3& around, float reach, uint32_t size) {
    const glm::vec3 extent = world.max - world.min;
    float side = std::max({extent.x, extent.y, 0.1f}) * 1.07f;  // a step of the centre and a border
    glm::vec2 centre(world.centre());
    if (side > 2.0f * reach) {
        side = 2.0f * reach;
        centre = glm::vec2(around);
    } else {
        side = std::exp2(std::ceil(std::log2(side) * 4.0f) / 4.0f);
    }
    const float step = side / float(size) * float(std::max(size / 32, 1u));
    const float deep = side / 8.0f;
    return {
        glm::round(centre / step) * step, side, std::floor(world.min.z / deep - 0.1f) * deep, std::ceil(world.max.z / deep + 0.1f) * deep};
}

struct Fingerprint {
    uint64_t value = 14695981039346656037ull;
    void add(const void* data, size_t bytes) {
        for (size_t i = 0; i < bytes; ++i) value = (value ^ static_cast<const uint8_t*>(data)[i]) * 1099511628211ull;
    }
};

}  // namespace

Status Shadow::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Shadow& out) {
    out.m_device = &device;
    gpu::GraphicsState state;
    state.depthFormat = VK_FORMAT_D32_SFLOAT;
    state.depthTest = state.depthWrite = true;
    state.depthBiasSlope = kDepthBiasSlope;
    state.vertexBindings = {{0, kPositionBytes, VK_VERTEX_INPUT_RATE_VERTEX}};
    state.vertexAttributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}};
    Status status = gpu::Program::graphics(device, shaders, "scene/shadow.vert", "", state, {}, out.m_solid);
    if (status != Status::ok) return status;
    state.vertexBindings.push_back({1, kCoordsBytes, VK_VERTEX_INPUT_RATE_VERTEX});
    state.vertexAttributes.push_back({1, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 0});
    state.vertexAttributes.push_back({2, 1, VK_FORMAT_R16G16B16A16_SFLOAT, 16});
    return gpu::Program::graphics(device, shaders, "scene/shadow.vert:MASKED", "scene/shadow_masked.frag", state, {}, out.m_masked);
}

// Sorts draws so that instances merge; appends their items to m_items.
void Shadow::collect(Layer& layer, std::vector<const Drawable*> casters, const glm::mat4& clip) {
    layer.solid.clear();
    layer.masked.clear();
    std::stable_sort(casters.begin(), casters.end(), [](const Drawable* a, const Drawable* b) {
        return std::pair(a->model->serial, a->primitive->serial) < std::pair(b->model->serial, b->primitive->serial);
    });
    for (const Drawable* caster : casters) {
        const bool masked = caster->primitive->material->alphaMode == scene::AlphaMode::mask;
        std::vector<Draw>& draws = masked ? layer.masked : layer.solid;
        const uint32_t item = uint32_t(m_items.size());
        const glm::mat4 matrix = clip * caster->world;
        m_items.push_back({{rowOf(matrix, 0), rowOf(matrix, 1), rowOf(matrix, 2)}});
        const bool again = !draws.empty() && draws.back().first->primitive == caster->primitive &&
                           draws.back().item + draws.back().count == item && caster->posed == kNotPosed &&
                           draws.back().first->posed == kNotPosed;
        if (again) ++draws.back().count;
        else draws.push_back({caster, item, 1});
    }
}

graph::ImageId Shadow::import(graph::Graph& graph, const Layer& layer, const char* name) {
    graph::External external;
    external.image = layer.image.handle();
    external.view = layer.image.view();
    external.desc = layer.image.desc();
    external.layout = layer.drawn ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED;
    external.layoutAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return graph.import(name, external);
}

void Shadow::draw(graph::Graph& graph, const char* name, Layer& layer, graph::ImageId target, std::optional<float> clear,
    graph::BufferId items, const Deform::Posed& posed, Materials& materials) {
    graph::Pass& pass = graph.pass(name, m_solid).read(items);
    if (posed.now) pass.use(posed.now, graph::Access::vertex);
    pass.depth(target, clear).record([this, &layer, posed, &materials](const graph::PassContext& c) {
        const gpu::Api& vk = c.device.vk();
        recordDraws(c.cmd, vk, layer.solid, posed.buffers, kPosition, false, nullptr);
        if (layer.masked.empty()) return;
        m_masked.refresh();
        vk.CmdBindPipeline(c.cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, m_masked.pipeline());
        recordDraws(c.cmd, vk, layer.masked, posed.buffers, kPosition | kCoords, false, [&](const ModelGpu& model, uint32_t material) {
            const VkDescriptorSet set = materials.get(model, material, m_masked);
            vk.CmdBindDescriptorSets(c.cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, m_masked.layout(), 1, 1, &set, 0, nullptr);
        });
    });
}

Shadow::Map Shadow::add(graph::Graph& graph, const ShadowRequest& request, const Deform::Posed& posed, Materials& materials) {
    for (Layer* layer : {&m_resting, &m_moving}) {
        if (layer->image && layer->image.desc().width == request.size) continue;
        gpu::Image fresh;
        const gpu::ImageDesc desc{VK_FORMAT_D32_SFLOAT, request.size, request.size, 1, 1,
            VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                VK_IMAGE_USAGE_TRANSFER_DST_BIT};
        if (gpu::Image::create(*m_device, desc, "shadow map", fresh) != Status::ok) return {};
        layer->image = std::move(fresh);
        layer->drawn = 0;
    }

    scene::Bounds world;  // in light space
    const glm::mat4 axes = lightAxes(request.toSun);
    for (const Drawable& caster : request.casters) {
        if (caster.bounds.empty) continue;
        const scene::Bounds box = boundsAlong(axes, caster.bounds);
        world.add(box.min);
        world.add(box.max);
    }
    if (world.empty) world.add(glm::vec3(0.0f));
    const glm::vec3 around = glm::vec3(axes * glm::vec4(request.eye + request.forward * (0.7f * request.reach), 1.0f));
    const Fit f = fit(world, around, request.reach, request.size);
    glm::mat4 clip(0.0f);
    clip[0][0] = clip[1][1] = 2.0f / f.side;
    clip[2][2] = 1.0f / (f.high - f.low);
    clip[3] = glm::vec4(-f.centre * (2.0f / f.side), -f.low / (f.high - f.low), 1.0f);
    clip = clip * axes;

    Fingerprint resting, moving;
    resting.add(&clip, sizeof(clip));
    const Frustum frustum(clip);
    std::vector<const Drawable*> casters[2];
    for (const Drawable& caster : request.casters) {
        const scene::AlphaMode mode = caster.primitive->material->alphaMode;
        if (mode == scene::AlphaMode::blend || (request.skipMasked && mode == scene::AlphaMode::mask)) continue;
        if (!frustum.intersects(caster.bounds)) continue;
        Fingerprint& print = caster.settled ? resting : moving;
        const uint32_t serials[] = {caster.model->serial, caster.primitive->serial};
        print.add(serials, sizeof(serials));
        print.add(&caster.world, sizeof(caster.world));
        print.add(&caster.version, sizeof(caster.version));
        casters[caster.settled ? 0 : 1].push_back(&caster);
    }
    moving.add(&resting.value, sizeof(resting.value));

    Map map;
    map.texel = f.side / float(request.size);
    map.depthRange = f.high - f.low;
    const glm::mat4 toUnit(0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 1, 0, 0.5f, 0.5f, 0, 1);
    map.fromWorld = toUnit * clip;
    const bool redrawResting = m_resting.drawn != resting.value, anyMoving = !casters[1].empty();
    const bool redrawMoving = anyMoving && m_moving.drawn != moving.value;

    m_items.clear();
    if (redrawResting) collect(m_resting, std::move(casters[0]), clip);
    if (redrawMoving) collect(m_moving, std::move(casters[1]), clip);
    if (m_items.empty()) m_items.push_back({});
    graph::BufferId items;
    if (redrawResting || redrawMoving) items = graph.upload("shadow items", m_items.data(), m_items.size() * sizeof(m_items[0]));

    map.image = import(graph, m_resting, "shadow at rest");
    if (redrawResting) draw(graph, "shadow.rest", m_resting, map.image, 0.0f, items, posed, materials);
    m_resting.drawn = resting.value;
    if (!anyMoving) return map;

    const graph::ImageId rest = map.image;
    map.image = import(graph, m_moving, "shadow map");
    if (redrawMoving) {
        const uint32_t size = request.size;
        graph.pass("shadow.copy")
            .use(rest, graph::Access::transferRead)
            .use(map.image, graph::Access::transferWrite, true)
            .record([rest, to = map.image, size](const graph::PassContext& c) {
                const VkImageSubresourceLayers depth{VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1};
                const VkImageCopy region{depth, {}, depth, {}, {size, size, 1}};
                c.device.vk().CmdCopyImage(c.cmd, c.image(rest), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, c.image(to),
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
            });
        draw(graph, "shadow", m_moving, map.image, std::nullopt, items, posed, materials);
    }
    m_moving.drawn = moving.value;
    return map;
}

}  // namespace obscura::render
