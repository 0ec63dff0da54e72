// What stands behind the API's Context. Private to ao.
#pragma once

#include <cstdio>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "ao/crop.h"
#include "ao/library.h"
#include "graph/executor.h"

namespace obscura::ao {

// The host's log, or stderr. Usable when no memory is left to compose a line.
struct HostLog {
    void (*log)(void* user, Severity severity, const char* line) = nullptr;
    void* user = nullptr;
    void operator()(const char* line) const {
        if (log) log(user, Severity::error, line);
        else std::fprintf(stderr, "%s\n", line);
    }
};

struct Context {
    HostLog log;
    VisibilityFormat format = VisibilityFormat::r16f;
    std::unique_ptr<gpu::Device> device;
    gpu::ShaderLibrary shaders;
    std::unique_ptr<graph::Graph> graph;
    std::unique_ptr<graph::Executor> executor;
    std::unique_ptr<Library> library;
    Crop crop;                        // for Frame::origin
    gpu::Program toR8;                // R16F to R8, for VisibilityFormat::r8
    std::vector<gpu::Image> outputs;  // a ring: the host may still read the last frames'
    std::vector<gpu::Image> bent;     // bent normals, as `outputs`
    uint32_t views = 1;
    VkExtent2D maxSize{};          // Frame::maxSize of the last frame, and of frames within it:
    graph::Capacity capacity;      // what the graph's images take
    VkExtent2D outputSize{};       // what the output takes
    std::optional<Values> values;  // of the method set
    Falloff falloff;
    std::vector<std::string> timedNames;
    std::vector<PassTime> timed;
};

// Logs the line as an error and returns the status: `return refuse(context, Status::invalid, "Frame::size is 0")`.
Status refuse(const Context& context, Status status, const std::string& line);

Status statusOf(gpu::Status status);

// Runs `work`, which returns a Status. No exception leaves the API: only the standard library throws here, when host memory is short.
template <class Work>
Status guarded(const HostLog& log, Work work) noexcept {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        log("obscura: out of host memory");
        return Status::outOfMemory;
    } catch (...) {
        log("obscura: an unknown exception; does a callback throw?");
        return Status::invalid;
    }
}

}  // namespace obscura::ao
