// Depth layers behind the visible surface: its thickness, and the second layer with its thickness. They are computed from the first four
// hits of each view ray, front or back faces. Two ways to draw the hits: peeling (a geometry pass per hit, any device), or the ladder (one
// geometry pass that sorts hits by atomic maxima, on devices with fragmentStoresAndAtomics).
#pragma once

#include "render/gbuffer.h"
#include "render/renderer.h"

namespace obscura::render {

// Chooses the faster form on this device for two layers. The first frames alternate between the forms, which give the same images. After
// two timed frames of each, not counting its first (which compiles shaders), the faster form is kept.
class FormTrial {
public:
    LayerForm next(const graph::Timings& arrived);  // form of the frame being declared
    LayerForm chosen() const { return m_chosen; }   // best: undecided

private:
    static constexpr int kEach = 3, kMost = 24;  // timed frames of each form; after kMost frames without timestamps: the ladder
    LayerForm m_chosen = LayerForm::best;
    uint64_t m_seen = 0;
    int m_declared = 0, m_timed[2] = {};  // by form: peeling, ladder
    double m_least[2] = {1e30, 1e30};     // ms
};

class LayersPass {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, LayersPass& out);
    // Images as in ao::DepthLayers, guard band included; no second layer with LayerMode::first. For two layers both forms find three hits
    // behind the visible one and give the same images to the bit. For the first layer only, peeling finds one hit, so that a solid that
    // contains another one becomes a sheet; the ladder still finds three. LayerForm::best is peeling for the first layer, else the choice
    // of FormTrial. Without fragment writes the ladder is replaced by peeling.
    // `list` must stay valid until the graph has been executed.
    ao::LayerInputs add(graph::Graph& graph, const GBuffer& gbuffer, graph::BufferId frame, graph::BufferId items, const DrawList& list,
        const Deform::Posed& posed, Materials& materials, ao::LayerMode use, LayerForm form);

private:
    struct Pair {
        gpu::Program solid, masked;
    };
    static gpu::Status createPair(gpu::Device& device, const gpu::ShaderLibrary& shaders, const std::string& fragment,
        gpu::GraphicsState state, std::initializer_list<gpu::Constant> constants, Pair& out);
    void draw(graph::Pass& pass, Pair& programs, const DrawList& list, const Deform::Posed& posed, Materials& materials);

    bool m_canWrite = false;
    Pair m_peel, m_peelOn[2], m_ladder;  // m_peel: first layer only; m_peelOn: of three peels, the later ones [0] and the first [1]
    FormTrial m_trial;
    gpu::Program m_resolve;
};

}  // namespace obscura::render
