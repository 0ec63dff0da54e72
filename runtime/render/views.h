// Debug views: converts G-buffer channels, visibility, or the output of any pass to displayable images.
#pragma once

#include "graph/graph.h"
#include "render/gbuffer.h"
#include "render/renderer.h"
#include "shared/view.h"

namespace obscura::render {

class Views {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Views& out);
    // Any of kViews but final. Normals: n/2 + 1/2. Depth: logarithmic, near is bright. Motion: grey at 0. Visibility, roughness, metalness:
    // byte = 255 * value. Colours: sRGB-encoded. Thickness: logarithmic, 1 mm black, 10 m white, open sheets blue, endless and sky red.
    graph::ImageId add(graph::Graph& graph, View view, const GBuffer& gbuffer, const ao::LayerInputs& layers, graph::ImageId visibility,
        const shared::View& frame);
    // The first image that the pass of that name writes; none if there is no such pass or the image cannot be shown.
    graph::ImageId addPass(graph::Graph& graph, const std::string& pass, const shared::View& frame);
    // History of the temporal pass. View::history: accumulated frames per pixel, logarithmic, white at 63. View::rejected: white where
    // history was rejected, or clamped so far that accumulation starts again. None without a history.
    graph::ImageId addHistory(graph::Graph& graph, View view, const shared::View& frame);
    // Directions d of length 1 or 0, signed, visible size: d/2 + 1/2.
    graph::ImageId directions(graph::Graph& graph, graph::ImageId image, const shared::View& frame);
    // Of A's and B's visibility, visible size. split(): A left of the divider, B right of it, of A's format; also of bent normals.
    // difference(): |A - B| / range as grey, or A - B in the colours of post/false_colour.h (orange where A is lighter, blue where it is
    // darker).
    graph::ImageId split(graph::Graph& graph, graph::ImageId a, graph::ImageId b, float divider);
    graph::ImageId difference(graph::Graph& graph, graph::ImageId a, graph::ImageId b, float range, bool withSign);
    // Outputs::samples, from the other images of `outputs`.
    graph::ImageId samples(graph::Graph& graph, const Outputs& outputs, uint32_t step, const shared::View& frame);
    // The volume's cells seen from the camera, or, with `slice`, a map of one layer of cells. `eye`: camera position, world space.
    graph::ImageId voxels(graph::Graph& graph, graph::BufferId bits, const ao::Volume& volume, const VoxelSlice* slice,
        const glm::vec3& eye, const shared::View& frame);

private:
    graph::ImageId show(graph::Graph& graph, graph::ImageId source, uint32_t mode, const shared::View& frame);
    gpu::Program m_float, m_uint, m_split[2], m_difference, m_samples;  // m_split: of visibility, of bent normals
    gpu::Program m_voxels[2];                                           // by the volume's structure; created at first use
    const gpu::ShaderLibrary* m_shaders = nullptr;
};

}  // namespace obscura::render
