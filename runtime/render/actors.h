// State of the world's instances in this and the last frame, by Instance::id: poses, matrices, bounds, and ranges of the posed buffers.
#pragma once

#include <functional>
#include <map>
#include <span>

#include "render/model_gpu.h"
#include "scene/frame.h"
#include "scene/world.h"

namespace obscura::render {

inline constexpr uint32_t kNotPosed = ~0u;

// One primitive of one instance.
struct Drawable {
    const ModelGpu* model = nullptr;
    const PrimitiveGpu* primitive = nullptr;
    glm::mat4 world{1.0f}, previousWorld{1.0f};  // object -> world; skinned: model -> world
    scene::Bounds bounds;                        // world, conservative if deformed
    uint32_t posed = kNotPosed;                  // first vertex in the posed buffers
    bool fresh = false;                          // new, or after a cut: its previous positions are the current ones
    bool still = false;                          // has not moved since last frame
    bool settled = false;                        // rigid and not animated, or without motion for 600 frames
    bool flipped = false;                        // negative determinant: winding is reversed
    uint64_t version = 0;                        // changes with the deformed shape
};

// Allocator of vertex ranges in the posed buffers.
class Ranges {
public:
    uint32_t take(uint32_t count);  // may grow capacity()
    void give(uint32_t first, uint32_t count);
    uint32_t capacity() const { return m_capacity; }

private:
    struct Free {
        uint32_t first, count;
    };
    std::vector<Free> m_free;  // sorted, never adjacent
    uint32_t m_capacity = 0;
};

class Actors {
public:
    using FindModel = std::function<const ModelGpu*(const scene::Model*)>;
    // `cut`: last frame is ignored.
    void update(const scene::World& world, float time, bool cut, const FindModel& find);

    std::span<const Drawable> drawables() const { return m_drawables; }

    // Primitives to deform this frame, for scene/deform.comp.
    struct Job {
        shared::DeformJob job;
        const ModelGpu* model;
    };
    std::span<const Job> jobs() const { return m_jobs; }
    std::span<const glm::vec4> joints() const { return m_joints; }  // three rows per matrix
    std::span<const shared::ActiveWeight> weights() const { return m_weights; }
    uint32_t posedCapacity() const { return m_ranges.capacity(); }  // vertices

private:
    struct PrimitiveState {
        int node = -1;
        const PrimitiveGpu* primitive = nullptr;
        bool skinned = false;
        uint32_t posed = kNotPosed;
        uint32_t vertices = 0;  // of the posed range: the model may have been destroyed when the range is freed
        glm::mat4 world{1.0f};  // of the last update
        uint32_t rested = 0;    // frames without motion
    };
    struct Actor {
        std::shared_ptr<const scene::Model> model;
        int root = -1, animation = 0;
        float time = 0.0f;
        bool fresh = true;
        scene::Pose pose;
        glm::mat4 placement{1.0f};
        uint32_t unchanged = 0;  // consecutive frames with the same pose
        uint64_t version = 0;
        std::vector<PrimitiveState> states;
        bool seen = false;
    };
    void rebuild(Actor& actor, const scene::Instance& instance, const ModelGpu& model);
    void release(Actor& actor);
    void addJobs(const Actor& actor, const ModelGpu& model, const std::map<int, uint32_t>& skins);

    std::map<uint32_t, Actor> m_actors;
    Ranges m_ranges;
    uint64_t m_versions = 0;
    std::vector<Drawable> m_drawables;
    std::vector<Job> m_jobs;
    std::vector<glm::vec4> m_joints;
    std::vector<shared::ActiveWeight> m_weights;
};

}  // namespace obscura::render
