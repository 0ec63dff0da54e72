#include "options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/arguments.h"
#include "app/complaint.h"
#include "arguments.h"
#include "space.h"

namespace obscura::tune {

std::optional<Options> parseOptions(int argc, const char* const* argv) {
    Options options;
    CLI::App cli{"Searches a method's parameters for the least error at a given time and flicker, and tells what that is worth where it was not searched.", "obscura-tune"};
    cli.set_help_flag("-h,--help", "Print this and exit");
    cli.set_version_flag("--version", "Obscura " OBSCURA_VERSION);
    cli.footer(
        "The hand-set preset is where the search starts and what it is held against: time, error and flicker are ratios to it, both measured in turns. The\n"
        "best settings of the training places are measured again and the winner is flown on places, and scenes, that the search never saw. Writes to --out:\n"
        "a log for each preset (an interrupted search goes on from it; with it, the same seed gives the same result), tune.json, tune.md with the presets'\n"
        "values as they stand in a method's table.\n\n"
        "Examples:\n"
        "  obscura-tune --method hbao --preset tuned --out out/tune\n"
        "  obscura-tune --method all --evaluations 120 --train toasters@2,atrium@4 --held-out atrium@25,sponza@4\n"
        "  obscura-tune --method layered --time 2 --parameters slices,steps,sheet                   what twice the time could buy");
    cli.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    evaluate::Judged judged;
    std::vector<std::string> training{"toasters@2", "toasters@7", "atrium@4", "atrium@16"}, heldOut{"toasters@11", "atrium@25", "sponza@4", "dragon@4"};
    std::vector<std::string> falloffs{"quadratic:2", "exponential:1"};
    std::string size = "160x90", out = "out/tune";
    uint32_t frames = 4;
    bool noCache = false;
    using evaluate::takeAll;

    cli.option_defaults()->group("What is searched");
    addJudged(cli, judged);
    takeAll(cli.add_option("--parameters", options.parameters, "Parameters to search, or METHOD.PARAMETER (all numbers of the method's own)"));
    cli.add_option("--time", options.limits.time, "What may be spent, in times of the preset's")->check(CLI::Range(0.01, 100.0))->capture_default_str();
    cli.add_option("--flicker", options.limits.flicker, "What may flicker, in times of the preset's")->check(CLI::Range(0.01, 100.0))->capture_default_str();
    cli.add_option("--evaluations", options.evaluations, "Settings measured in a search")->check(CLI::Range(4u, 100000u))->capture_default_str();
    cli.add_option("--rounds", options.rounds, "Times the best few are measured again, and the winner on held-out places")->check(CLI::Range(3u, 1000u))->capture_default_str();
    cli.add_option("--seed", options.seed, "Of the search")->capture_default_str();

    cli.option_defaults()->group("Where");
    takeAll(cli.add_option("--train", training, "SCENE@SECONDS on the scene's flythrough; several with commas")->capture_default_str());
    takeAll(cli.add_option("--held-out", heldOut, "Likewise: where the result is judged; scenes that are not here are left out")->capture_default_str());
    takeAll(cli.add_option("--falloff", falloffs, "KIND:LENGTH in metres, or ramp:START:END; several with commas")->capture_default_str());
    cli.add_option("--size", size, "WIDTHxHEIGHT in pixels, without guard band")->capture_default_str();
    cli.add_option("--frames", frames, "Frames flown at each place")->check(CLI::Range(2u, 10000u))->capture_default_str();
    cli.add_option("--rays", options.flight.rays, "Rays a pixel of the references")->check(CLI::Range(32u, 65536u))->capture_default_str();
    cli.add_flag("--no-cache", noCache, "Trace references anew, keep none (they lie in the user's cache folder)");

    cli.option_defaults()->group("What comes out");
    cli.add_option("--out", out, "Folder of the results")->capture_default_str();
    cli.add_flag("--again", options.again, "Search anew what the folder holds already");
    evaluate::addDevice(cli, options.device, options.validation, options.verbose);
    if (!app::parse(cli, argc, argv)) return std::nullopt;

    options.command = evaluate::commandOf("obscura-tune", argc, argv);
    options.out = out;
    for (const evaluate::Candidate& hand : evaluate::candidates(judged.methods, judged.presets, judged.allSets()))
        if (hand.info().needs) options.hands.push_back(hand);
    if (options.hands.empty()) throw app::Complaint("--method none: has nothing to search");
    for (const evaluate::Candidate& hand : options.hands) Space(hand, options.parameters);
    for (const std::string& text : training) options.training.push_back(placeOf(text, "--train"));
    for (const std::string& text : heldOut) {
        for (const Place& place : options.training)
            if (place.text == text) throw app::Complaint(fmt::format("--held-out {}: the search trains there", text));
        try {
            options.heldOut.push_back(placeOf(text, "--held-out"));
        } catch (const app::Complaint&) {
            if (cli.count("--held-out")) throw;  // the usual ones that are not on this machine are left out
        }
    }
    if (options.heldOut.empty()) throw app::Complaint("--held-out: none of the places is on this machine; name one");
    options.falloffs = evaluate::falloffs(falloffs);
    options.flight.size = app::sizeOf(size);
    options.flight.length = options.flight.end = frames;
    options.flight.seed = 1;
    options.flight.cache = !noCache;
    options.flight.pictures = options.flight.still = false;
    return options;
}

}  // namespace obscura::tune
