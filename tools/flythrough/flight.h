// Flies: draws every frame of a flythrough with a method and measures what it showed, in space and in time.
#pragma once

#include "candidate.h"
#include "machine.h"
#include "part.h"
#include "script.h"
#include "truth/stability.h"

namespace obscura::flythrough {

bool hasHistory(const evaluate::Candidate& candidate);  // by its own values
const ao::Preset& ownFilter(const evaluate::Candidate& candidate);  // "temporal" where it has, else "spatial"
// The candidate resolved so (ao::resolvePresets()), but for a history that was asked for by name or that its preset has.
evaluate::Candidate filtered(const evaluate::Candidate& candidate, const ao::Preset& filter);

struct Settings {
    glm::uvec2 size{320, 180};
    float guard = 0.1f;
    uint32_t length = 64;                    // frames of the whole flythrough
    uint32_t first = 0, end = 64;            // those measured here
    uint32_t rays = 256, seed = 1;
    bool cache = true;
    std::optional<evaluate::FalloffChoice> falloff;  // instead of the script's
    std::filesystem::path out;               // pictures go to out/frames/NAME
    bool pictures = true;
    bool still = true;                       // static noise, too
};

// Flights have renderers of their own: several may stand side by side.
class Flight {
public:
    // Draws the frames' geometry and has their references traced (or fetched). Throws app::Complaint or scene::Error.
    Flight(evaluate::Machine& machine, const Script& script, const Settings& settings);
    // Identifies everything that determines a part's rows.
    std::string keyOf(const evaluate::Candidate& candidate, const ao::Preset& filter) const;
    Part measure(const evaluate::Candidate& candidate, const ao::Preset& filter);
    // A part that says who it is and has no rows yet.
    Part empty(const evaluate::Candidate& candidate, const ao::Preset& filter) const;
    void writeReferencePictures() const;     // out/frames/NAME.reference
    const Script& script() const { return m_stage.script(); }

private:
    struct Geometry {
        truth::CapturedFrame frame;
        std::vector<glm::vec2> motion;
        truth::Mask visible;                 // not sky
    };
    struct Drawn {
        truth::Plane visibility;
        std::vector<graph::PassTime> passes;
    };
    render::FrameOptions options(uint32_t frame) const;
    void draw();
    void trace();
    Drawn draw(const evaluate::Candidate& candidate, uint32_t frame, bool cut);
    // One beyond the last frame of the state that an event at `frame` brings about.
    uint32_t endOfState(uint32_t frame) const;

    evaluate::Machine& m_machine;
    Settings m_settings;
    Stage m_stage;
    std::unique_ptr<render::Renderer> m_renderer;
    evaluate::FalloffChoice m_falloff;
    std::vector<Geometry> m_geometry;        // by frame, from 0
    std::vector<truth::Traced> m_references; // by frame; empty before first - 1
    std::vector<std::string> m_framePasses;  // that draw the frame whatever the method
    std::vector<uint32_t> m_events;          // frames of events in [first, end)
};

}  // namespace obscura::flythrough
