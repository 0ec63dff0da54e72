#include "render/layers.h"

#include <algorithm>

namespace obscura::render {
namespace {

using gpu::Status;

constexpr VkFormat kHit = VK_FORMAT_R32_UINT, kDepth = VK_FORMAT_D32_SFLOAT;

struct ResolveConstants {
    uint32_t hits, secondLayer;
};  // of resolve.comp

}  // namespace

LayerForm FormTrial::next(const graph::Timings& arrived) {
    if (m_chosen != LayerForm::best) return m_chosen;
    if (arrived.frame != m_seen) {
        double ms[2] = {};
        bool complete[2] = {};  // all passes of the form were timed
        for (const gpu::PassTime& pass : arrived.passes) {
            const bool ladder = pass.name == "layers.clear" || pass.name == "layers.ladder";
            if (ladder || pass.name.ends_with(" hit")) ms[ladder] += pass.milliseconds;
            complete[0] |= pass.name == "layers.fourth hit";
            complete[1] |= pass.name == "layers.ladder";
        }
        for (int form = 0; form < 2; ++form)
            if (complete[form] && m_timed[form]++ > 0) m_least[form] = std::min(m_least[form], ms[form]);
        m_seen = arrived.frame;
    }
    if (std::min(m_timed[0], m_timed[1]) >= kEach) m_chosen = m_least[0] < m_least[1] ? LayerForm::peeling : LayerForm::ladder;
    if (m_chosen == LayerForm::best && m_declared++ == kMost) m_chosen = LayerForm::ladder;
    return m_chosen != LayerForm::best ? m_chosen : m_declared % 2 ? LayerForm::ladder : LayerForm::peeling;
}

Status LayersPass::createPair(gpu::Device& device, const gpu::ShaderLibrary& shaders, const std::string& fragment, gpu::GraphicsState state,
    std::initializer_list<gpu::Constant> constants, Pair& out) {
    state.vertexBindings = {{0, kPositionBytes, VK_VERTEX_INPUT_RATE_VERTEX}};
    state.vertexAttributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}};
    const Status status = gpu::Program::graphics(device, shaders, "scene/layers/place.vert", fragment, state, constants, out.solid);
    if (status != Status::ok) return status;
    state.vertexBindings.push_back({1, kCoordsBytes, VK_VERTEX_INPUT_RATE_VERTEX});
    state.vertexAttributes.push_back({1, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 0});
    state.vertexAttributes.push_back({2, 1, VK_FORMAT_R16G16B16A16_SFLOAT, 16});
    return gpu::Program::graphics(device, shaders, "scene/layers/place.vert:MASKED",
        fragment + (fragment.find(':') == fragment.npos ? ":MASKED" : ",MASKED"), state, constants, out.masked);
}

Status LayersPass::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, LayersPass& out) {
    gpu::GraphicsState peel;
    peel.colorFormats = {kHit};
    peel.depthFormat = kDepth;
    peel.depthTest = peel.depthWrite = true;
    Status status = createPair(device, shaders, "scene/layers/peel.frag", peel, {}, out.m_peel);
    for (uint32_t first = 0; first < 2 && status == Status::ok; ++first)
        status = createPair(device, shaders, "scene/layers/peel.frag:WHOLE_HITS", peel, {{0, first}}, out.m_peelOn[first]);
    out.m_canWrite = device.caps().fragmentWrites;
    if (status == Status::ok && out.m_canWrite) {
        gpu::GraphicsState ladder;
        ladder.depthFormat = kDepth;
        ladder.depthTest = true;
        ladder.depthCompare = VK_COMPARE_OP_LESS;  // reversed depth: behind the visible surface
        status = createPair(device, shaders, "scene/layers/ladder.frag", ladder, {}, out.m_ladder);
    }
    return status == Status::ok ? gpu::Program::compute(device, shaders, "scene/layers/resolve.comp", {}, out.m_resolve) : status;
}

void LayersPass::draw(graph::Pass& pass, Pair& programs, const DrawList& list, const Deform::Posed& posed, Materials& materials) {
    if (posed.now) pass.use(posed.now, graph::Access::vertex);
    pass.record([&programs, &list, posed, &materials](const graph::PassContext& c) {
        const gpu::Api& vk = c.device.vk();
        recordDraws(c.cmd, vk, list.opaque, posed.buffers, kPosition, false, nullptr);
        if (list.masked.empty()) return;
        programs.masked.refresh();
        vk.CmdBindPipeline(c.cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, programs.masked.pipeline());
        recordDraws(c.cmd, vk, list.masked, posed.buffers, kPosition | kCoords, false, [&](const ModelGpu& model, uint32_t material) {
            const VkDescriptorSet set = materials.get(model, material, programs.masked);
            vk.CmdBindDescriptorSets(c.cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, programs.masked.layout(), 1, 1, &set, 0, nullptr);
        });
    });
}

ao::LayerInputs LayersPass::add(graph::Graph& graph, const GBuffer& g, graph::BufferId frame, graph::BufferId items, const DrawList& list,
    const Deform::Posed& posed, Materials& materials, ao::LayerMode use, LayerForm form) {
    const uint32_t width = graph.desc(g.depth).width, height = graph.desc(g.depth).height;
    const bool second = use != ao::LayerMode::first, half = use == ao::LayerMode::secondHalf;
    if (form == LayerForm::best && second && m_canWrite) {
        const bool undecided = m_trial.chosen() == LayerForm::best;
        form = m_trial.next(graph.timings());
        if (undecided && m_trial.chosen() != LayerForm::best)
            graph.device().log(gpu::Severity::info, std::string("layers: two depth layers are drawn by ") +
                                                        (form == LayerForm::ladder ? "the ladder" : "peeling") + ", the faster form here");
    }
    const bool ladder = m_canWrite && form == LayerForm::ladder;
    const char* const names[] = {"layers.second hit", "layers.third hit", "layers.fourth hit"};
    graph::ImageId hits[3];
    if (ladder) {
        for (int i = 0; i < 3; ++i) hits[i] = graph.image(names[i], {kHit, width, height});
        graph.pass("layers.clear")
            .use(hits[0], graph::Access::transferWrite, true)
            .use(hits[1], graph::Access::transferWrite, true)
            .use(hits[2], graph::Access::transferWrite, true)
            .record([hits](const graph::PassContext& c) {
                const VkClearColorValue none{};
                const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
                for (const graph::ImageId hit : hits)
                    c.device.vk().CmdClearColorImage(c.cmd, c.image(hit), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &none, 1, &range);
            });
        graph::Pass& pass =
            graph.pass("layers.ladder", m_ladder.solid).read(frame).read(items).write(hits[0]).write(hits[1]).write(hits[2]);
        pass.depthTest(g.depth);
        draw(pass, m_ladder, list, posed, materials);
    } else {
        graph::ImageId before = g.depth;
        for (int i = 0; i < (second ? 3 : 1); ++i) {
            Pair& pair = second ? m_peelOn[i == 0] : m_peel;
            hits[i] = graph.image(names[i], {kHit, width, height});
            const graph::ImageId depth = graph.image(std::string(names[i]) + " depth", {kDepth, width, height});
            graph::Pass& pass = graph.pass(names[i], pair.solid).read(frame).read(items).read(before);
            pass.color(hits[i], VkClearColorValue{}).depth(depth, 0.0f);
            draw(pass, pair, list, posed, materials);
            before = depth;
        }
    }
    for (graph::ImageId& hit : hits)
        if (!hit) hit = hits[0];  // bound but not read

    ao::LayerInputs layers;
    layers.thickness = graph.image("layers.thickness", {VK_FORMAT_R16_SFLOAT, width, height});
    const graph::ImageId behind = graph.image("layers.second", {VK_FORMAT_R32G32_SFLOAT,
                                                                   !second ? 1
                                                                   : half  ? (width + 1) / 2
                                                                           : width,
                                                                   !second ? 1
                                                                   : half  ? (height + 1) / 2
                                                                           : height});
    const ResolveConstants constants{second || ladder ? 3u : 1u, half ? 2u : second ? 1u : 0u};
    graph.pass("layers.resolve", m_resolve)
        .read(frame)
        .read(g.depth)
        .read(g.material)
        .read(hits[0])
        .read(hits[1])
        .read(hits[2])
        .write(layers.thickness)
        .write(behind)
        .constants(constants)
        .dispatch(width, height);
    if (second) layers.second = behind;
    return layers;
}

}  // namespace obscura::render
