// Off-screen pass: adds occluders from the frame's volume that are outside the image, or hidden in it, to any screen-space method.
// Obscurance splits by the first occluder in each direction, A = A_screen + B. The method computes A_screen; rays through the volume give
//     B = 1/N sum over cosine-distributed rays of rho(t) of those that end in a set cell
// A ray ends and counts 0 where the method treats the depth buffer as solid (Method::blocking), because the method has counted that
// direction. Set cells on the visible surface are skipped. If the method reads depth layers, a layer is solid from its front to its back:
// a hit behind the back counts, one within a cell of the back is that layer's own surface.
// B varies slowly, so it is traced for a quarter of the pixels and upsampled; A = min(1, A_screen + B).
#pragma once

#include "ao/layer_pass.h"
#include "ao/upsample.h"

namespace obscura::ao {

enum class OffScreen : uint32_t { off, offScreen, hidden };  // hidden: also occluders inside the image behind visible surfaces

struct OffScreenSettings {
    OffScreen what = OffScreen::off;
    uint32_t rays = 16;    // per pixel of the map
    float stride = 1.25f;  // longest ray step, cells; a wall parallel to the grid is one cell thick
};

class OffScreenPass {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffKind falloff, OffScreenPass& out);
    // visibility: the method's, R16F, visible size. Returns a new image of the same kind with B subtracted. Without a volume: returns
    // `visibility` and logs one warning.
    graph::ImageId add(
        graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const Blocking& blocking, const OffScreenSettings& settings);

private:
    gpu::Program m_trace[2], m_layered[2];  // by VolumeStructure
    LayerPass m_layerPass;
    Upsample m_upsample;
    bool m_warned = false;
};

}  // namespace obscura::ao
