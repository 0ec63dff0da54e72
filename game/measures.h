// Error, noise and flicker of the picture while the game runs: metrics of runtime/truth over every n-th pixel of each frame, read back
// without stalling and computed on a worker thread.
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

// Step from one measured pixel to the next, px. Odd, so that a measured pixel is the centre of its block and has the view ray of a pixel in
// a picture smaller by this factor. The smallest step that divides both sides and leaves at most 256 x 256 pixels; if none divides both,
// the smallest that leaves at most so many.
uint32_t measuredStep(VkExtent2D size);

class Measures {
public:
    // `maxPending`: frames that may wait for the worker; further ones are skipped. 0: no limit.
    explicit Measures(size_t maxPending);
    ~Measures();

    struct Frame {
        uint64_t number = 0;  // consecutive numbers are consecutive frames
        scene::Camera camera;
        VkExtent2D visible{};  // px, without guard band
        uint32_t step = 1;
        float time = 0.0f;  // s, of the world
        bool cut = false;
        bool animated = true;           // the world has animations
        size_t instances = 0;           // in the world
        std::vector<ao::Values> sides;  // A, or A and B
        std::string falloff;
        std::string viewKey;  // cache key of the matching reference; empty: none can match
    };
    // `texels` as render::Outputs::samples. Any thread but the worker's.
    void add(Frame frame, std::span<const std::byte> texels);

    // Metrics of one side in one frame. Differences are to the previous frame.
    struct Side {
        std::optional<float> change;                      // D_A
        std::optional<truth::Errors> errors;              // needs a reference of this frame
        std::optional<float> excess, flickerOfError;      // F, F_e; need references of this and the previous frame
        std::optional<truth::StaticNoise::Result> noise;  // over `stillFrames`
    };
    struct Reading {
        uint64_t number = 0;
        float time = 0.0f;
        glm::uvec2 size{0};
        uint32_t step = 1;
        std::vector<Side> sides;
        float rays = 0.0f;       // per pixel of the reference; 0: no reference
        size_t stillFrames = 0;  // frames in `noise`, after kSettling; before, `settling` counts them
        size_t settling = 0;
        float share = 0.0f;         // fraction of surface pixels found in the previous frame
        double milliseconds = 0.0;  // time of this measurement
        std::string problem;        // one line if the measurement failed
    };
    static constexpr size_t kSettling = 32;  // still frames before noise is measured, as in obscura-flythrough
    static constexpr size_t kMeans = 32;     // readings that means() averages

    // The newest reading; its differences are averaged over the last kMeans readings with unchanged settings. Empty before the first.
    std::optional<Reading> means() const;
    std::vector<Reading> all() const;  // oldest first; with maxPending above 0 the last 600 only
    size_t leftOut() const;            // frames skipped because the worker was busy
    void finish();                     // waits until all added frames are measured

private:
    struct Job {
        Frame frame;
        std::vector<uint32_t> texels;
    };
    struct Previous;
    void work();
    Reading measure(const Job& job, Previous& previous) const;
    const size_t m_maxPending;
    truth::ReferenceCache m_cache;
    mutable std::mutex m_mutex;
    std::condition_variable m_changed;
    std::deque<Job> m_jobs;
    std::deque<Reading> m_readings;
    size_t m_sameSettings = 0;  // number of newest readings with the same settings
    size_t m_leftOut = 0;
    bool m_busy = false, m_end = false;
    std::thread m_worker;  // last member: the thread uses all others
};

// Describes a frame for the worker.
Measures::Frame measuredFrame(const render::FrameOptions& frame, const scene::World& world, uint64_t number);
// Reads the frame's samples back and passes them to `measures` when they arrive, if it still exists.
gpu::Status readInto(const std::shared_ptr<Measures>& measures, app::Capture& capture, graph::Graph& graph, const render::Outputs& outputs,
    Measures::Frame frame);

// Readings as CSV, one row per frame and side; their means as a text table.
std::string csv(const std::vector<Measures::Reading>& readings);
std::string summary(const std::vector<Measures::Reading>& readings);

}  // namespace obscura::game
