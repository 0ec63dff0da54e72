// Renders the frames of a flythrough with a method and measures errors, flicker, noise and lag.
#pragma once

#include "chunk.h"
#include "measure/candidate.h"
#include "measure/machine.h"
#include "script.h"
#include "truth/stability.h"

namespace obscura::flythrough {

bool hasHistory(const measure::Candidate& candidate);              // its values have a history
const ao::Preset& ownFilter(const measure::Candidate& candidate);  // "temporal" if it has a history, else "spatial"
// The candidate with a resolve preset; a history length from a setting or from the candidate's preset is kept.
measure::Candidate filtered(const measure::Candidate& candidate, const ao::Preset& filter);

struct Settings {
    glm::uvec2 size{320, 180};
    float guard = 0.1f;
    uint32_t length = 64;          // frames of the whole flythrough
    uint32_t first = 0, end = 64;  // frames measured in this run
    uint32_t rays = 256, seed = 1;
    bool cache = true;
    std::optional<measure::FalloffChoice> falloff;  // replaces the script's
    std::filesystem::path out;                      // pictures go to out/frames/NAME
    bool pictures = true;
    bool still = true;  // measure static noise as well
};

// Each flight has its own renderer, so several can exist at once.
class Flight {
public:
    // Draws the frames' geometry and traces their references, or reads them from the cache. Throws app::Complaint or scene::Error.
    Flight(measure::Machine& machine, const Script& script, const Settings& settings);
    // Hash of everything that determines a chunk's rows.
    std::string keyOf(const measure::Candidate& candidate, const ao::Preset& filter) const;
    Chunk measure(const measure::Candidate& candidate, const ao::Preset& filter);
    // A chunk with its key and names, but without rows.
    Chunk empty(const measure::Candidate& candidate, const ao::Preset& filter) const;
    void writeReferencePictures() const;  // out/frames/NAME.reference
    const Script& script() const { return m_stage.script(); }
    bool showsSurface() const;  // a pixel of a measured frame is not sky

private:
    struct Geometry {
        truth::CapturedFrame frame;
        std::vector<glm::vec2> motion;
        truth::Mask visible;  // not sky
    };
    struct Drawn {
        truth::Plane visibility;
        std::vector<gpu::PassTime> passes;
    };
    render::FrameOptions options(uint32_t frame) const;
    void draw();
    void trace();
    Drawn draw(const measure::Candidate& candidate, uint32_t frame, bool cut);
    // End (exclusive) of the frames whose boxes are as the event at `frame` leaves them.
    uint32_t endOfState(uint32_t frame) const;

    measure::Machine& m_machine;
    Settings m_settings;
    Stage m_stage;
    std::unique_ptr<render::Renderer> m_renderer;
    measure::FalloffChoice m_falloff;
    std::vector<Geometry> m_geometry;         // by frame, from 0
    std::vector<truth::Traced> m_references;  // by frame; empty before first - 1
    std::vector<std::string> m_framePasses;   // passes that draw the frame for every method
    std::vector<uint32_t> m_events;           // frames of events in [first, end)
};

}  // namespace obscura::flythrough
