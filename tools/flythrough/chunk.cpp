#include "chunk.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/complaint.h"
#include "scene/json_text.h"

namespace obscura::flythrough {

using Json = nlohmann::ordered_json;

std::string Chunk::label() const {
    std::string text = method;
    if (preset != "default") text += " " + preset;
    if (!settings.empty()) text += " " + settings;
    return text;
}

std::string Chunk::name() const {
    std::string text = flythrough + "." + label() + "." + filter;
    for (char& c : text)
        if (!std::isalnum((unsigned char)c) && c != '.' && c != '-') c = '_';
    return text;
}

std::string Summary::number(const char* format, double value, const char* none) const {
    return frames ? fmt::format(fmt::runtime(format), value) : none;
}

Summary summarize(const Chunk& chunk) {
    Summary s;
    double steps = 0.0, worst = -1.0;
    for (const FrameRow& row : chunk.frames) {
        if (row.empty) continue;
        ++s.frames;
        s.eA += row.eA;
        s.bias += row.bias;
        if (row.eA > worst) worst = row.eA, s.worst = row.frame;
        if (row.frame == 0) continue;
        s.difference += row.difference;
        s.excess += row.difference - row.referenceDifference;
        s.flickerOfError += row.flickerOfError;
        s.referenceFlicker += row.referenceFlicker;
        ++steps;
    }
    const double frames = std::max<double>(1.0, double(s.frames));
    s.eA /= frames, s.bias /= frames;
    if (steps > 0.0) s.difference /= steps, s.excess /= steps, s.flickerOfError /= steps, s.referenceFlicker /= steps;
    if (chunk.still) s.noiseMean = chunk.still->mean, s.noiseP99 = chunk.still->p99;
    for (const EventRow& row : chunk.events) s.t90 = std::max(s.t90, row.t90), s.ghost += row.ghost;
    for (const PassRow& row : chunk.passes) s.milliseconds += row.median;
    return s;
}

std::string chunkText(const Chunk& chunk) {
    Json json{{"key", chunk.key}, {"flythrough", chunk.flythrough}, {"method", chunk.method}, {"preset", chunk.preset},
        {"settings", chunk.settings}, {"filter", chunk.filter}, {"falloff", chunk.falloff}, {"width", chunk.width},
        {"height", chunk.height}, {"rays", chunk.rays}, {"first", chunk.first}, {"end", chunk.end}, {"pictures", chunk.pictures}};
    json["frames"] = Json::array();
    for (const FrameRow& r : chunk.frames)
        json["frames"].push_back(r.empty ? Json{r.frame, r.time}
                                         : Json{r.frame, r.time, r.eA, r.bias, r.rmse, r.share, r.difference, r.referenceDifference,
                                               r.flickerOfError, r.referenceFlicker});
    json["events"] = Json::array();
    for (const EventRow& r : chunk.events) json["events"].push_back({r.frame, r.pixels, r.t90, r.ghost});
    if (chunk.still) json["static"] = {chunk.still->mean, chunk.still->p99};
    json["passes"] = Json::array();
    for (const PassRow& r : chunk.passes) json["passes"].push_back({r.name, r.median, r.p95});
    return scene::dump(json, 1) + "\n";
}

std::optional<Chunk> readChunk(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) return std::nullopt;
    try {
        const Json json = Json::parse(std::string(std::istreambuf_iterator<char>(in), {}));
        Chunk chunk;
        chunk.key = json.at("key");
        chunk.flythrough = json.at("flythrough");
        chunk.method = json.at("method");
        chunk.preset = json.at("preset");
        chunk.settings = json.at("settings");
        chunk.filter = json.at("filter");
        chunk.falloff = json.at("falloff");
        chunk.width = scene::count(json.at("width"));
        chunk.height = scene::count(json.at("height"));
        chunk.rays = scene::count(json.at("rays"));
        chunk.first = scene::count(json.at("first"));
        chunk.end = scene::count(json.at("end"));
        chunk.pictures = json.at("pictures");
        for (const Json& r : json.at("frames"))
            if (r.size() == 2) chunk.frames.push_back({.frame = scene::count(r.at(0)), .time = r.at(1), .empty = true});
            else
                chunk.frames.push_back(
                    {scene::count(r.at(0)), r.at(1), r.at(2), r.at(3), r.at(4), r.at(5), r.at(6), r.at(7), r.at(8), r.at(9)});
        for (const Json& r : json.at("events"))
            chunk.events.push_back({scene::count(r.at(0)), scene::count(r.at(1)), scene::count(r.at(2)), r.at(3)});
        if (json.contains("static")) chunk.still = StaticRow{json["static"].at(0), json["static"].at(1)};
        for (const Json& r : json.at("passes")) chunk.passes.push_back({r.at(0), r.at(1), r.at(2)});
        return chunk;
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

std::vector<Chunk> joined(std::vector<Chunk> chunks) {
    std::stable_sort(chunks.begin(), chunks.end(), [](const Chunk& a, const Chunk& b) { return a.first < b.first; });
    std::map<std::string, Chunk> whole;
    std::vector<std::string> order;
    for (Chunk& chunk : chunks) {
        auto [at, fresh] = whole.try_emplace(chunk.name());
        Chunk& all = at->second;
        if (fresh) {
            order.push_back(chunk.name());
            all = std::move(chunk);
            continue;
        }
        const std::string what = all.name();
        if (chunk.key != all.key)
            throw app::Complaint(fmt::format("{}: chunks with different settings; size, rays, falloff and program must be equal", what));
        if (chunk.first != all.end)
            throw app::Complaint(fmt::format("{}: frames {} to {} are {}; give every chunk once", what, std::min(chunk.first, all.end),
                std::max(chunk.first, all.end) - 1, chunk.first > all.end ? "missing" : "given twice"));
        all.end = chunk.end;
        all.frames.insert(all.frames.end(), chunk.frames.begin(), chunk.frames.end());
        all.events.insert(all.events.end(), chunk.events.begin(), chunk.events.end());
        if (chunk.still) all.still = chunk.still;
    }
    std::sort(order.begin(), order.end());
    std::vector<Chunk> list;
    list.reserve(order.size());
    for (const std::string& name : order) list.push_back(std::move(whole[name]));
    return list;
}

namespace {

std::string head(const Chunk& p) { return fmt::format("{},{},{},{},{}", p.flythrough, p.method, p.preset, p.settings, p.filter); }
constexpr const char* kHead = "flythrough,method,preset,settings,filter";

}  // namespace

std::string framesCsv(const std::vector<Chunk>& chunks) {
    std::string text = fmt::format(
        "{},frame,seconds,eA,bias,rmse,share,difference,reference_difference,excess_flicker,flicker_of_error,reference_flicker\n", kHead);
    for (const Chunk& chunk : chunks)
        for (const FrameRow& r : chunk.frames)
            if (r.empty) text += fmt::format("{},{},{:.6g},,,,,,,,,\n", head(chunk), r.frame, r.time);
            else
                text += fmt::format("{},{},{:.6g},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", head(chunk), r.frame,
                    r.time, r.eA, r.bias, r.rmse, r.share, r.difference, r.referenceDifference, r.difference - r.referenceDifference,
                    r.flickerOfError, r.referenceFlicker);
    return text;
}

std::string eventsCsv(const std::vector<Chunk>& chunks) {
    std::string text = fmt::format("{},frame,pixels,t90_frames,ghost\n", kHead);
    for (const Chunk& chunk : chunks)
        for (const EventRow& r : chunk.events) text += fmt::format("{},{},{},{},{:.6f}\n", head(chunk), r.frame, r.pixels, r.t90, r.ghost);
    return text;
}

std::string staticCsv(const std::vector<Chunk>& chunks) {
    std::string text = fmt::format("{},noise_mean,noise_p99\n", kHead);
    for (const Chunk& chunk : chunks)
        if (chunk.still) text += fmt::format("{},{:.7f},{:.7f}\n", head(chunk), chunk.still->mean, chunk.still->p99);
    return text;
}

std::string passesCsv(const std::vector<Chunk>& chunks) {
    std::string text = fmt::format("{},pass,median_ms,p95_ms\n", kHead);
    for (const Chunk& chunk : chunks)
        for (const PassRow& r : chunk.passes) text += fmt::format("{},{},{:.4f},{:.4f}\n", head(chunk), r.name, r.median, r.p95);
    return text;
}

}  // namespace obscura::flythrough
