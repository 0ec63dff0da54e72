// Depth layers: what lies behind the visible surface. The first four hits of a view ray, whatever way they face, tell how
// thick what is seen is, and what comes next. Drawn by peeling (a pass for each hit, on any device) or by a ladder of atomic
// maxima (one pass, where fragment shaders may write).
#pragma once

#include "render/gbuffer.h"
#include "render/renderer.h"

namespace obscura::render {

// Which form is cheaper on this device, found by use: the first frames that want two surfaces are drawn by either in turns, as the same
// pictures, and when timestamps of each have arrived twice, first frames aside, which compile, the cheaper one stays.
class FormTrial {
public:
    LayerForm next(const graph::Timings& arrived);  // of the frame being declared
    LayerForm chosen() const { return m_chosen; }   // best: not yet

private:
    static constexpr int kEach = 3, kMost = 24;     // frames of each form; after so many without timestamps it is the ladder
    LayerForm m_chosen = LayerForm::best;
    uint64_t m_seen = 0;
    int m_declared = 0, m_timed[2] = {};            // by form: peeling, ladder
    double m_least[2] = {1e30, 1e30};               // ms
};

class LayersPass {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, LayersPass& out);
    // As ao::DepthLayers describes them, guard band included; no second one with LayerUse::first. Where two surfaces are asked for, both
    // forms find three hits and the same pictures to the bit. Where one is, peeling finds a single hit and takes what holds another solid
    // for a sheet; the ladder still finds three, and with them where that ends. LayerForm::best is peeling for one surface, else what a
    // trial on this device has found cheaper. Where fragments cannot write, the ladder is peeling.
    // `list` must stay until the graph has run.
    ao::LayerSources add(graph::Graph& graph, const GBuffer& gbuffer, graph::BufferId frame, graph::BufferId items, const DrawList& list,
                         const Deform::Posed& posed, Materials& materials, ao::LayerUse use, LayerForm form);

private:
    struct Pair { gpu::Program solid, masked; };
    static gpu::Status createPair(gpu::Device& device, const gpu::ShaderLibrary& shaders, const std::string& fragment, gpu::GraphicsState state,
                                  std::initializer_list<gpu::Constant> constants, Pair& out);
    void draw(graph::Pass& pass, Pair& programs, const DrawList& list, const Deform::Posed& posed, Materials& materials);

    bool m_canWrite = false;
    Pair m_peel, m_peelOn[2], m_ladder;  // on: of several, those behind a hit and the first
    FormTrial m_trial;
    gpu::Program m_resolve;
};

}  // namespace obscura::render
