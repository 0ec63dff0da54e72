// A run of frames with one candidate: visibility, times of its passes, memory.
#pragma once

#include "app/statistics.h"
#include "measure/shot.h"

namespace obscura::measure {

struct Drawing {
    truth::Plane visibility;
    std::vector<glm::vec3> bentNormals;  // eye space, 0 for sky; of candidates that ask for them
    std::vector<app::Series> passes;     // the method's own passes in the last timed frame; one value per frame since the pass first ran
    std::vector<double> own;             // per timed frame: sum of the method's own passes
    std::vector<double> rest;            // per timed frame: sum of the passes that draw the frame for every method
    uint64_t bytes = 0;                  // graph::Executor::frameBytes()
};
// Methods with a history are warmed up until it has converged. Throws app::Complaint if a value is not finite.
Drawing draw(Machine& machine, Shot& shot, const Candidate& candidate, const ao::Falloff& falloff, uint32_t warmUp, uint32_t frames);

// Visibility that Machine::run() has read back, R16F. Throws app::Complaint, which begins with `drawn`, if a value is not finite.
truth::Plane planeOf(const std::vector<std::byte>& halves, glm::uvec2 size, const std::string& drawn);

}  // namespace obscura::measure
