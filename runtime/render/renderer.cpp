// The frame: updates models and poses, then adds the passes in order: deform, G-buffer, obscurance, shadow, lighting, blending,
// anti-aliasing, tone mapping or a view.
#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include <glm/gtc/matrix_transform.hpp>

#include "render/antialias.h"
#include "render/gbuffer.h"
#include "render/layers.h"
#include "render/lighting.h"
#include "render/obscurance.h"
#include "render/shadow.h"
#include "render/views.h"

namespace obscura::render {

using gpu::Status;

struct Renderer::Impl {
    Impl(gpu::Device& d, const gpu::ShaderLibrary& s) : device(d), obscurance(d, s) {}

    gpu::Device& device;
    std::map<const scene::Model*, std::unique_ptr<ModelGpu>> models;  // null: could not be uploaded, logged once
    uint32_t modelSerial = 0;
    Actors actors;
    Materials materials;
    Deform deform;
    GBufferPass gbuffer;
    LayersPass layers;
    Obscurance obscurance;
    Shadow shadow;
    Lighting lighting;
    Antialias antialias;
    Views views;
    VoxelVolume voxels;

    DrawList draws;  // of the frame being recorded
    std::optional<scene::Camera> lastCamera;
    uint64_t frame = 0;  // since the last cut
    SceneFacts facts;

    const ModelGpu* find(const scene::Model* model) const {
        const auto found = models.find(model);
        return found == models.end() ? nullptr : found->second.get();
    }
    Status load(const scene::World& world);
    CameraPair cameras(const scene::Camera& camera, VkExtent2D size, VkExtent2D visible, const glm::vec2& jitter, bool cut) const;
    void count(const scene::World& world);
};

namespace {

VkExtent2D guardOf(const FrameOptions& options) {
    const float fraction = std::clamp(options.guard, 0.0f, 0.5f);
    return {
        uint32_t(std::lround(fraction * float(options.visible.width))), uint32_t(std::lround(fraction * float(options.visible.height)))};
}

shared::SceneFrame sceneFrame(const CameraPair& camera, VkExtent2D size, VkExtent2D guard) {
    shared::SceneFrame frame{};
    std::memcpy(&frame.projection, &camera.projection, sizeof(frame.projection));
    const float w = float(size.width), h = float(size.height);
    frame.viewport = {w, h, 0.5f * w, 0.5f * h};
    frame.visibleQuads = {float(guard.width / 2), float(guard.height / 2), float((size.width - guard.width + 1) / 2),
        float((size.height - guard.height + 1) / 2)};
    frame.orthographic = {camera.orthographic ? 1.0f : 0.0f, 0, 0, 0};
    return frame;
}

}  // namespace

Renderer::Renderer() = default;
Renderer::~Renderer() = default;

std::unique_ptr<Renderer> Renderer::create(gpu::Device& device, const gpu::ShaderLibrary& shaders) {
    std::unique_ptr<Renderer> renderer(new Renderer());
    renderer->m_impl = std::make_unique<Impl>(device, shaders);
    Impl& impl = *renderer->m_impl;
    Status status = Materials::create(device, impl.materials);
    if (status == Status::ok) status = Deform::create(device, shaders, impl.deform);
    if (status == Status::ok) status = GBufferPass::create(device, shaders, impl.gbuffer);
    if (status == Status::ok) status = LayersPass::create(device, shaders, impl.layers);
    if (status == Status::ok) status = Shadow::create(device, shaders, impl.shadow);
    if (status == Status::ok) status = Lighting::create(device, shaders, impl.lighting);
    if (status == Status::ok) status = Antialias::create(device, shaders, impl.antialias);
    if (status == Status::ok) status = Views::create(device, shaders, impl.views);
    if (status == Status::ok) status = VoxelVolume::create(device, shaders, impl.voxels);
    if (status == Status::ok) return renderer;
    device.log(gpu::Severity::error, std::string("render: the renderer could not be created: ") + gpu::name(status));
    return nullptr;
}

ao::Library& Renderer::library() { return m_impl->obscurance.library(); }
ao::Library& Renderer::otherLibrary() { return m_impl->obscurance.otherLibrary(); }
SceneFacts Renderer::facts() const { return m_impl->facts; }
const voxel::Voxels* Renderer::voxels() const { return m_impl->voxels.voxels(); }
Status Renderer::load(const scene::World& world) { return m_impl->load(world); }

Status Renderer::Impl::load(const scene::World& world) {
    for (auto it = models.begin(); it != models.end();) {
        const bool used = std::any_of(world.instances().begin(), world.instances().end(),
            [&](const scene::Instance& instance) { return instance.model.get() == it->first; });
        if (used) {
            ++it;
            continue;
        }
        if (it->second) {
            materials.forget(*it->second);
            deform.forget(*it->second);
            voxels.forget(*it->second);
        }
        it = models.erase(it);
    }
    Status worst = Status::ok;
    for (const scene::Instance& instance : world.instances()) {
        if (!instance.model || models.count(instance.model.get())) continue;
        auto made = std::make_unique<ModelGpu>();
        const Status status = ModelGpu::create(device, instance.model, *made);
        if (status != Status::ok) {
            device.log(
                gpu::Severity::error, "render: " + instance.model->name + " could not be uploaded and is not drawn: " + gpu::name(status));
            models.emplace(instance.model.get(), nullptr);
            worst = status;
            continue;
        }
        for (const scene::Material& material : instance.model->materials) {
            if (material.alphaMode == scene::AlphaMode::blend) lighting.prepare(material);
            else gbuffer.prepare(material);
        }
        made->serial = modelSerial++;
        models.emplace(instance.model.get(), std::move(made));
    }
    return worst;
}

CameraPair Renderer::Impl::cameras(
    const scene::Camera& camera, VkExtent2D size, VkExtent2D visible, const glm::vec2& jitter, bool cut) const {
    const glm::vec2 whole(float(size.width), float(size.height)), shown(float(visible.width), float(visible.height));
    CameraPair pair;
    pair.view = camera.view();
    pair.projection = camera.projection(whole, shown);
    // Last frame's camera with this frame's image size: a change of size or guard band is not motion.
    const scene::Camera& before = cut || !lastCamera ? camera : *lastCamera;
    pair.previousView = before.view();
    pair.previousProjection = before.projection(whole, shown);
    // Last frame's projection with this frame's jitter: motion vectors are free of it.
    const glm::mat4 moved = glm::translate(glm::mat4(1.0f), glm::vec3(2.0f * jitter / whole, 0.0f));
    pair.projection = moved * pair.projection;
    pair.previousProjection = moved * pair.previousProjection;
    pair.jitter = jitter;
    pair.eye = camera.eye;
    pair.orthographic = camera.orthoHalfHeight > 0.0f;
    return pair;
}

void Renderer::Impl::count(const scene::World& world) {
    facts = {};
    facts.triangles = draws.triangles;
    facts.drawn = draws.drawn;
    facts.draws = draws.draws();
    facts.instances = world.instances().size();
    for (const auto& [source, model] : models) {
        if (!model) continue;
        facts.textureBytes += model->textureBytes;
        facts.geometryBytes += model->geometryBytes;
    }
}

Outputs Renderer::add(graph::Graph& graph, const scene::World& world, const FrameOptions& options) {
    Impl& impl = *m_impl;
    impl.load(world);
    const bool cut = options.cut || !impl.lastCamera;
    if (cut) {
        impl.obscurance.discardHistory();
        impl.frame = 0;
    }
    const uint64_t index = impl.frame++;
    const bool antialiases = options.antialiasing == Antialiasing::temporal && options.view == View::final && options.sampleStep == 0;
    const VkExtent2D guard = guardOf(options);
    const VkExtent2D size{options.visible.width + 2 * guard.width, options.visible.height + 2 * guard.height};
    const CameraPair camera =
        impl.cameras(options.camera, size, options.visible, antialiases ? antialiasJitter(index) : glm::vec2(0.0f), cut);
    impl.lastCamera = options.camera;

    impl.actors.update(world, options.time, cut, [&](const scene::Model* model) { return impl.find(model); });
    impl.draws = buildDraws(impl.actors.drawables(), camera, {options.cull, options.skipMasked, cut});
    impl.count(world);
    const Deform::Posed posed = impl.deform.add(graph, impl.actors);

    if (impl.draws.items.empty()) impl.draws.items.push_back({});
    const graph::BufferId frame = graph.upload("scene frame", sceneFrame(camera, size, guard));
    const graph::BufferId items = graph.upload("draw items", impl.draws.items.data(), impl.draws.items.size() * sizeof(shared::DrawItem));
    const GBuffer g = impl.gbuffer.add(graph, size, frame, items, impl.draws, posed, impl.materials);

    Obscurance::Inputs in{size, guard, camera, index, g.depth, g.geometric, g.motion, {}, {}, {}};
    if (const ao::LayerMode layers = Obscurance::layersFor(options); layers != ao::LayerMode::none)
        in.layers = impl.layers.add(graph, g, frame, items, impl.draws, posed, impl.materials, layers, options.layerForm);
    if (Obscurance::readsVolume(options)) {
        const VoxelVolume::Scene scene{world, options.time, options.camera, impl.actors.drawables(), posed, !options.skipMasked};
        in.voxels = impl.voxels.add(graph, scene, options.voxels, in.volume);
    }
    const Obscurance::Result obscurance = impl.obscurance.add(graph, in, options, impl.views);
    const shared::View& view = obscurance.view;

    Outputs out;
    out.visibility = obscurance.visibility;
    out.bentNormals = obscurance.bentNormals;
    std::copy_n(obscurance.sides, 2, out.sides);
    out.depth = g.depth;
    out.linearDepth = obscurance.linearDepth;
    out.normals = g.geometric;
    out.motion = g.motion;
    out.voxels = in.voxels;
    out.layers = in.layers;
    if (!antialiases) impl.antialias.skip(graph);
    if (options.sampleStep && out.linearDepth) out.samples = impl.views.samples(graph, out, options.sampleStep, view);
    if (options.view == View::final || options.view == View::pass) {
        Lighting::Inputs lit;
        lit.gbuffer = g;
        lit.linearDepth = out.linearDepth;
        lit.visibility = out.visibility;
        if (options.bentNormals) lit.bentNormals = out.bentNormals;
        lit.view = view;
        lit.eyeFromWorld = camera.view;
        lit.sun = options.sun;
        lit.frame = frame;
        lit.items = items;
        lit.draws = &impl.draws;
        lit.posed = posed;
        ShadowRequest request{impl.actors.drawables(), -glm::normalize(options.sun.direction), options.camera.eye};
        request.forward = -glm::vec3(camera.view[0][2], camera.view[1][2], camera.view[2][2]);
        request.size = options.shadowSize;
        request.reach = options.shadowReach;
        request.skipMasked = options.skipMasked;
        lit.shadow = impl.shadow.add(graph, request, posed, impl.materials);
        if (lit.shadow.image && lit.linearDepth) {
            graph::ImageId radiance = impl.lighting.add(graph, lit, impl.materials);
            if (antialiases)
                radiance = impl.antialias.add(graph, {radiance, out.linearDepth, g.motion, view, camera, options.exposure, cut});
            out.color = impl.lighting.toneMap(graph, radiance, view, options.exposure);
        }
        if (options.view == View::pass) {
            const graph::ImageId shown = impl.views.addPass(graph, options.passView, view);
            if (shown) out.color = shown;
        }
    }
    if (isVoxels(options.view) && in.voxels)
        out.color = impl.views.voxels(
            graph, in.voxels, in.volume, options.view == View::voxelSlice ? &options.slice : nullptr, options.camera.eye, view);
    if (isDifference(options.view) && out.sides[1])
        out.color =
            impl.views.difference(graph, out.sides[0], out.sides[1], options.differenceRange, options.view == View::signedDifference);
    if (options.view == View::history || options.view == View::rejected) out.color = impl.views.addHistory(graph, options.view, view);
    if (options.view == View::bentNormals && out.bentNormals) out.color = impl.views.directions(graph, out.bentNormals, view);
    if (!out.color) out.color = impl.views.add(graph, options.view, g, in.layers, out.visibility, view);
    return out;
}

}  // namespace obscura::render
