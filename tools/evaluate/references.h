// The references a shot is held against: rendered (and kept in the cache) or read from a file.
#pragma once

#include "shot.h"
#include "truth/cache.h"

namespace obscura::evaluate {

struct JudgedBy {
    std::string kind;            // "world", "screen", or "FILE.exr:CHANNEL"
    std::string falloff;         // FalloffChoice::text
    std::string fileName;        // "world.quadratic_2"
    truth::Plane visibility;     // visible part
    float error = 0.0f;          // mean standard error of a pixel; 0 when read from a file
    float rays = 0.0f;           // mean rays a pixel; 0 when read from a file
};

struct References {
    std::vector<JudgedBy> list;  // by kind, then falloff
    double seconds = 0.0;        // making or reading them
    bool fromCache = false;      // all that were rendered
    std::vector<std::string> remarks;
};

// Throws app::Complaint or scene::Error.
References referencesOf(Machine& machine, const Shot& shot, const Options& options);

// A reference file can be read and has a channel for every falloff: judged before anything is drawn.
void expectReferenceFile(const Options& options);

}  // namespace obscura::evaluate
