// Entry point of obscura-evaluate: parses the command line, runs the job, writes the results; a failure is one line and an exit code.
#include <cstdio>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "gallery.h"
#include "gate.h"
#include "scene/json_text.h"

namespace obscura::evaluate {
namespace {

namespace fs = std::filesystem;

// Outputs and inputs are checked before the first frame is drawn.
void expectOutputs(const Options& options) {
    if (!options.out.empty()) app::expectFolder(options.out);  // may hold the files
    for (const fs::path& file : {options.json, options.page, options.captureOut})
        if (!file.empty()) app::expectWritable(file);
}

// Removes the folder that was made for the results if the run fails.
class MadeFolder {
public:
    explicit MadeFolder(const fs::path& folder) : m_folder(folder.empty() || fs::exists(folder) ? fs::path() : folder) {}
    ~MadeFolder() {
        std::error_code ignored;
        if (!m_folder.empty()) fs::remove(m_folder, ignored);  // fails on a folder that is not empty
    }

private:
    fs::path m_folder;
};

int evaluateShots(const Options& options) {
    measure::expectScenes(options);
    measure::expectReferenceFile(options);
    const MadeFolder made(options.out);
    expectOutputs(options);
    measure::Machine machine({options.device, options.validation, options.verbose});
    const About about{machine.deviceName(), options.frames, options.warmUp};
    std::vector<ShotResult> results;
    measure::forEachShot(machine, options, [&](measure::Shot& shot) {
        results.push_back(measure(machine, shot, options));
        if (options.job == Job::gallery) fmt::print(stderr, "{} {}: done\n", shot.scene, shot.camera);
    });
    const std::string page = options.page.empty() ? "" : galleryPage(results, options, about);

    std::fputs(textTable(results, options, about).c_str(), stdout);
    if (!options.json.empty()) app::writeFile(options.json, scene::dump(rowsJson(results, options, about), 2) + "\n");
    if (!options.out.empty()) writeFolder(results, options, about);
    if (!options.captureOut.empty()) writeCaptures(results, options.captureOut);
    if (!options.page.empty()) {
        app::writeFile(options.page, page);
        fmt::print("{}: {:.1f} MB\n", options.page.string(), double(page.size()) * 1e-6);
    }
    return machine.device().validationMessages() ? app::kInvalidUse : 0;
}

int run(int argc, char** argv) {
    const auto options = parseOptions(argc, argv);
    if (!options) return 0;
    switch (options->job) {
        case Job::checkBaseline: return checkBaseline(*options);
        case Job::renewBaseline: return renewBaseline(*options);
        case Job::evaluate:
        case Job::gallery: break;
    }
    return evaluateShots(*options);
}

}  // namespace
}  // namespace obscura::evaluate

int main(int argc, char** argv) {
    return obscura::app::guarded("obscura-evaluate", [&] { return obscura::evaluate::run(argc, argv); });
}
