#include "app/arguments.h"

#include <charconv>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/complaint.h"

namespace obscura::app {
namespace {

[[noreturn]] void complain(const CLI::App& cli, const CLI::ParseError& error) {
    std::string text = oneLine(error.what());
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
        std::vector<std::string> known;
        for (const CLI::Option* option : cli.get_options())
            for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
        const std::vector<std::string> extras = cli.remaining();
        const std::string word = extras.empty() ? text : extras.front();
        const std::string near = nearest(word.substr(0, word.find('=')), known);
        text = fmt::format("{}: unknown option{}", word, near.empty() ? "" : fmt::format("; did you mean {}?", near));
    }
    throw Complaint(fmt::format("{} ({} --help lists all options)", text, cli.get_name()));
}

}  // namespace

std::vector<float> numbers(const std::string& text, char separator) {
    std::vector<float> list;
    const char* at = text.data();
    const char* end = at + text.size();
    while (true) {
        float value = 0.0f;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc() || !std::isfinite(value)) return {};
        list.push_back(value);
        if (next == end) return list;
        if (*next != separator || next + 1 == end) return {};
        at = next + 1;
    }
}

glm::uvec2 sizeOf(const std::string& text) {
    constexpr float kMinimum = 16.0f, kMaximum = 8192.0f;
    const std::vector<float> list = numbers(text, 'x');
    bool valid = list.size() == 2;
    for (const float side : list) valid = valid && side == std::floor(side) && side >= kMinimum && side <= kMaximum;
    if (!valid)
        throw Complaint(fmt::format(
            "--size {}: write WIDTHxHEIGHT, each a whole number from {} to {} pixels, such as 640x360", text, kMinimum, kMaximum));
    return {uint32_t(list[0]), uint32_t(list[1])};
}

std::string shellWord(const std::string& word) {
    if (!word.empty() &&
        word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%") == std::string::npos)
        return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

bool parse(CLI::App& cli, int argc, const char* const* argv) {
    try {
        cli.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        std::fputs(cli.help().c_str(), stdout);
        return false;
    } catch (const CLI::CallForVersion& version) {
        std::puts(version.what());
        return false;
    } catch (const CLI::ParseError& error) {
        complain(cli, error);
    }
    return true;
}

}  // namespace obscura::app
