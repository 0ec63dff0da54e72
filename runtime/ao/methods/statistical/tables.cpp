#include "ao/methods/statistical/tables.h"

#include "ao/statistical/constants.h"

#include <cassert>
#include <cmath>
#include <string>
#include <utility>

namespace obscura::ao {
namespace {

using shared::Box;
using shared::uvec2;

const uvec2 kBlock{128, 32};  // px, covered by a workgroup of extent_blocks.comp

}  // namespace

Status StatisticalTables::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, StatisticalTables& out) {
    if (SummedArea::create(device, shaders, out.m_sums) != Status::ok) return Status::shaderError;
    const struct {
        const char* name;
        gpu::Program* program;
    } programs[] = {{"ao/statistical/extent_blocks.comp", &out.m_extentBlocks}, {"ao/statistical/extent.comp", &out.m_extent},
        {"ao/statistical/texels.comp", &out.m_texels}};
    for (const auto& [name, program] : programs)
        if (gpu::Program::compute(device, shaders, name, {}, *program) != gpu::Status::ok) return Status::shaderError;
    for (uint32_t level = 0; level < 4; ++level)
        if (gpu::Program::compute(device, shaders, "ao/statistical/layers.comp", {{0, level}}, out.m_layers[level]) != gpu::Status::ok)
            return Status::shaderError;
    out.m_largest = device.caps().maxStorageRange;
    return Status::ok;
}

StatisticalTables::Tables StatisticalTables::add(graph::Graph& graph, const Inputs& inputs, Box box, uint32_t levels) {
    const auto& view = inputs.view;
    const auto sizeOf = [&](uint32_t side) { return uvec2{(view.size.x + side - 1) / side, (view.size.y + side - 1) / side}; };
    const uint32_t asked = box.texelSide;
    while (SummedArea::bytes(sizeOf(box.texelSide), levels > 1 ? 1u << (levels - 1) : 2) > m_largest) box.texelSide *= 2;
    if (box.texelSide > asked && !std::exchange(m_warned, true)) {
        const auto part = [](uint32_t side) { return side == 1 ? std::string("full size") : "1/" + std::to_string(side) + " of the size"; };
        graph.device().log(
            gpu::Severity::warning, ("statistical: tables of " + part(asked) + " do not fit this device's storage buffers of " +
                                        std::to_string(m_largest >> 20) + " MiB; they have " + part(box.texelSide))
                                        .c_str());
    }
    // The bound of the fixed point must leave a few units over the whole depth range (fixed_point.h).
    assert(4.0f * (box.largest + float(box.texelSide)) * (box.largest + float(box.texelSide)) < 1.0e8f &&
           "statistical: the window is too large for 32-bit sums: lower `largest` or the image height");

    box.columns = std::abs(view.project.x) / view.pixelsPerMetre;
    box.limit = shared::limitOf(box, view.size);
    Tables t{box, sizeOf(box.texelSide), {}, {}, {}, {}, {}};
    const uvec2 blocks{(view.size.x + kBlock.x - 1) / kBlock.x, (view.size.y + kBlock.y - 1) / kBlock.y};
    const uint32_t count = blocks.x * blocks.y;
    const graph::BufferId extents = graph.buffer("statistical.extent blocks", uint64_t(count) * 16);
    t.extent = graph.buffer("statistical.extent", 16);
    graph.pass("statistical.extent blocks", m_extentBlocks)
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .write(extents)
        .constants(shared::StatisticalExtentBlocks{box})
        .dispatch(blocks.x * 8, blocks.y * 8);
    graph.pass("statistical.extent", m_extent)
        .read(inputs.viewBlock)
        .read(extents)
        .write(t.extent)
        .constants(shared::StatisticalExtent{count})
        .dispatch(64);
    t.texels = graph.buffer("statistical.texels", uint64_t(t.size.x) * t.size.y * 16);
    t.codes = graph.buffer("statistical.codes", uint64_t(t.size.x) * t.size.y * 4);
    graph.pass("statistical.texels", m_texels)
        .read(inputs.viewBlock)
        .read(inputs.depth)
        .read(t.extent)
        .write(t.texels)
        .constants(shared::StatisticalTexels{box, t.size})
        .dispatch(t.size.x, t.size.y);
    t.root = graph.buffer("statistical.root", SummedArea::bytes(t.size, 1));
    m_sums.add(graph, "statistical.root", t.texels, t.root, t.size);

    static const SummedArea::Layer kFirst[] = {{1, 1}}, kSecond[] = {{3, 3}, {3, 2}}, kThird[] = {{7, 7}, {7, 5}, {7, 6}, {7, 4}};
    const std::span<const SummedArea::Layer> layers[] = {kFirst, kSecond, kThird};
    const char* const names[] = {"statistical.first", "statistical.second", "statistical.third"};
    for (graph::BufferId& level : t.levels) level = t.root;
    for (uint32_t k = 0; k < levels; ++k) {
        addCodes(graph, inputs, t, k + 1, 0, std::string(names[k]) + " layers");
        t.levels[k] = graph.buffer(names[k], SummedArea::bytes(t.size, layers[k].size()));
        m_sums.add(graph, names[k], t.texels, t.codes, t.levels[k], t.size, layers[k]);
    }
    return t;
}

void StatisticalTables::addUniform(graph::Graph& graph, const Inputs& inputs, const Tables& tables, uint32_t layers) {
    addCodes(graph, inputs, tables, 0, layers, "statistical.uniform layers");
}

void StatisticalTables::addPair(graph::Graph& graph, const Tables& tables, uint32_t k, graph::BufferId pair) {
    const SummedArea::Layer two[] = {{63, k}, {63, k + 1}};
    m_sums.add(graph, "statistical.pair", tables.texels, tables.codes, pair, tables.size, two);
}

void StatisticalTables::addCodes(
    graph::Graph& graph, const Inputs& inputs, const Tables& t, uint32_t level, uint32_t uniformLayers, const std::string& name) {
    graph.pass(name, m_layers[level])
        .read(inputs.viewBlock)
        .read(t.extent)
        .read(t.texels)
        .read(t.root)
        .read(t.levels[0])
        .read(t.levels[1])
        .write(t.codes)
        .constants(shared::StatisticalLayers{t.box, t.size, uniformLayers})
        .dispatch(t.size.x, t.size.y);
}

}  // namespace obscura::ao
