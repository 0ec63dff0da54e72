// Reads the command line, does one job, turns every failure into one line and an exit code.
#include <cstdio>
#include <exception>

#include "app/complaint.h"
#include "jobs.h"

int main(int argc, char** argv) {
    using namespace obscura;
    try {
        const auto options = game::parseOptions(argc, argv);
        if (!options) return 0;
        switch (options->job) {
            case game::Job::listMethods: return game::listMethods(options->json);
            case game::Job::listScenes: return game::listScenes();
            case game::Job::listDevices: return game::listDevices();
            case game::Job::headless: return game::runHeadless(*options);
            case game::Job::play: return game::playWindowed(*options);
        }
    } catch (const app::Complaint& complaint) {
        std::fprintf(stderr, "obscura: %s\n", app::oneLine(complaint.what()).c_str());
        return complaint.code;
    } catch (const scene::Error& error) {
        std::fprintf(stderr, "obscura: %s\n", app::oneLine(error.what()).c_str());
        return app::kBadInput;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "obscura: %s\n", app::oneLine(error.what()).c_str());
    }
    return app::kFailed;
}
