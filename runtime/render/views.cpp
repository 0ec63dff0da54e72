#include "render/views.h"

#include <algorithm>
#include <cmath>

#include "post/view.h"

namespace obscura::render {
namespace {

constexpr const char* kNames[] = {"final", "visibility", "normals", "shaded-normals", "bent-normals", "depth", "motion", "base-color",
    "roughness", "metalness", "emission", "thickness", "second", "second-thickness", "voxels", "voxel-slice", "difference",
    "signed-difference", "history", "rejected", "pass"};

// The display mode of a pass's image, from its format and name.
uint32_t modeOf(VkFormat format, const std::string& name) {
    switch (format) {
        case VK_FORMAT_D32_SFLOAT: return name.find("shadow") != std::string::npos ? shared::kViewGrey : shared::kViewDeviceDepth;
        case VK_FORMAT_R32_UINT: return name.find("normal") != std::string::npos ? shared::kViewNormal : shared::kViewInteger;
        case VK_FORMAT_R8_UINT:
        case VK_FORMAT_R16_UINT:
        case VK_FORMAT_R32G32_UINT:
        case VK_FORMAT_R32G32B32A32_UINT: return shared::kViewInteger;
        case VK_FORMAT_R32_SFLOAT: return name.find("depth") != std::string::npos ? shared::kViewLinearDepth : shared::kViewGrey;
        case VK_FORMAT_R8_UNORM:
        case VK_FORMAT_R16_UNORM:
        case VK_FORMAT_R16_SFLOAT: return shared::kViewGrey;
        case VK_FORMAT_R8G8B8A8_SNORM: return shared::kViewDirection;
        case VK_FORMAT_R16G16_SFLOAT: return name.find("motion") != std::string::npos ? shared::kViewMotion : shared::kViewValues;
        case VK_FORMAT_R8G8B8A8_SRGB:
        case VK_FORMAT_R16G16B16A16_SFLOAT:
        case VK_FORMAT_B10G11R11_UFLOAT_PACK32: return shared::kViewColor;
        default: return shared::kViewValues;
    }
}

}  // namespace

uint32_t dividerColumn(float split, uint32_t width) { return uint32_t(std::lround(std::clamp(split, 0.0f, 1.0f) * float(width))); }

const char* name(View view) { return kNames[size_t(view)]; }

bool parseView(const std::string& text, View& view, std::string& pass) {
    if (text.starts_with("pass:") && text.size() > 5) {
        view = View::pass;
        pass = text.substr(5);
        return true;
    }
    for (const View known : kViews)
        if (text == name(known)) {
            view = known;
            return true;
        }
    return false;
}

gpu::Status Views::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, Views& out) {
    gpu::Status status = gpu::Program::compute(device, shaders, "post/view_float.comp", {}, out.m_float);
    if (status == gpu::Status::ok) status = gpu::Program::compute(device, shaders, "post/view_uint.comp", {}, out.m_uint);
    if (status == gpu::Status::ok) status = gpu::Program::compute(device, shaders, "post/split.comp", {}, out.m_split[0]);
    if (status == gpu::Status::ok) status = gpu::Program::compute(device, shaders, "post/split.comp:DIRECTIONS", {}, out.m_split[1]);
    if (status == gpu::Status::ok) status = gpu::Program::compute(device, shaders, "post/difference.comp", {}, out.m_difference);
    if (status == gpu::Status::ok) status = gpu::Program::compute(device, shaders, "post/samples.comp", {}, out.m_samples);
    out.m_shaders = &shaders;
    return status;
}

graph::ImageId Views::show(graph::Graph& graph, graph::ImageId source, uint32_t mode, const shared::View& frame) {
    const gpu::ImageDesc desc = graph.desc(source);
    shared::ViewBlock block{};
    block.visible = frame.visible;
    block.mode = mode;
    block.linearize = frame.linearize;
    // Images with the aspect ratio of the whole image include the guard band, which is cut off. Other images are stretched.
    const float wholeX = float(desc.width) / float(frame.size.x), wholeY = float(desc.height) / float(frame.size.y);
    const bool whole = (desc.width != frame.visible.x || desc.height != frame.visible.y) && std::abs(wholeX / wholeY - 1.0f) < 0.02f;
    if (whole) {
        block.scale = {wholeX, wholeY};
        block.offset = {float(frame.guard.x) * wholeX, float(frame.guard.y) * wholeY};
    } else {
        block.scale = {float(desc.width) / float(frame.visible.x), float(desc.height) / float(frame.visible.y)};
    }
    const graph::ImageId picture = graph.image("picture", {VK_FORMAT_R8G8B8A8_UNORM, frame.visible.x, frame.visible.y});
    const bool integer =
        mode == shared::kViewNormal || mode == shared::kViewInteger || mode == shared::kViewHistory || mode == shared::kViewRejected;
    graph.pass("view", integer ? m_uint : m_float)
        .readMip(source, 0)
        .write(picture)
        .constants(block)
        .dispatch(frame.visible.x, frame.visible.y);
    return picture;
}

graph::ImageId Views::add(
    graph::Graph& graph, View view, const GBuffer& g, const ao::LayerInputs& layers, graph::ImageId visibility, const shared::View& frame) {
    switch (view) {
        case View::normals: return show(graph, g.geometric, shared::kViewNormal, frame);
        case View::shadedNormals: return show(graph, g.shaded, shared::kViewNormal, frame);
        case View::depth: return show(graph, g.depth, shared::kViewDeviceDepth, frame);
        case View::motion: return show(graph, g.motion, shared::kViewMotion, frame);
        case View::baseColor: return show(graph, g.baseColor, shared::kViewColor, frame);
        case View::roughness: return show(graph, g.material, shared::kViewGrey, frame);
        case View::metalness: return show(graph, g.material, shared::kViewSecond, frame);
        case View::emission: return show(graph, g.emission, shared::kViewColor, frame);
        case View::thickness: return show(graph, layers.thickness, shared::kViewThickness, frame);
        case View::second: return show(graph, layers.second, shared::kViewLinearDepth, frame);
        case View::secondThickness: return show(graph, layers.second, shared::kViewSecondThickness, frame);
        default: return show(graph, visibility, shared::kViewGrey, frame);
    }
}

graph::ImageId Views::directions(graph::Graph& graph, graph::ImageId image, const shared::View& frame) {
    return show(graph, image, shared::kViewDirection, frame);
}

graph::ImageId Views::addHistory(graph::Graph& graph, View view, const shared::View& frame) {
    for (const graph::Graph::Written& written : graph.written())
        if (written.pass == "temporal" && graph.desc(written.image).format == VK_FORMAT_R32G32_UINT)
            return show(graph, written.image, view == View::history ? shared::kViewHistory : shared::kViewRejected, frame);
    return {};
}

graph::ImageId Views::split(graph::Graph& graph, graph::ImageId a, graph::ImageId b, float divider) {
    const gpu::ImageDesc desc = graph.desc(a);
    const shared::SplitBlock block{{desc.width, desc.height}, dividerColumn(divider, desc.width), 0};
    const bool directions = desc.format == VK_FORMAT_R8G8B8A8_SNORM;
    const graph::ImageId both = graph.image(directions ? "split bent normals" : "split visibility", {desc.format, desc.width, desc.height});
    graph.pass("split", m_split[directions]).read(a).read(b).write(both).constants(block).dispatch(desc.width, desc.height);
    return both;
}

graph::ImageId Views::difference(graph::Graph& graph, graph::ImageId a, graph::ImageId b, float range, bool withSign) {
    const gpu::ImageDesc desc = graph.desc(a);
    const shared::DifferenceBlock block{{desc.width, desc.height}, 1.0f / std::max(range, 1e-6f), withSign ? 1u : 0u};
    const graph::ImageId picture = graph.image("picture", {VK_FORMAT_R8G8B8A8_UNORM, desc.width, desc.height});
    graph.pass("difference", m_difference).read(a).read(b).write(picture).constants(block).dispatch(desc.width, desc.height);
    return picture;
}

graph::ImageId Views::samples(graph::Graph& graph, const Outputs& outputs, uint32_t step, const shared::View& frame) {
    const shared::SamplesBlock block{{frame.visible.x / step, frame.visible.y / step}, frame.guard, step, {}};
    const graph::ImageId samples = graph.image("samples", {VK_FORMAT_R32G32B32A32_UINT, block.count.x, block.count.y});
    graph.pass("samples", m_samples)
        .read(outputs.sides[0])
        .read(outputs.sides[outputs.sides[1] ? 1 : 0])
        .read(outputs.linearDepth)
        .read(outputs.normals)
        .read(outputs.motion)
        .write(samples)
        .constants(block)
        .dispatch(block.count.x, block.count.y);
    return samples;
}

graph::ImageId Views::voxels(graph::Graph& graph, graph::BufferId bits, const ao::Volume& volume, const VoxelSlice* slice,
    const glm::vec3& eye, const shared::View& frame) {
    shared::Volume block;
    const char* reason = nullptr;
    if (ao::volumeOf(volume, block, reason) != ao::Status::ok) return {};
    struct {
        int32_t axis;
        float layer, shown;
    } constants{-1, 0.0f, float(volume.levels > 1 ? 2 * volume.cells : volume.cells)};
    if (slice) {
        constants.axis = std::clamp(slice->axis, 0, 2);
        const int axis = constants.axis;
        const float eyeAt = axis == 0 ? block.rows[0].w : axis == 1 ? block.rows[1].w : block.rows[2].w;
        constants.layer = eyeAt + (slice->at ? (*slice->at - eye[axis]) / block.centre.w : 0.0f);
    }
    // Created at first use: drivers compile the NanoVDB shader longer than all others together.
    const bool tree = volume.structure != ao::VolumeStructure::dense;
    gpu::Program& program = m_voxels[tree];
    const char* shader = tree ? "voxel/view.comp:VOLUME_NANOVDB" : "voxel/view.comp";
    if (!program && gpu::Program::compute(graph.device(), *m_shaders, shader, {}, program) != gpu::Status::ok) return {};
    const graph::ImageId picture = graph.image("picture", {VK_FORMAT_R8G8B8A8_UNORM, frame.visible.x, frame.visible.y});
    graph.pass("voxels.view", program)
        .read(graph.upload("view", frame))
        .read(graph.upload("volume", block))
        .read(bits)
        .write(picture)
        .constants(constants)
        .dispatch(frame.visible.x, frame.visible.y);
    return picture;
}

graph::ImageId Views::addPass(graph::Graph& graph, const std::string& pass, const shared::View& frame) {
    for (const graph::Graph::Written& written : graph.written()) {
        if (written.pass != pass || graph.desc(written.image).depth > 1) continue;
        return show(graph, written.image, modeOf(graph.desc(written.image).format, graph.name(written.image)), frame);
    }
    return {};
}

}  // namespace obscura::render
