#include "report.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/arguments.h"
#include "app/complaint.h"
#include "app/files.h"
#include "app/page.h"
#include "app/progress.h"
#include "page.h"
#include "scene/json_text.h"

namespace obscura::flythrough {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

std::string rawKey(const Chunk& chunk) { return chunk.flythrough + "/" + chunk.label(); }

// F_e of the raw pictures, to which the filters are compared.
std::map<std::string, double> rawFlicker(const std::vector<Chunk>& chunks) {
    std::map<std::string, double> result;
    for (const Chunk& chunk : chunks)
        if (chunk.filter == "raw") result[rawKey(chunk)] = summarize(chunk).flickerOfError;
    return result;
}

std::string ratio(const std::map<std::string, double>& raw, const Chunk& chunk, const Summary& s, const char* none) {
    const auto found = raw.find(rawKey(chunk));
    return found == raw.end() || found->second <= 0.0 ? none : fmt::format("{:.2f}", s.flickerOfError / found->second);
}

}  // namespace

std::string table(const std::vector<Chunk>& chunks) {
    size_t width = 6;
    for (const Chunk& chunk : chunks) width = std::max(width, chunk.label().size());
    std::string text, flythrough;
    const std::map<std::string, double> raw = rawFlicker(chunks);
    for (const Chunk& chunk : chunks) {
        if (chunk.flythrough != flythrough) {
            flythrough = chunk.flythrough;
            text += fmt::format(
                "{}, {} x {} px, {}, frames {} to {}, {} rays, F_R {:.4f}\n  {:<{}}  filter        eA     bias      D_A   excess      F_e  "
                " of raw    noise    p99  T90   ghost       ms\n",
                flythrough, chunk.width, chunk.height, chunk.falloff, chunk.first, chunk.end - 1, chunk.rays,
                summarize(chunk).referenceFlicker, "method", width);
        }
        const Summary s = summarize(chunk);
        const auto number = [&](const char* format, double value) { return s.number(format, value, "-"); };
        text += fmt::format("  {:<{}}  {:<8}  {:>6}  {:>7}   {:>6}  {:>7}   {:>6}   {:>6}  {:>7}  {:>6}  {:>3}  {:>6}  {:7.2f}\n",
            chunk.label(), width, chunk.filter, number("{:.4f}", s.eA), number("{:+.4f}", s.bias), number("{:.4f}", s.difference),
            number("{:+.4f}", s.excess), number("{:.4f}", s.flickerOfError), ratio(raw, chunk, s, "-"), number("{:.5f}", s.noiseMean),
            number("{:.4f}", s.noiseP99), chunk.events.empty() ? "-" : std::to_string(s.t90), number("{:.4f}", s.ghost), s.milliseconds);
    }
    return text;
}

std::string markdown(const std::vector<Chunk>& chunks) {
    std::string text, flythrough;
    const std::map<std::string, double> raw = rawFlicker(chunks);
    for (const Chunk& chunk : chunks) {
        const Summary s = summarize(chunk);
        if (chunk.flythrough != flythrough) {
            text += fmt::format(
                "{}**{}**, {} x {} px, {}, frames {} to {}, {} rays; the reference's own F_R is {:.4f}.\n\n"
                "| method | filter | eA | bias | D_A | excess | F_e | of raw | noise | T90 | ghost | ms "
                "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n",
                text.empty() ? "" : "\n", chunk.flythrough, chunk.width, chunk.height, chunk.falloff, chunk.first, chunk.end - 1,
                chunk.rays, s.referenceFlicker);
            flythrough = chunk.flythrough;
        }
        const bool lag = !chunk.events.empty();
        const auto number = [&](const char* format, double value) { return s.number(format, value, ""); };
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.2f} |\n", chunk.label(), chunk.filter,
            number("{:.4f}", s.eA), number("{:+.4f}", s.bias), number("{:.4f}", s.difference), number("{:+.4f}", s.excess),
            number("{:.4f}", s.flickerOfError), ratio(raw, chunk, s, ""), number("{:.5f}", s.noiseMean), lag ? std::to_string(s.t90) : "",
            lag ? fmt::format("{:.3f}", s.ghost) : "", s.milliseconds);
    }
    return text;
}

namespace {

Json summaryJson(const Chunk& chunk) {
    const Summary s = summarize(chunk);
    Json json{{"name", chunk.name()}, {"flythrough", chunk.flythrough}, {"method", chunk.method}, {"preset", chunk.preset},
        {"settings", chunk.settings}, {"label", chunk.label()}, {"filter", chunk.filter}, {"falloff", chunk.falloff},
        {"width", chunk.width}, {"height", chunk.height}, {"rays", chunk.rays}, {"pictures", chunk.pictures},
        {"milliseconds", s.milliseconds}, {"worstFrame", s.worst}};
    if (s.frames)
        json.update({{"eA", s.eA}, {"bias", s.bias}, {"difference", s.difference}, {"excessFlicker", s.excess},
            {"flickerOfError", s.flickerOfError}, {"referenceFlicker", s.referenceFlicker}, {"noiseMean", s.noiseMean},
            {"noiseP99", s.noiseP99}});
    if (!chunk.events.empty()) json["t90"] = s.t90, json["ghost"] = s.ghost;
    json["passes"] = Json::array();
    for (const PassRow& row : chunk.passes) json["passes"].push_back({{"name", row.name}, {"median", row.median}, {"p95", row.p95}});
    json["frames"] = Json::array();
    for (const FrameRow& r : chunk.frames)
        if (r.empty) json["frames"].push_back({{"frame", r.frame}, {"seconds", r.time}});
        else
            json["frames"].push_back({{"frame", r.frame}, {"seconds", r.time}, {"eA", r.eA}, {"difference", r.difference},
                {"excessFlicker", r.difference - r.referenceDifference}, {"flickerOfError", r.flickerOfError}});
    json["events"] = Json::array();
    for (const EventRow& r : chunk.events)
        json["events"].push_back({{"frame", r.frame}, {"pixels", r.pixels}, {"t90", r.t90}, {"ghost", r.ghost}});
    return json;
}

// Writes to a temporary name and renames; false if ffmpeg failed.
bool encode(const std::string& inputs, const std::string& filter, const fs::path& file) {
    fs::path temporary = file;
    temporary += ".part.mp4";
    const std::string command = fmt::format(
        "ffmpeg -hide_banner -loglevel error -nostdin -y {} {} -c:v libx264 -preset fast -crf 14 -pix_fmt yuv420p -threads 2 {} 1>&2",
        inputs, filter, app::shellWord(temporary.string()));
    std::error_code ignored;
    if (std::system(command.c_str()) != 0) {
        fs::remove(temporary, ignored);
        return false;
    }
    fs::rename(temporary, file, ignored);
    return !ignored;
}

std::string sequence(const fs::path& folder, uint32_t first) {
    return fmt::format("-framerate 30 -start_number {} -i {}", first, app::shellWord((folder / "%04d.png").string()));
}

}  // namespace

void writeReport(const std::vector<Chunk>& chunks, const std::string& device, const fs::path& out) {
    app::writeFile(out / "frames.csv", framesCsv(chunks));
    app::writeFile(out / "events.csv", eventsCsv(chunks));
    app::writeFile(out / "static.csv", staticCsv(chunks));
    app::writeFile(out / "passes.csv", passesCsv(chunks));
    Json json{{"device", device}, {"parts", Json::array()}};
    for (const Chunk& chunk : chunks) json["parts"].push_back(summaryJson(chunk));
    app::writeFile(out / "report.json", scene::dump(json, 1) + "\n");
    app::writeFile(out / "report.md", markdown(chunks));
    const app::PageSource page{"Obscura: flythroughs", app::PageSource::Pictures::files, kPageHtml, kPageCss, kPageJs};
    app::writeFile(out / "report.html", app::page(page, scene::dump(json)));
}

void writeVideos(const std::vector<Chunk>& chunks, const fs::path& out) {
    if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0) {
        fmt::print(stderr,
            "obscura-flythrough: no videos, because ffmpeg is missing; install the package ffmpeg and run the same command again\n");
        return;
    }
    std::map<std::string, std::vector<const Chunk*>> groups;
    for (const Chunk& chunk : chunks)
        if (!chunk.pictures.empty()) groups[chunk.flythrough].push_back(&chunk);
    app::Progress progress("encoding", chunks.size() + groups.size());
    size_t done = 0;
    for (const auto& [flythrough, list] : groups) {
        std::string inputs, scaled, stack;
        int count = 0;
        std::error_code ignored;
        const auto add = [&](const fs::path& folder, uint32_t first) {
            if (!fs::is_directory(folder, ignored)) return;
            inputs += sequence(folder, first) + " ";
            stack += fmt::format("[{}:v]", count++);
        };
        add(out / "frames" / (flythrough + ".reference"), list[0]->first);
        for (const Chunk* chunk : list) {
            progress.at(done++, chunk->name());
            const fs::path folder = out / chunk->pictures;
            // yuv420p requires even sides.
            if (!encode(sequence(folder, chunk->first), "-vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2'", out / (chunk->name() + ".mp4")))
                fmt::print(stderr, "obscura-flythrough: ffmpeg could not encode {}\n", folder.string());
            add(folder, chunk->first);
        }
        progress.at(done++, flythrough);
        if (count < 2) continue;
        const int columns = count <= 4 ? 2 : count <= 9 ? 3 : 4;
        std::string layout;
        for (int i = 0; i < count; ++i) {
            const auto times = [](const char* side, int n) {
                std::string text = n ? "" : "0";
                for (int k = 0; k < n; ++k) text += fmt::format("{}{}0", k ? "+" : "", side);
                return text;
            };
            layout += fmt::format("{}{}_{}", i ? "|" : "", times("w", i % columns), times("h", i / columns));
        }
        if (!encode(inputs,
                fmt::format(
                    "-filter_complex '{}xstack=inputs={}:layout={}:fill=black,pad=ceil(iw/2)*2:ceil(ih/2)*2'", stack, count, layout),
                out / (flythrough + ".side-by-side.mp4")))
            fmt::print(stderr, "obscura-flythrough: ffmpeg could not put {} side by side\n", flythrough);
    }
}

}  // namespace obscura::flythrough
