#include "ao/library.h"

#include <cstring>

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

Library::Library(gpu::Device& device, const gpu::ShaderLibrary& shaders) : m_device(device), m_shaders(shaders), m_methods(registry().size()) {
    m_ready = Prepare::create(device, shaders, m_prepare) == Status::ok && Temporal::create(device, shaders, m_temporal) == Status::ok;
}

Library::~Library() = default;

bool Library::prepare(const MethodInfo& info) {
    if (!m_ready) return false;
    for (size_t i = 0; i < registry().size(); ++i) {
        if (registry()[i].info != &info) continue;
        if (!m_methods[i]) m_methods[i] = registry()[i].create(m_device, m_shaders);
        return m_methods[i] != nullptr;
    }
    return false;
}

bool Library::prepare(const Values& values) {
    if (!prepare(values.info())) return false;
    if (m_offScreen || !values.has("offscreen") || OffScreen(values.count("offscreen")) == OffScreen::off) return true;
    auto made = std::make_unique<OffScreenPass>();
    if (OffScreenPass::create(m_device, m_shaders, *made) != Status::ok) return false;
    m_offScreen = std::move(made);
    return true;
}

graph::ImageId Library::add(graph::Graph& graph, const Frame& frame, const Sources& sources, const Falloff& falloff, const Values& values,
                            Inputs* inputsOut) {
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
    if (!prepare(values)) return {};
    view.temporal = values.info().needs && values["temporal"] > 0.0f && sources.motion ? 1 : 0;
    if (m_last != &values.info() && !graph.rehearsal()) {
        reset();
        m_last = &values.info();
    }
    Inputs inputs = m_prepare.add(graph, frame, view, sources, falloff);
    if (sources.volume) inputs.volume = {sources.volume, graph.upload("volume", volume), frame.volume.structure};
    const LayerUse use = layersOf(values);
    if (use != LayerUse::none) inputs.layers.thickness = sources.layers.thickness;
    if (use > LayerUse::first && sources.layers.thickness) inputs.layers.second = sources.layers.second;
    previousFromEye(frame.eyeFromWorld, m_hasLast ? m_eyeFromWorld : frame.eyeFromWorld, inputs.previousFromEye);
    if (!graph.rehearsal()) {
        std::memcpy(m_eyeFromWorld, frame.eyeFromWorld, sizeof(m_eyeFromWorld));
        m_hasLast = true;
    }
    if (inputsOut) *inputsOut = inputs;
    graph::ImageId visibility;
    for (size_t i = 0; i < registry().size(); ++i) {
        if (registry()[i].info != &values.info()) continue;
        visibility = m_methods[i]->add(graph, inputs, values);
        const bool tracesItself = registry()[i].needs && (registry()[i].needs(values) & kVolume);
        if (visibility && m_offScreen && values.has("offscreen") && !tracesItself)
            visibility = m_offScreen->add(graph, inputs, visibility, m_methods[i]->blocking(inputs, values),
                                         {OffScreen(values.count("offscreen")), values.count("offscreen_rays"), values["offscreen_stride"]});
    }
    if (!visibility || !values.info().needs) return visibility;
    TemporalSettings temporal;
    temporal.history = values["temporal"];
    temporal.clip = values["temporal_clip"];
    return m_temporal.add(graph, inputs, visibility, temporal, "resolve.temporal");
}

void Library::reset() {
    m_hasLast = false;
    m_temporal.reset();
    for (auto& method : m_methods)
        if (method) method->reset();
}

}  // namespace obscura::ao
