// Entry point of obscura-tune: parses the command line, runs the job, writes the results; a failure is one line and an exit code.
#include <cstdio>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/files.h"
#include "tune.h"

namespace obscura::tune {
namespace {

int run(int argc, char** argv) {
    const auto options = parseOptions(argc, argv);
    if (!options) return 0;
    app::expectFolder(options->out);
    measure::Machine machine({options->device, options->validation, options->verbose});
    std::optional<CycleClock> clock;
    if (options->cycles) clock.emplace(machine);
    CycleClock* const counted = clock ? &*clock : nullptr;
    Course training(machine, options->training, options->falloffs, options->flight, counted),
        heldOut(machine, options->heldOut, options->falloffs, options->flight, counted);
    std::vector<Tuned> results;
    for (const measure::Candidate& hand : options->hands) {
        results.push_back(tune(*options, hand, training, heldOut));
        app::writeFile(options->out / "tune.json", jsonText(*options, results));
        app::writeFile(options->out / "tune.md", markdown(*options, results));
    }
    std::fputs(markdown(*options, results).c_str(), stdout);
    return machine.device().validationMessages() ? app::kInvalidUse : 0;
}

}  // namespace
}  // namespace obscura::tune

int main(int argc, char** argv) {
    return obscura::app::guarded("obscura-tune", [&] { return obscura::tune::run(argc, argv); });
}
