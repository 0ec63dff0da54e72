#include "ao/crop.h"

#include "ao/common/constants.h"

namespace obscura::ao {

graph::ImageId Crop::add(
    gpu::Device& device, const gpu::ShaderLibrary& shaders, graph::Graph& graph, graph::ImageId source, const Part& part, Texel texel) {
    constexpr struct {
        const char* shader;
        VkFormat format;
    } kKinds[] = {{"ao/common/crop.comp", VK_FORMAT_R32G32_SFLOAT}, {"ao/common/crop.comp:FOUR", VK_FORMAT_R32G32B32A32_SFLOAT},
        {"ao/common/crop.comp:INTEGER", VK_FORMAT_R32_UINT}, {"ao/common/crop.comp:MULTISAMPLE", VK_FORMAT_R32G32_SFLOAT},
        {"ao/common/crop.comp:FOUR,MULTISAMPLE", VK_FORMAT_R32G32B32A32_SFLOAT},
        {"ao/common/crop.comp:INTEGER,MULTISAMPLE", VK_FORMAT_R32_UINT}};
    const size_t index = size_t(texel) + (part.multisampled ? 3 : 0);
    const auto& kind = kKinds[index];
    gpu::Program& program = m_programs[index];
    if (!program && gpu::Program::compute(device, shaders, kind.shader, {}, program) != gpu::Status::ok) return {};
    const graph::ImageId copy = graph.image("cropped", {kind.format, part.size.width, part.size.height});
    graph.pass("prepare.crop", program)
        .read(source)
        .write(copy)
        .constants(shared::Crop{
            {part.origin.x, part.origin.y}, shared::sizeOf(part.size.width, part.size.height), int32_t(part.stride), part.half ? 1 : 0})
        .dispatch(part.size.width, part.size.height);
    return copy;
}

}  // namespace obscura::ao
