#include "measure/arguments.h"

#include "app/arguments.h"
#include "scene/json_text.h"

namespace obscura::measure {

CLI::Option* takeAll(CLI::Option* option) {
    return option->delimiter(',')->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

std::vector<std::string> CandidateOptions::allSets() const {
    std::vector<std::string> all = sets;
    if (!offscreen.empty()) all.insert(all.begin(), "offscreen=" + offscreen);
    if (!resolve.empty()) all.insert(all.begin(), "resolve=" + resolve);
    return all;
}

void addCandidateOptions(CLI::App& cli, CandidateOptions& into, const char* setHelp) {
    takeAll(cli.add_option("--method", into.methods, "Methods by id, or all")->capture_default_str());
    takeAll(cli.add_option("--preset", into.presets, "Presets of them, or all")->capture_default_str());
    cli.add_option("--set", into.sets, setHelp)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    cli.add_option("--offscreen", into.offscreen, app::kOffScreenHelp);
}

void addDevice(CLI::App& cli, std::string& device, std::string& validation, bool& verbose) {
    cli.option_defaults()->group("Device");
    cli.add_option("--device", device, "Part of the name of the Vulkan device to use");
    cli.add_option("--validation", validation, "Vulkan validation: off, core, or sync")
        ->check(CLI::IsMember({"off", "core", "sync"}))
        ->capture_default_str();
    cli.add_flag("--verbose", verbose, "Print the log of device and loader");
}

std::string commandOf(const char* program, int argc, const char* const* argv) {
    std::string command = program;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i], option = word.substr(0, word.find('='));
        if (option != "--out" && option != "--table" && option != "--compare" && option != "--device")
            command += " " + app::shellWord(word);
        else if (option == word) ++i;
    }
    return scene::utf8(command);
}

}  // namespace obscura::measure
