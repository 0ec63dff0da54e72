// References of a shot: rendered (and cached) or read from a file.
#pragma once

#include "measure/shot.h"
#include "truth/cache.h"

namespace obscura::measure {

struct ShotReference {
    std::string kind;           // "world", "screen", or "FILE.exr:CHANNEL"
    std::string falloff;        // FalloffChoice::text
    std::string fileName;       // "world.quadratic_2"
    truth::Plane visibility;    // visible part
    float error = 0.0f;         // mean standard error of a pixel; 0 if read from a file
    float rays = 0.0f;          // mean rays per pixel; 0 if read from a file
    truth::BentReference bent;  // of world references, with RayChoice::bentNormals
};

struct References {
    std::vector<ShotReference> list;  // by kind, then falloff
    double seconds = 0.0;             // time of making or reading them
    bool fromCache = false;           // all rendered ones came from the cache
    std::vector<std::string> remarks;
};

// Throws app::Complaint or scene::Error.
References referencesOf(Machine& machine, const Shot& shot, const Measurement& what);

// Checks that the reference file can be read and has a channel for every falloff.
void expectReferenceFile(const Measurement& what);

}  // namespace obscura::measure
