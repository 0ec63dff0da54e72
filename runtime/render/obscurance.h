// Obscurance of a frame: the sample as a user of the library. Gives the G-buffer to the library, takes visibility back.
#pragma once

#include <memory>

#include "ao/library.h"
#include "render/draw_list.h"
#include "render/gbuffer.h"
#include "render/renderer.h"
#include "render/views.h"

namespace obscura::render {

class Obscurance {
public:
    Obscurance(gpu::Device& device, const gpu::ShaderLibrary& shaders) : m_device(device), m_shaders(shaders), m_library(device, shaders) {}

    ao::Library& library() { return m_library; }
    ao::Library& otherLibrary();  // of side B; created at first use
    void discardHistory();        // camera cut

    // What to render before add(): the optional inputs that the methods of both sides, or the view, read.
    static ao::LayerMode layersFor(const FrameOptions& options);
    static bool readsVolume(const FrameOptions& options);

    struct Inputs {
        VkExtent2D size{}, guard{};  // px; guard band: on each side
        CameraPair camera;
        uint64_t index = 0;                     // of the frame, since the last cut
        graph::ImageId depth, normals, motion;  // `size`; of the G-buffer
        ao::LayerInputs layers;                 // optional
        graph::BufferId voxels;                 // optional: bits of `volume`
        ao::Volume volume;
    };
    struct Result {
        graph::ImageId visibility;   // R16F, visible size: of the method, or of A and B on their sides of the divider
        graph::ImageId bentNormals;  // as Outputs::bentNormals
        graph::ImageId sides[2];     // visibility of A and of B alone; B only with FrameOptions::compare
        graph::ImageId linearDepth;  // R32F, `size`: what the library made of `depth`
        shared::View view;           // sizes and projection as shaders want them
    };
    Result add(graph::Graph& graph, const Inputs& inputs, const FrameOptions& options, Views& views);

private:
    gpu::Device& m_device;
    const gpu::ShaderLibrary& m_shaders;
    ao::Library m_library;
    std::unique_ptr<ao::Library> m_other;  // null until used
};

}  // namespace obscura::render
