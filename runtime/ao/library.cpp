#include "ao/library.h"

#include <algorithm>
#include <array>

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
    m_valid = Prepare::create(device, shaders, m_prepare) == Status::ok && Temporal::create(device, shaders, m_temporal) == Status::ok;
}

Library::~Library() = default;

bool Library::prepare(const MethodInfo& info, FalloffKind falloff) { return methodOf(Values(info), falloff) != nullptr; }

Method* Library::methodOf(const Values& values, FalloffKind falloff) {
    if (!m_valid || values.index() == Values::kUnregistered) return nullptr;
    const MethodEntry& entry = registry()[values.index()];
    const auto create = values.bentNormals ? entry.createBent : entry.create;
    if (!create) {
        m_device.log(
            gpu::Severity::error, std::string("obscurance: ") + entry.info->id + " has no bent normals; " + bentNormalsFrom() + " do");
        return nullptr;
    }
    std::unique_ptr<Method>& method = m_methods[{values.index(), entry.perFalloff ? falloff : FalloffKind{}, values.bentNormals}];
    if (!method) method = create(m_device, m_shaders, falloff);
    return method.get();
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
    view.temporal = values.info().needs && values["temporal"] > 0.0f && sources.motion ? 1 : 0;
    const bool discard = frame.cut || m_last != &values.info();
    Inputs inputs = m_prepare.add(graph, frame, view, sources, falloff);
    if (sources.volume) inputs.volume = {sources.volume, graph.upload("volume", volume), frame.volume.structure, volume};
    const LayerMode use = layerModeOf(values);
    if (use != LayerMode::none) inputs.layers.thickness = sources.layers.thickness;
    if (use > LayerMode::first && sources.layers.thickness) inputs.layers.second = sources.layers.second;
    previousFromEye(frame.eyeFromWorld, discard ? frame.eyeFromWorld : m_eyeFromWorld, inputs.previousFromEye);
    for (int axis = 0; axis < 2; ++axis) inputs.motionOffset[axis] = m_jitter[axis] - frame.jitter[axis];
    graph.onRecorded([this, info = &values.info(), eye = std::to_array(frame.eyeFromWorld), jitter = std::to_array(frame.jitter)] {
        m_last = info;
        std::copy(eye.begin(), eye.end(), m_eyeFromWorld);
        std::copy(jitter.begin(), jitter.end(), m_jitter);
    });
    Method& method = *methodOf(values, falloff.kind);
    const MethodEntry& entry = registry()[values.index()];
    const MethodOutput drawn = method.add(graph, inputs, values);
    graph::ImageId visibility = drawn.visibility;
    const bool tracesItself = entry.needs && (entry.needs(values) & kVolume);
    if (visibility && values.has("offscreen") && OffScreen(values.count("offscreen")) != OffScreen::off && !tracesItself)
        visibility = m_offScreen.at(falloff.kind)
                         ->add(graph, inputs, visibility, method.blocking(inputs, values),
                             {OffScreen(values.count("offscreen")), values.count("offscreen_rays"), values["offscreen_stride"]});
    if (!visibility || !values.info().needs) return {visibility, inputs, {}};
    TemporalSettings temporal;
    temporal.history = values["temporal"];
    temporal.clip = values["temporal_clip"];
    visibility = m_temporal.add(graph, inputs, visibility, temporal, discard, "temporal");
    return {visibility, inputs, values.bentNormals ? m_bentNormals->add(graph, inputs, visibility, drawn.bentNormals) : graph::ImageId{}};
}

}  // namespace obscura::ao
