#include "ao/library.h"

namespace obscura::ao {

Library::Library(gpu::Device& device, const gpu::ShaderLibrary& shaders) : m_device(device), m_shaders(shaders), m_methods(registry().size()) {
    m_ready = Prepare::create(device, shaders, m_prepare) == Status::ok;
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

bool Library::prepareAll() {
    bool all = true;
    for (const MethodEntry& entry : registry()) all &= prepare(*entry.info);
    return all;
}

graph::ImageId Library::add(graph::Graph& graph, const Frame& frame, const Sources& sources, const Falloff& falloff, const Values& values,
                            Inputs* inputsOut) {
    shared::View view;
    const char* reason = nullptr;
    if (viewOf(frame, view, reason) != Status::ok) {
        m_device.log(gpu::Severity::error, std::string("obscurance: ") + reason);
        return {};
    }
    if (!prepare(values.info())) return {};
    if (m_last != &values.info()) reset();
    m_last = &values.info();
    const Inputs inputs = m_prepare.add(graph, frame, view, sources, falloff);
    if (inputsOut) *inputsOut = inputs;
    for (size_t i = 0; i < registry().size(); ++i)
        if (registry()[i].info == &values.info()) return m_methods[i]->add(graph, inputs, values);
    return {};
}

void Library::reset() {
    for (auto& method : m_methods)
        if (method) method->reset();
}

}  // namespace obscura::ao
