// The scripted actions of each toaster.
#pragma once

#include "meshkit/track.h"
#include "toasters/course.h"

#include <vector>

namespace obscura::toasters {

struct Hop {
    float start = 0.0f;
    float height = 0.0f;

    /// Time in the air under gravity.
    float duration() const;
};

struct Pop {
    float start = 0.0f;
    float flight = 0.0f;
};

/// What one toy does over the loop. Distances are along its course; a toy with direction -1
/// walks its course backwards, face first.
struct Script {
    Course course;
    float direction = 1.0f;
    kit::Track travel;
    kit::Track turn;
    std::vector<Hop> hops;
    std::vector<float> snaps;
    std::vector<float> bumps;
    std::vector<Pop> pops;
};

inline constexpr float kGravity = 9.81f;

/// Toys 0 and 1 play leapfrog, 2 and 3 run into each other, 4 goes round between them.
std::vector<Script> makeScripts();

}  // namespace obscura::toasters
