// obscura-info: the library's version and methods, a method's parameters, presets and memory, and the Vulkan devices of this machine with
// what each lacks to run it. Built with the library alone.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <obscura/ao.h>

#include "devices.h"
#include "loader.h"

namespace ao = obscura::ao;

namespace {

constexpr const char* kUsage =
    "obscura-info [--methods | --devices | METHOD [WIDTHxHEIGHT]]\n"
    "Prints the library's version, its methods, and whether each Vulkan device of this machine can run it.\n"
    "With METHOD: its inputs, parameters and presets, and the device memory of each preset at that size (1920x1080).\n"
    "Exit code: 0 if a device can, 1 if none can, 2 for a wrong argument, 77 if there is no Vulkan device.\n"
    "  obscura-info layered 3840x2160\n";

void printMethods() {
    for (const ao::MethodInfo* method : ao::methods()) std::printf("  %-18s %s\n", method->id, method->title);
}

int printDevices() {
    const PFN_vkGetInstanceProcAddr load = openLoader();
    if (!load) {
        std::printf("devices: none; the Vulkan loader %s is not installed\n", loaderName());
        return 77;
    }
    std::string error;
    const std::vector<DeviceReport> reports = reportDevices(load, error);
    if (reports.empty()) {
        std::printf("devices: none; %s\n", error.empty() ? "the Vulkan driver lists no device" : error.c_str());
        return 77;
    }
    int result = 1;
    std::puts("devices:");
    for (const DeviceReport& report : reports) {
        std::printf("  %s (%s), Vulkan %u.%u.%u%s%s\n", report.name.c_str(), report.type.c_str(), VK_API_VERSION_MAJOR(report.vulkan),
            VK_API_VERSION_MINOR(report.vulkan), VK_API_VERSION_PATCH(report.vulkan), report.driver.empty() ? "" : ", ",
            report.driver.c_str());
        if (report.missing.empty()) {
            std::puts("    can run the library: a context and every method's pipelines were made on it");
            result = 0;
        }
        for (const std::string& missing : report.missing) std::printf("    cannot: %s\n", missing.c_str());
    }
    return result;
}

std::string inputsOf(uint32_t needs) {
    const struct {
        uint32_t bit;
        const char* name;
    } inputs[] = {{ao::kDepth, "depth"}, {ao::kNormals, "normals (or reconstructed from depth)"}, {ao::kMotion, "motion"},
        {ao::kLayers, "depth layers"}, {ao::kVolume, "volume"}};
    std::string text;
    for (const auto& input : inputs)
        if (needs & input.bit) text += (text.empty() ? "" : ", ") + std::string(input.name);
    return text.empty() ? "none" : text;
}

void printParameter(const ao::Parameter& parameter) {
    std::printf("  %-18s ", parameter.id);
    if (parameter.choices.count) {
        std::string choices;
        for (const char* choice : parameter.choices) choices += (choices.empty() ? "" : ", ") + std::string(choice);
        std::printf("%s (%s)", choices.c_str(), parameter.choices[size_t(parameter.initial)]);
    } else {
        std::printf(
            "%g to %g (%g)%s%s", parameter.minimum, parameter.maximum, parameter.initial, *parameter.unit ? " " : "", parameter.unit);
    }
    std::printf("\n    %s\n", parameter.sentence);
}

int printMethod(const ao::MethodInfo& method, uint32_t width, uint32_t height) {
    std::printf("%s: %s\n  %s\n", method.id, method.title, method.sentence);
    if (*method.paper) std::printf("  %s\n", method.paper);
    std::printf("  inputs: %s\nparameters:\n", inputsOf(method.needs).c_str());
    for (const ao::Parameter& parameter : method.parameters) printParameter(parameter);
    std::puts("presets:");
    for (const ao::Preset& preset : method.presets) {
        std::printf("  %-18s %s\n", preset.id, preset.sentence);
        if (!preset.settings.count) continue;
        std::printf("    ");
        for (const ao::Setting& setting : preset.settings) std::printf("%s=%g ", setting.id, setting.value);
        std::printf("\n");
    }
    const PFN_vkGetInstanceProcAddr load = openLoader();
    std::string error = load ? "" : std::string("the Vulkan loader ") + loaderName() + " is not installed";
    const MemoryReport report = load ? reportMemory(load, method, width, height, error) : MemoryReport();
    if (report.presets.empty()) {
        std::printf("memory: unknown; %s\n", error.c_str());
        return 77;
    }
    std::printf("device memory at %u x %u px, two frames in flight, on %s:\n", width, height, report.device.c_str());
    for (const MemoryReport::Preset& preset : report.presets)
        std::printf("  %-18s %8.1f MiB, %5.1f bytes a pixel\n", preset.id.c_str(), double(preset.bytes) / (1 << 20),
            double(preset.bytes) / (double(width) * height));
    return 0;
}

bool parseSize(const char* text, uint32_t& width, uint32_t& height) {
    char* end = nullptr;
    const unsigned long w = std::strtoul(text, &end, 10);
    if (*end != 'x' || end == text) return false;
    const char* second = end + 1;
    const unsigned long h = std::strtoul(second, &end, 10);
    if (*end || end == second || w < 1 || h < 1 || w > 32768 || h > 32768) return false;
    width = uint32_t(w), height = uint32_t(h);
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "--help" || what == "-h") return std::fputs(kUsage, stdout), 0;
    const bool listed = what.empty() || what == "--methods" || what == "--devices";
    if (argc > (listed ? 2 : 3) || (!listed && what[0] == '-')) return std::fputs(kUsage, stderr), 2;
    if (!listed) {
        uint32_t width = 1920, height = 1080;
        const ao::MethodInfo* method = ao::findMethod(what.c_str());
        if (!method) {
            std::fprintf(stderr, "obscura-info: %s: no such method; obscura-info --methods names them\n", what.c_str());
            return 2;
        }
        if (argc == 3 && !parseSize(argv[2], width, height)) {
            std::fprintf(stderr, "obscura-info: %s: write WIDTHxHEIGHT in pixels, as in 1920x1080\n", argv[2]);
            return 2;
        }
        return printMethod(*method, width, height);
    }
    if (what.empty()) std::puts("Obscura " OBSCURA_VERSION);
    if (what != "--devices") {
        if (what.empty()) std::puts("methods:");
        printMethods();
    }
    return what != "--methods" ? printDevices() : 0;
}
