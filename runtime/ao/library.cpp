#include "ao/library.h"

#include <algorithm>
#include <array>
#include <utility>

namespace obscura::ao {
namespace {

// previous * now^-1 of two rigid transforms given by columns, as three rows. In double: worlds are large, steps are small.
void previousFromEye(const float now[16], const float previous[16], float rows[12]) {
    for (int r = 0; r < 3; ++r) {
        double translation = previous[12 + r];
        for (int c = 0; c < 3; ++c) {
            double turned = 0.0;
            for (int k = 0; k < 3; ++k) turned += double(previous[4 * k + r]) * double(now[4 * k + c]);
            rows[4 * r + c] = float(turned);
            translation -= turned * double(now[12 + c]);
        }
        rows[4 * r + 3] = float(translation);
    }
}

}  // namespace

std::string bentNormalsFrom() {
    std::string ids;
    for (const MethodInfo* info : methods())
        if (info->bentNormals) ids += (ids.empty() ? "" : ", ") + std::string(info->id);
    return ids;
}

Library::Library(gpu::Device& device, const gpu::ShaderLibrary& shaders) : m_device(device), m_shaders(shaders) {
    m_valid = Prepare::create(device, shaders, m_prepare) == Status::ok && Temporal::create(device, shaders, m_temporal) == Status::ok &&
              Reduction::create(device, shaders, m_reduction) == Status::ok && Controls::create(device, shaders, m_controls) == Status::ok;
}

Library::~Library() = default;

bool Library::prepare(const MethodInfo& info, FalloffKind falloff) { return methodOf(Values(info), falloff) != nullptr; }

Library::Key Library::keyOf(const Values& values, FalloffKind falloff) const {
    return {values.index(), registry()[values.index()].perFalloff ? falloff : FalloffKind{}, values.bentNormals};
}

Method* Library::methodOf(const Values& values, FalloffKind falloff) {
    if (!m_valid || values.index() == Values::kUnregistered) return nullptr;
    const MethodEntry& entry = registry()[values.index()];
    const auto create = values.bentNormals ? entry.createBent : entry.create;
    if (!create) {
        m_device.log(
            gpu::Severity::error, std::string("obscurance: ") + entry.info->id + " has no bent normals; " + bentNormalsFrom() + " do");
        return nullptr;
    }
    Made& made = m_methods[keyOf(values, falloff)];
    const uint64_t before = m_device.memoryUse();
    if (!made.method) {
        made.method = create(m_device, m_shaders, falloff);
        made.bytes = m_device.memoryUse() - before;
    }
    return made.method.get();
}

void Library::trim(const Values& values, FalloffKind falloff) {
    std::erase_if(m_methods, [key = keyOf(values, falloff)](const auto& made) { return made.first != key; });
    std::erase_if(m_offScreen, [falloff](const auto& made) { return made.first != falloff; });
    std::erase_if(m_views, [](const auto& view) { return !view.second.history.valid(); });
}

uint64_t Library::methodBytes() const {
    uint64_t bytes = 0;
    for (const auto& [key, made] : m_methods) bytes += made.bytes;
    return bytes;
}

bool Library::prepare(const Values& values, FalloffKind falloff) {
    if (!methodOf(values, falloff)) return false;
    if (values.bentNormals && !m_bentNormals) {
        auto made = std::make_unique<BentNormals>();
        if (BentNormals::create(m_device, m_shaders, *made) != Status::ok) return false;
        m_bentNormals = std::move(made);
    }
    if (!values.has("offscreen") || OffScreen(values.count("offscreen")) == OffScreen::off || m_offScreen.contains(falloff)) return true;
    auto made = std::make_unique<OffScreenPass>();
    if (OffScreenPass::create(m_device, m_shaders, falloff, *made) != Status::ok) return false;
    m_offScreen[falloff] = std::move(made);
    return true;
}

Library::Added Library::add(graph::Graph& graph, const Frame& frame, const Sources& sources, const Falloff& falloff, const Values& values) {
    shared::View view;
    const char* reason = nullptr;
    if (viewOf(frame, view, reason) != Status::ok) {
        m_device.log(gpu::Severity::error, std::string("obscurance: ") + reason);
        return {};
    }
    shared::Volume volume;
    if (sources.volume && volumeOf(frame.volume, volume, reason) != Status::ok) {
        m_device.log(gpu::Severity::error, std::string("obscurance: ") + reason);
        return {};
    }
    if (!prepare(values, falloff.kind)) return {};
    view.temporal = values.info().needs && values["temporal"] > 0.0f ? 1 : 0;
    Recorded& last = m_views[frame.view];
    const bool discard = frame.cut || last.method != &values.info() || last.view.orthographic != view.orthographic;
    Inputs inputs = m_prepare.add(graph, frame, view, sources, falloff);
    if (sources.volume) inputs.volume = {sources.volume, graph.upload("volume", volume), frame.volume.structure, volume};
    const LayerMode use = layerModeOf(values);
    if (use != LayerMode::none) inputs.layers.thickness = sources.layers.thickness;
    if (use > LayerMode::first && sources.layers.thickness) inputs.layers.second = sources.layers.second;
    inputs.previousView = discard ? view : last.view;
    previousFromEye(frame.eyeFromWorld, discard ? frame.eyeFromWorld : last.eyeFromWorld, inputs.previousFromEye);
    std::copy_n(frame.jitter, 2, inputs.jitter);
    std::copy_n(discard ? frame.jitter : last.jitter, 2, inputs.previousJitter);
    graph.onRecorded([&last, view, method = &values.info(), eye = std::to_array(frame.eyeFromWorld), jitter = std::to_array(frame.jitter)] {
        last.method = method;
        last.view = view;
        std::copy(eye.begin(), eye.end(), last.eyeFromWorld);
        std::copy(jitter.begin(), jitter.end(), last.jitter);
    });
    if (view.temporal && !sources.motion && !std::exchange(m_warned, true))
        m_device.log(gpu::Severity::warning,
            "obscurance: parameter `temporal` without Frame::motion: history follows the camera (Frame::eyeFromWorld), "
            "and surfaces that move by themselves keep none");
    Method& method = *methodOf(values, falloff.kind);
    const MethodEntry& entry = registry()[values.index()];
    const uint32_t scale = values.info().needs ? 1u << values.count("scale") : 1;
    const Inputs reduced = scale > 1 ? m_reduction.reduce(m_device, m_shaders, graph, inputs, scale) : inputs;
    if (!reduced.depth) return {};
    const MethodOutput drawn = method.add(graph, reduced, values);
    graph::ImageId visibility = drawn.visibility;
    const bool tracesItself = entry.needs && (entry.needs(values) & kVolume);
    if (visibility && values.has("offscreen") && OffScreen(values.count("offscreen")) != OffScreen::off && !tracesItself)
        visibility = m_offScreen.at(falloff.kind)
                         ->add(graph, reduced, visibility, method.blocking(reduced, values),
                             {OffScreen(values.count("offscreen")), values.count("offscreen_rays"), values["offscreen_stride"]});
    if (!visibility || !values.info().needs) return {visibility, inputs, {}};
    if (scale > 1) visibility = m_reduction.enlarge(graph, inputs, reduced, scale, visibility);
    TemporalSettings temporal;
    temporal.history = values["temporal"];
    temporal.clip = values["temporal_clip"];
    visibility = m_temporal.add(graph, inputs, visibility, temporal, last.history, discard, "temporal");
    ControlSettings controls{values["intensity"], values["power"], values["floor"], values["fade_from"], values["fade_to"]};
    if (entry.appliesPower) controls.power = 1.0f, controls.floor = 0.0f;
    visibility = m_controls.add(graph, inputs, visibility, controls);
    return {visibility, inputs,
        values.bentNormals ? m_bentNormals->add(graph, inputs, visibility, drawn.bentNormals, scale) : graph::ImageId{}};
}

}  // namespace obscura::ao
