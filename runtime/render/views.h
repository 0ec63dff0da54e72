// Pictures of images that are no pictures: G-buffer channels, visibility, whatever a pass wrote.
#pragma once

#include "graph/graph.h"
#include "render/gbuffer.h"
#include "render/renderer.h"
#include "shared/view.h"

namespace obscura::render {

class Views {
public:
    static gpu::Status create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Views& out);
    // Any of kViews but final. Values mean: normals n/2 + 1/2; depth near bright, logarithmic; motion grey at rest;
    // visibility, roughness and metalness as they are (byte = 255 * value); colours sRGB-encoded; thickness logarithmic, 1 mm black,
    // 10 m white, open sheets blue, endless and nothing red.
    graph::ImageId add(graph::Graph& graph, View view, const GBuffer& gbuffer, const ao::LayerSources& layers, graph::ImageId visibility, const shared::View& frame);
    // What the pass of that name wrote first; none when no such pass has been added or its image cannot be shown.
    graph::ImageId addPass(graph::Graph& graph, const std::string& pass, const shared::View& frame);
    // What the temporal pass made of the past: frames that a pixel's history holds, logarithmic, white 63 of them; or, white, where the past was
    // refused or drawn in so far that it begins anew. None where no history is kept.
    graph::ImageId addHistory(graph::Graph& graph, View view, const shared::View& frame);
    // Of two sides' visibility, visible size: A left of the divider and B right of it, R16F; or their difference as a picture,
    // |A - B| / range as grey or A - B in the colours of post/false_colour.h (orange where A is lighter, blue where it is darker).
    graph::ImageId split(graph::Graph& graph, graph::ImageId a, graph::ImageId b, float divider);
    graph::ImageId difference(graph::Graph& graph, graph::ImageId a, graph::ImageId b, float range, bool withSign);
    // Outputs::samples of what the rest of `outputs` holds.
    graph::ImageId samples(graph::Graph& graph, const Outputs& outputs, uint32_t step, const shared::View& frame);
    // The volume as the camera sees its cells, or one layer of them as a map. Sizes as `frame` has them; `eye` in the world.
    graph::ImageId voxels(graph::Graph& graph, graph::BufferId bits, const ao::Volume& volume, const VoxelSlice* slice, const glm::vec3& eye, const shared::View& frame);

private:
    graph::ImageId show(graph::Graph& graph, graph::ImageId source, uint32_t mode, const shared::View& frame);
    gpu::Program m_float, m_uint, m_split, m_difference, m_samples;
    gpu::Program m_voxels[2];  // by the volume's structure; each made when it is first shown
    const gpu::ShaderLibrary* m_shaders = nullptr;
};

}  // namespace obscura::render
