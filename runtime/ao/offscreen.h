// Occluders that the picture does not show, for every screen-space method: outside of it, and behind what it shows. The obscurance of
// the world splits by what a direction meets first, A = A_screen + B; the method has A_screen, rays through the frame's volume give B:
//     B = 1/N sum over cosine-distributed rays of rho(t) of those that end in a set cell
// A ray that comes to where the method takes the depth buffer for solid (Method::blocking) ends there and counts nothing: the method
// has counted that direction. Set cells on the surface shown are passed by. Where the method reads depth layers, what they show is solid
// from front to back and no farther: a hit behind the back is seen by nobody else, one on the back is no other thing.
// B is soft, so it is traced for a quarter of the pixels and upsampled; A = min(1, A_screen + B).
#pragma once

#include "ao/spans.h"
#include "ao/upsample.h"

namespace obscura::ao {

enum class OffScreen : uint32_t { off, offScreen, hidden };  // the last counts what stands unseen inside the picture too

struct OffScreenSettings {
    OffScreen what = OffScreen::off;
    uint32_t rays = 16;    // a pixel of the map
    float stride = 1.25f;  // cells a ray steps at most: conservative bits are one cell thick where a wall lies along the grid
};

class OffScreenPass {
public:
    static Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, OffScreenPass& out);
    // visibility: the method's, R16F, visible size; returns a new image of the same kind, less what B blocks. Without a volume it comes
    // back as it is, and one line is logged.
    graph::ImageId add(graph::Graph& graph, const Inputs& inputs, graph::ImageId visibility, const Blocking& blocking, const OffScreenSettings& settings);

private:
    gpu::Program m_trace[2], m_layered[2];  // by structure
    SpansPass m_spans;
    Upsample m_upsample;
    bool m_said = false;
};

}  // namespace obscura::ao
