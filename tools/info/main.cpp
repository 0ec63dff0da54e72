// obscura-info: the library's version and methods, and the Vulkan devices of this machine with what each lacks to run it.
#include <cstdio>
#include <cstring>

#include <obscura/ao.h>

#include "devices.h"
#include "loader.h"

namespace {

constexpr const char* kUsage =
    "obscura-info [--methods | --devices]\n"
    "Prints the library's version, its methods, and whether each Vulkan device of this machine can run it.\n"
    "Exit code: 0 if a device can, 1 if none can, 77 if there is no Vulkan device.\n";

void printMethods() {
    for (const obscura::ao::MethodInfo* method : obscura::ao::methods()) std::printf("  %-18s %s\n", method->id, method->title);
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

}  // namespace

int main(int argc, char** argv) {
    const char* what = argc > 1 ? argv[1] : "";
    if (argc > 2 || (argc == 2 && std::strcmp(what, "--methods") != 0 && std::strcmp(what, "--devices") != 0)) {
        const bool help = argc == 2 && std::strcmp(what, "--help") == 0;
        std::fputs(kUsage, help ? stdout : stderr);
        return help ? 0 : 2;
    }
    if (argc == 1) std::puts("Obscura " OBSCURA_VERSION);
    if (std::strcmp(what, "--devices") != 0) {
        if (argc == 1) std::puts("methods:");
        printMethods();
    }
    return std::strcmp(what, "--methods") != 0 ? printDevices() : 0;
}
