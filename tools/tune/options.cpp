#include "options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/arguments.h"
#include "app/complaint.h"
#include "measure/arguments.h"
#include "space.h"

namespace obscura::tune {

std::optional<Options> parseOptions(int argc, const char* const* argv) {
    Options options;
    CLI::App cli{
        "Searches a method's parameters for the least error within limits of time and flicker, and measures the result on held-out places.",
        "obscura-tune"};
    cli.set_help_flag("-h,--help", "Print this and exit");
    cli.set_version_flag("--version", "Obscura " OBSCURA_VERSION);
    cli.footer(
        "The search starts at a hand-set preset. Time, error and flicker are ratios to that preset, measured in turns. The\n"
        "best settings of the training places are measured again, and the winner also on held-out places and scenes. Writes to --out:\n"
        "a log for each preset (an interrupted search resumes from it; with it, the same seed gives the same result), tune.json, tune.md "
        "with the presets'\n"
        "values in the syntax of a method's source.\n\n"
        "Examples:\n"
        "  obscura-tune --method hbao --preset tuned --out out/tune\n"
        "  obscura-tune --method all --evaluations 120 --train toasters@2,atrium@4 --held-out atrium@25,sponza@4\n"
        "  obscura-tune --clock cycles --method gtao --preset tuned\n"
        "  obscura-tune --method layered --time 2 --parameters slices,steps,sheet                   least error at twice the time");
    cli.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    measure::CandidateOptions chosen;
    std::vector<std::string> training{"toasters@2", "toasters@7", "atrium@4", "atrium@16"},
        heldOut{"toasters@11", "atrium@25", "sponza@4", "dragon@4"};
    std::vector<std::string> falloffs{"quadratic:2", "exponential:1"};
    std::string size = "160x90", out = "out/tune", clock = "ms";
    uint32_t frames = 4;
    bool noCache = false;
    using measure::takeAll;

    cli.option_defaults()->group("Search");
    addCandidateOptions(cli, chosen);
    takeAll(cli.add_option("--parameters", options.parameters,
        "Parameters to search, or METHOD.PARAMETER (default: all numeric parameters of the method's own)"));
    cli.add_option("--clock", clock,
           "ms: time on this device; cycles: GPU cycles on navi21, which Mesa's compiler counts without a GPU, with bytes as a guard")
        ->check(CLI::IsMember({"ms", "cycles"}))
        ->capture_default_str();
    cli.add_option("--time", options.limits.time, "Limit of time, relative to the preset")
        ->check(CLI::Range(0.01, 100.0))
        ->capture_default_str();
    cli.add_option("--flicker", options.limits.flicker, "Limit of flicker, relative to the preset")
        ->check(CLI::Range(0.01, 100.0))
        ->capture_default_str();
    cli.add_option("--evaluations", options.evaluations, "Settings measured in a search")
        ->check(CLI::Range(4u, 100000u))
        ->capture_default_str();
    cli.add_option("--rounds", options.rounds, "How often the best settings are measured again, and the winner on held-out places")
        ->check(CLI::Range(3u, 1000u))
        ->capture_default_str();
    cli.add_option("--seed", options.seed, "Seed of the search")->capture_default_str();

    cli.option_defaults()->group("Places");
    takeAll(
        cli.add_option(
               "--train", training, "SCENE@SECONDS on the scene's flythrough, or FILE.json@SECONDS, a recorded path; several with commas")
            ->capture_default_str());
    takeAll(cli.add_option("--held-out", heldOut, "Held-out places, on which the winner is measured; missing scenes are left out")
            ->capture_default_str());
    takeAll(cli.add_option("--falloff", falloffs, "KIND:LENGTH in metres, or ramp:START:END; several with commas")->capture_default_str());
    cli.add_option("--size", size, "WIDTHxHEIGHT in pixels, without guard band")->capture_default_str();
    cli.add_option("--frames", frames, "Frames flown at each place")->check(CLI::Range(2u, 10000u))->capture_default_str();
    cli.add_option("--rays", options.flight.rays, "Rays per pixel of the references")
        ->check(CLI::Range(32u, 65536u))
        ->capture_default_str();
    cli.add_flag("--no-cache", noCache, "Trace references again and do not cache them (default: cached in the user's cache folder)");

    cli.option_defaults()->group("Output");
    cli.add_option("--out", out, "Folder of the results")->capture_default_str();
    cli.add_flag("--again", options.again, "Search again instead of resuming from the folder");
    measure::addDevice(cli, options.device, options.validation, options.verbose);
    if (!app::parse(cli, argc, argv)) return std::nullopt;

    options.command = measure::commandOf("obscura-tune", argc, argv);
    options.out = out;
    options.cycles = clock == "cycles";
    if (options.cycles) options.rounds = 1;  // the same again
    for (const measure::Candidate& hand : measure::candidates(chosen.methods, chosen.presets, chosen.allSets()))
        if (hand.info().needs) options.hands.push_back(hand);
    if (options.hands.empty()) throw app::Complaint("--method none: has no parameters to search");
    for (const measure::Candidate& hand : options.hands) Space(hand, options.parameters);
    for (const std::string& text : training) options.training.push_back(placeOf(text, "--train"));
    for (const std::string& text : heldOut) {
        for (const Place& place : options.training)
            if (place.text == text) throw app::Complaint(fmt::format("--held-out {}: also a training place; name another", text));
        try {
            options.heldOut.push_back(placeOf(text, "--held-out"));
        } catch (const app::Complaint&) {
            if (cli.count("--held-out")) throw;  // missing default places are left out
        }
    }
    if (options.heldOut.empty()) throw app::Complaint("--held-out: none of the places is on this machine; name one");
    options.falloffs = measure::falloffs(falloffs);
    options.flight.size = app::sizeOf(size);
    options.flight.length = options.flight.end = frames;
    options.flight.seed = 1;
    options.flight.cache = !noCache;
    options.flight.pictures = options.flight.still = false;
    return options;
}

}  // namespace obscura::tune
