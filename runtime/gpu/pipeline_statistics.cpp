#include "gpu/pipeline_statistics.h"

#include <cstring>

namespace obscura::gpu {
namespace {

double valueOf(const VkPipelineExecutableStatisticKHR& s) {
    switch (s.format) {
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR: return s.value.b32 ? 1.0 : 0.0;
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR: return double(s.value.i64);
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR: return double(s.value.u64);
        default: return s.value.f64;
    }
}

}  // namespace

double PipelineStatistics::of(const char* name) const {
    const auto found = values.find(name);
    return found == values.end() ? -1.0 : found->second;
}

PipelineStatistics statisticsOf(const Device& device, const Program& program, VkShaderStageFlagBits stage) {
    PipelineStatistics result;
    const Api& vk = device.vk();
    if (!device.caps().statistics || !program) return result;
    const VkPipelineInfoKHR pipeline{VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, nullptr, program.pipeline()};
    uint32_t count = 0;
    if (vk.GetPipelineExecutablePropertiesKHR(device.handle(), &pipeline, &count, nullptr) != VK_SUCCESS) return result;
    std::vector<VkPipelineExecutablePropertiesKHR> executables(count, {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR});
    if (vk.GetPipelineExecutablePropertiesKHR(device.handle(), &pipeline, &count, executables.data()) < VK_SUCCESS) return result;
    for (uint32_t index = 0; index < count; ++index) {
        if (!(executables[index].stages & stage)) continue;
        const VkPipelineExecutableInfoKHR executable{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, program.pipeline(), index};
        result.values["Subgroup size"] = executables[index].subgroupSize;
        uint32_t size = 0;
        vk.GetPipelineExecutableStatisticsKHR(device.handle(), &executable, &size, nullptr);
        std::vector<VkPipelineExecutableStatisticKHR> statistics(size, {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
        vk.GetPipelineExecutableStatisticsKHR(device.handle(), &executable, &size, statistics.data());
        for (const VkPipelineExecutableStatisticKHR& s : statistics) result.values[s.name] = valueOf(s);

        // Texts: asked for their sizes first, then for all.
        size = 0;
        vk.GetPipelineExecutableInternalRepresentationsKHR(device.handle(), &executable, &size, nullptr);
        std::vector<VkPipelineExecutableInternalRepresentationKHR> texts(
            size, {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR});
        vk.GetPipelineExecutableInternalRepresentationsKHR(device.handle(), &executable, &size, texts.data());
        std::vector<std::string> contents(texts.size());
        for (size_t i = 0; i < texts.size(); ++i) {
            contents[i].resize(texts[i].dataSize);
            texts[i].pData = contents[i].data();
        }
        vk.GetPipelineExecutableInternalRepresentationsKHR(device.handle(), &executable, &size, texts.data());
        for (size_t i = 0; i < texts.size(); ++i)
            if (texts[i].isText && std::strstr(texts[i].name, "ssembly")) result.assembly = contents[i].substr(0, contents[i].find('\0'));
        break;
    }
    return result;
}

}  // namespace obscura::gpu
