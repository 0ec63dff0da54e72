// The library as the sample uses it: adds the passes that record() runs to the caller's graph, where each shows its own time. The host API
// (context.h) is built on it.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "ao/bent_normals.h"
#include "ao/controls.h"
#include "ao/method.h"
#include "ao/offscreen.h"
#include "ao/prepare.h"
#include "ao/reduction.h"
#include "ao/temporal.h"

namespace obscura::ao {

std::string bentNormalsFrom();  // the methods that give bent normals: "gtao, layered"

class Library {
public:
    Library(gpu::Device& device, const gpu::ShaderLibrary& shaders);
    ~Library();

    bool valid() const { return m_valid; }  // false: a pipeline that all methods need could not be made; logged
    // Makes a method's pipelines for a kind of falloff; of values, also the off-screen pass's and those of bent normals when these ask for
    // them. False if any failed, or if the method has no bent normals; logged.
    bool prepare(const MethodInfo& info, FalloffKind falloff);
    bool prepare(const Values& values, FalloffKind falloff);
    void trim(const Values& values, FalloffKind falloff);  // keeps only those, and histories of the views that have one
    uint64_t methodBytes() const;                          // device memory that methods allocated when they were made

    // Adds the passes of prepare and of the values' method. No visibility, logged: the frame is invalid, or a pipeline cannot be made.
    struct Added {
        graph::ImageId visibility;   // R16F, visible size
        Inputs inputs;               // what prepare made, linear depth among it
        graph::ImageId bentNormals;  // R8G8B8A8_SNORM, visible size, as Output::bentNormals; with Values::bentNormals
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
    std::unique_ptr<BentNormals> m_bentNormals;  // once values have asked for it
    struct Made {
        std::unique_ptr<Method> method;  // null: could not be made
        uint64_t bytes = 0;              // of device memory
    };
    using Key = std::tuple<size_t, FalloffKind, bool>;  // registry order, falloff, whether bent normals are given
    Key keyOf(const Values& values, FalloffKind falloff) const;
    std::map<Key, Made> m_methods;
    std::map<uint32_t, Recorded> m_views;    // by Frame::view
    bool m_valid = false, m_warned = false;  // warned: history without motion was logged
};

}  // namespace obscura::ao
