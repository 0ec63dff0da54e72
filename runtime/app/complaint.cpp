#include "app/complaint.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "scene/gltf/gltf.h"

namespace obscura::app {

namespace {

// Levenshtein distance of two words, letter case ignored.
size_t distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const bool same = std::tolower((unsigned char)a[i - 1]) == std::tolower((unsigned char)b[j - 1]);
            const size_t best = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (same ? 0 : 1)});
            diagonal = row[j];
            row[j] = best;
        }
    }
    return row[b.size()];
}

}  // namespace

int guarded(const char* program, const std::function<int()>& body) {
    const auto say = [program](const std::exception& error) { fmt::print(stderr, "{}: {}\n", program, oneLine(error.what())); };
    try {
        return body();
    } catch (const Complaint& complaint) {
        say(complaint);
        return complaint.code;
    } catch (const scene::Error& error) {
        say(error);
        return kBadInput;
    } catch (const std::exception& error) {
        say(error);
        return kFailed;
    }
}

std::string nearest(std::string_view wrong, const std::vector<std::string>& names) {
    std::string best;
    size_t bestDistance = std::max<size_t>(2, wrong.size() / 3) + 1;
    for (const std::string& name : names) {
        size_t d = distance(wrong, name);
        if (wrong.size() >= 3 && name.find(wrong) != std::string::npos) d = std::min<size_t>(d, 2);
        if (d < bestDistance) {
            bestDistance = d;
            best = name;
        }
    }
    return best;
}

std::string choices(std::string_view wrong, const std::vector<std::string>& names) {
    const std::string near = nearest(wrong, names);
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return near.empty() ? fmt::format("available: {}", list) : fmt::format("did you mean {}? available: {}", near, list);
}

std::string oneLine(std::string_view text) {
    std::string line;
    for (const char c : text) {
        const bool blank = std::isspace((unsigned char)c) != 0;
        if (!blank) line += c;
        else if (!line.empty() && line.back() != ' ') line += ' ';
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

}  // namespace obscura::app
