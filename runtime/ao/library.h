// The library as the sample uses it: adds the passes that record() runs to the caller's graph, where each shows its own time. The host API
// (context.h) is built on it.
#pragma once

#include <map>
#include <memory>
#include <utility>

#include "ao/controls.h"
#include "ao/method.h"
#include "ao/offscreen.h"
#include "ao/prepare.h"
#include "ao/reduction.h"
#include "ao/temporal.h"

namespace obscura::ao {

class Library {
public:
    Library(gpu::Device& device, const gpu::ShaderLibrary& shaders);
    ~Library();

    bool valid() const { return m_valid; }  // false: a pipeline that all methods need could not be made; logged
    // Makes a method's pipelines for a kind of falloff; of values, also the off-screen pass's when these ask for it. False if any failed;
    // logged.
    bool prepare(const MethodInfo& info, FalloffKind falloff);
    bool prepare(const Values& values, FalloffKind falloff);
    void trim(const Values& values, FalloffKind falloff);  // keeps only those, and histories of the views that have one
    uint64_t methodBytes() const;                          // device memory that methods allocated when they were made

    // Adds the passes of prepare and of the values' method. No visibility, logged: the frame is invalid, or a pipeline cannot be made.
    struct Added {
        graph::ImageId visibility;  // R16F, visible size
        Inputs inputs;              // what prepare made, linear depth among it
    };
    Added add(graph::Graph& graph, const Frame& frame, const Sources& sources, const Falloff& falloff, const Values& values);
    void discardHistory() {  // the next frames begin without: as Frame::cut
        for (auto& [index, recorded] : m_views) recorded.method = nullptr;
    }

private:
    // What the last recorded frame of a view left.
    struct Recorded {
        graph::History history;
        const MethodInfo* method = nullptr;  // null: there was none
        float eyeFromWorld[16] = {};
        float jitter[2] = {};
        shared::View view{};
    };
    Method* methodOf(const Values& values, FalloffKind falloff);  // made if need be; null: cannot be
    gpu::Device& m_device;
    const gpu::ShaderLibrary& m_shaders;
    Prepare m_prepare;
    Reduction m_reduction;
    Controls m_controls;
    std::map<FalloffKind, std::unique_ptr<OffScreenPass>> m_offScreen;  // those that values have asked for
    Temporal m_temporal;
    struct Made {
        std::unique_ptr<Method> method;  // null: could not be made
        uint64_t bytes = 0;              // of device memory
    };
    std::pair<size_t, FalloffKind> keyOf(const Values& values, FalloffKind falloff) const;
    std::map<std::pair<size_t, FalloffKind>, Made> m_methods;  // by registry order
    std::map<uint32_t, Recorded> m_views;                      // by Frame::view
    bool m_valid = false, m_warned = false;                    // warned: history without motion was logged
};

}  // namespace obscura::ao
