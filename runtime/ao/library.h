// The library as the sample uses it: the same passes as record() runs, added to the sample's own graph so that each
// shows its own time. context.cpp is the other door and stands on this one.
#pragma once

#include <memory>
#include <vector>

#include "ao/method.h"
#include "ao/offscreen.h"
#include "ao/prepare.h"
#include "ao/resolve.h"

namespace obscura::ao {

class Library {
public:
    Library(gpu::Device& device, const gpu::ShaderLibrary& shaders);
    ~Library();

    bool ready() const { return m_ready; }  // false: a pipeline that all methods need could not be made; logged
    // Makes a method's pipelines; of values, also the off-screen pass's when these ask for it. False if any failed; logged.
    bool prepare(const MethodInfo& info);
    bool prepare(const Values& values);

    // Adds prepare and method passes; returns visibility, R16F, visible size; none, logged, when the frame makes no sense or
    // a pipeline cannot be made. A graph's rehearsal leaves no trace here. Values name the method. `inputs`, when given, receives what prepare made (linear depth).
    graph::ImageId add(graph::Graph& graph, const Frame& frame, const Sources& sources, const Falloff& falloff, const Values& values,
                       Inputs* inputs = nullptr);
    void reset();  // camera cut: histories are void

private:
    gpu::Device& m_device;
    const gpu::ShaderLibrary& m_shaders;
    Prepare m_prepare;
    std::unique_ptr<OffScreenPass> m_offScreen;          // null until values have asked for it
    Temporal m_temporal;
    std::vector<std::unique_ptr<Method>> m_methods;  // by registry order, null until made
    const MethodInfo* m_last = nullptr;
    float m_eyeFromWorld[16] = {};  // last frame's
    bool m_hasLast = false;
    bool m_ready = false;
};

}  // namespace obscura::ao
