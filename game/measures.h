// How wrong and how restless the picture is while it is played: numbers of runtime/truth over every few pixels of the frame, read
// back without waiting and worked out beside the game.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "app/capture.h"
#include "render/renderer.h"
#include "truth/cache.h"
#include "truth/stability.h"

namespace obscura::game {

// Every how many pixels of a picture are measured: odd, so that a measured pixel is the middle one of its block and looks where the
// pixel of a picture that many times smaller does. The least that divides both sides and leaves at most 256 x 256 pixels;
// without one, the least that leaves so few.
uint32_t measuredStep(VkExtent2D size);

class Measures {
public:
    // `most`: frames that may wait for the worker before some are left out; 0: any number.
    explicit Measures(size_t most);
    ~Measures();

    struct Frame {
        uint64_t number = 0;       // counts up by one from frame to frame; a gap parts them
        scene::Camera camera;
        VkExtent2D visible{};      // px, without guard band
        uint32_t step = 1;
        float time = 0.0f;         // s, of the world
        bool cut = false;
        bool animated = true;      // does anything in the world move by itself?
        size_t instances = 0;      // in it
        std::vector<ao::Values> sides;  // A, or A and B
        std::string falloff;
        std::string viewKey;       // of the reference that would fit
    };
    // `texels` as render::Outputs::samples. Any thread but the worker's.
    void add(Frame frame, std::span<const std::byte> texels);

    // Of one frame, of one side. Differences are to the frame before.
    struct Side {
        std::optional<float> change;                                 // D_A
        std::optional<truth::Errors> errors;                         // against the reference, and so the following
        std::optional<float> excess, flickerOfError;                 // F, F_e
        std::optional<truth::StaticNoise::Result> noise;             // over `stillFrames`
    };
    struct Reading {
        uint64_t number = 0;
        float time = 0.0f;
        glm::uvec2 size{0};
        uint32_t step = 1;
        std::vector<Side> sides;
        float rays = 0.0f;         // a pixel of the reference; 0: there is none
        size_t stillFrames = 0;    // that count for noise, after kSettling; until then `settling` counts
        size_t settling = 0;
        float share = 0.0f;        // of surfaces that could be followed to the frame before
        double milliseconds = 0.0; // that this took
        std::string problem;       // one line, when it failed
    };
    static constexpr size_t kSettling = 32;  // still frames before noise counts, as obscura-flythrough waits
    static constexpr size_t kMeans = 32;     // readings that means() is over

    // The newest reading, with the means over the last kMeans of what has changed no setting since; nothing at first.
    std::optional<Reading> means() const;
    std::vector<Reading> all() const;        // since the last start, oldest first; the last 600 where frames may be left out
    size_t leftOut() const;                  // frames the worker had no time for
    void finish();                           // waits for what was added

private:
    struct Job {
        Frame frame;
        std::vector<uint32_t> texels;
    };
    struct Past;
    void work();
    Reading measure(const Job& job, Past& past) const;
    const size_t m_most;
    truth::ReferenceCache m_cache;
    mutable std::mutex m_mutex;
    std::condition_variable m_changed;
    std::deque<Job> m_jobs;
    std::deque<Reading> m_readings;
    size_t m_sameSettings = 0;  // of the newest readings
    size_t m_leftOut = 0;
    bool m_busy = false, m_end = false;
    std::thread m_worker;       // last: it uses all of the above
};

// What the worker needs to know of a frame that is about to be added to a graph.
Measures::Frame measuredFrame(const render::FrameOptions& frame, const scene::World& world, uint64_t number);
// Has the frame's samples read back and handed to `measures` when they have arrived, if it is still there.
gpu::Status readInto(const std::shared_ptr<Measures>& measures, app::Capture& capture, graph::Graph& graph, const render::Outputs& outputs, Measures::Frame frame);

// Tables of readings: a row a frame and side; and their means, as text.
std::string csv(const std::vector<Measures::Reading>& readings);
std::string summary(const std::vector<Measures::Reading>& readings);

}  // namespace obscura::game
