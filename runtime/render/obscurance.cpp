// The library in a renderer, from top to bottom: which inputs it wants, how a frame is described to it, where its passes stand in the
// frame, and what comes out. An engine does the same with record() of obscura/ao.h: the Frame is the same, images go into it as views
// instead of into ao::Sources, and the passes go into a command buffer. The sample adds them to its render graph, so that each pass shows
// its time.
//
//     G-buffer (depth, normals, motion), on demand depth layers and voxels  ->  add()  ->  lighting multiplies ambient light by visibility
#include "render/obscurance.h"

#include <algorithm>
#include <cstring>

namespace obscura::render {
// Part 1: what must be rendered beside depth, normals and motion, before add().
ao::LayerMode Obscurance::layersFor(const FrameOptions& options) {
    const bool shown = options.view == View::thickness || options.view == View::second || options.view == View::secondThickness;
    return std::max({ao::layerModeOf(*options.method), options.compare ? ao::layerModeOf(*options.compare) : ao::LayerMode::none,
        shown ? ao::LayerMode::second : ao::LayerMode::none});
}

bool Obscurance::readsVolume(const FrameOptions& options) {
    const uint32_t needs = ao::needs(*options.method) | (options.compare ? ao::needs(*options.compare) : 0);
    return (needs & ao::kVolume) || isVoxels(options.view);
}

namespace {

// Part 2: the frame as the library wants it described. Depth convention and field of view are read from the projection.
ao::Frame frameOf(const Obscurance::Inputs& in) {
    ao::Frame frame;
    frame.size = in.size;
    frame.guard = in.guard;
    static_assert(sizeof(frame.projection) == sizeof(in.camera.projection) && sizeof(frame.eyeFromWorld) == sizeof(in.camera.view));
    std::memcpy(frame.projection, &in.camera.projection, sizeof(frame.projection));
    std::memcpy(frame.eyeFromWorld, &in.camera.view, sizeof(frame.eyeFromWorld));
    frame.depthKind = ao::DepthKind::device;  // the depth buffer as it is
    frame.normalKind = ao::NormalKind::eye;
    frame.normalEncoding = ao::NormalEncoding::octahedral32;
    frame.index = in.index;  // rotates the samples of methods with `temporal`
    // The projection holds the jitter of temporal anti-aliasing, the motion vectors do not: the library is told how far the image is moved,
    // so that its own history stays on the surface.
    frame.jitter[0] = in.camera.jitter.x;
    frame.jitter[1] = in.camera.jitter.y;
    frame.volume = in.volume;
    return frame;
}

ao::Sources sourcesOf(const Obscurance::Inputs& in) {
    ao::Sources sources{in.depth, in.normals, in.motion};
    sources.packed = true;  // by shaders/shared/octahedral.glsl, which the library uses too
    sources.layers = in.layers;
    sources.volume = in.voxels;
    return sources;
}

}  // namespace

// Part 3: the passes. They follow the G-buffer and precede lighting. Sides A and B prepare their own inputs and have their own history, so
// the passes of one take the time that they take without the other.
Obscurance::Result Obscurance::add(graph::Graph& graph, const Inputs& inputs, const FrameOptions& options, Views& views) {
    const ao::Frame frame = frameOf(inputs);
    const ao::Sources sources = sourcesOf(inputs);
    const auto run = [&](ao::Library& library, ao::Values values) {
        const bool wantsBent = values.bentNormals || options.bentNormals || options.view == View::bentNormals;
        values.bentNormals = wantsBent && values.info().bentNormals;
        ao::Library::Added added = library.add(graph, frame, sources, options.falloff, values);
        // A method that cannot be made gives nothing, and the library has logged why: the frame goes on without obscurance. Lighting reads
        // the prepared depth, which method `none` has too.
        if (!added.visibility) added.visibility = ao::allOpen(graph, options.visible, "no visibility");
        if (!added.inputs.depth)
            added.inputs = library.add(graph, frame, sources, options.falloff, ao::Values(*ao::findMethod("none"))).inputs;
        return added;
    };

    Result result{};
    const char* reason = nullptr;
    ao::viewOf(frame, result.view, reason);
    if (!options.compare) {
        if (m_other) m_other->discardHistory();  // it would be outdated when used again
        const ao::Library::Added only = run(m_library, *options.method);
        result.visibility = result.sides[0] = only.visibility;
        result.bentNormals = only.bentNormals;
        result.linearDepth = only.inputs.depth;
        return result;
    }
    graph.prefix("A.");
    const ao::Library::Added left = run(m_library, *options.method);
    graph.prefix("B.");
    const ao::Library::Added right = run(otherLibrary(), *options.compare);
    graph.prefix("");
    result.sides[0] = left.visibility;
    result.sides[1] = right.visibility;
    result.visibility = views.split(graph, left.visibility, right.visibility, options.split);
    if (left.bentNormals && right.bentNormals) result.bentNormals = views.split(graph, left.bentNormals, right.bentNormals, options.split);
    result.linearDepth = left.inputs.depth;
    return result;
}

ao::Library& Obscurance::otherLibrary() {
    if (!m_other) m_other = std::make_unique<ao::Library>(m_device, m_shaders);
    return *m_other;
}

void Obscurance::discardHistory() {
    m_library.discardHistory();
    if (m_other) m_other->discardHistory();
}

}  // namespace obscura::render
