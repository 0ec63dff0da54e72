// Depth layers: what lies behind the visible surface. The first four hits of a view ray, whatever way they face, tell how
// thick what is seen is, and what comes next. Drawn by peeling (a pass for each hit, on any device) or by a ladder of atomic
// maxima (one pass, where fragment shaders may write).
#pragma once

#include "render/gbuffer.h"
#include "render/renderer.h"

namespace obscura::render {

class LayersPass {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, LayersPass& out);
    // As ao::DepthLayers describes them, guard band included; no second one with LayerUse::first. Peeling then finds a single hit, to
    // which solids within solids are sheets; the ladder always finds three. LayerForm::best is peeling then, else the ladder. Where fragments
    // cannot write, the ladder is peeling.
    // `list` must stay until the graph has run.
    ao::LayerSources add(graph::Graph& graph, const GBuffer& gbuffer, graph::BufferId frame, graph::BufferId items, const DrawList& list,
                         const Deform::Posed& posed, Materials& materials, ao::LayerUse use, LayerForm form);

private:
    struct Pair { gpu::Program solid, masked; };
    void draw(graph::Pass& pass, Pair& programs, const DrawList& list, const Deform::Posed& posed, Materials& materials);

    bool m_canWrite = false;
    Pair m_peel, m_ladder;
    gpu::Program m_resolve;
};

}  // namespace obscura::render
