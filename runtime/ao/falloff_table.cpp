#include "ao/falloff_table.h"

#include "ao/common/constants.h"

namespace obscura::ao {
namespace {

constexpr uint32_t kColumns = 64, kRows = 128;  // as in common/falloff_table.comp

}  // namespace

gpu::Status FalloffTable::create(gpu::Device& device, const gpu::ShaderLibrary& shaders, FalloffTable& out) {
    const gpu::Status status = gpu::Image::create(device,
        {VK_FORMAT_R32G32B32A32_UINT, kColumns, kRows, 1, 1, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT}, "falloff table",
        out.m_table);
    return status != gpu::Status::ok ? status : gpu::Program::compute(device, shaders, "ao/common/falloff_table.comp", {}, out.m_program);
}

graph::ImageId FalloffTable::add(graph::Graph& graph, const Inputs& inputs, const char* passName) {
    const Falloff& f = inputs.falloffDesc;
    const bool same = m_filled && f.kind == m_falloff.kind && f.length == m_falloff.length && f.end == m_falloff.end;
    graph::External external{m_table.handle(), m_table.view(), m_table.desc()};
    external.layout = m_filled ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_UNDEFINED;
    external.layoutAfter = VK_IMAGE_LAYOUT_GENERAL;
    const graph::ImageId table = graph.import("falloff table", external);
    if (!same) {
        graph.pass(passName, m_program)
            .write(table)
            .constants(shared::FalloffTable{inputs.falloff, f.length, uint32_t(f.kind)})
            .dispatch(kRows);
        graph.onRecorded([this, f] {
            m_falloff = f;
            m_filled = true;
        });
    }
    return table;
}

}  // namespace obscura::ao
