// Entry point: parses the command line, runs one job, reports a failure as one line and an exit code.
#include "app/complaint.h"
#include "jobs.h"

int main(int argc, char** argv) {
    using namespace obscura;
    return app::guarded("obscura", [&] {
        const auto options = game::parseOptions(argc, argv);
        if (!options) return 0;
        switch (options->job) {
            case game::Job::listMethods: return game::listMethods(options->json);
            case game::Job::listScenes: return game::listScenes();
            case game::Job::listScene: return game::listScene(options->scene);
            case game::Job::listDevices: return game::listDevices();
            case game::Job::headless: return game::runHeadless(*options);
            case game::Job::play: return game::playWindowed(*options);
        }
        return 0;
    });
}
