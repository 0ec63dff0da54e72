#include "part.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/complaint.h"

namespace obscura::flythrough {

using Json = nlohmann::ordered_json;

std::string Part::label() const {
    std::string text = method;
    if (preset != "default") text += " " + preset;
    if (!settings.empty()) text += " " + settings;
    return text;
}

std::string Part::name() const {
    std::string text = flythrough + "." + label() + "." + filter;
    for (char& c : text)
        if (!std::isalnum((unsigned char)c) && c != '.' && c != '-') c = '_';
    return text;
}

Summary summarize(const Part& part) {
    Summary s;
    double steps = 0.0, worst = -1.0;
    for (const FrameRow& row : part.frames) {
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
    const double frames = std::max<double>(1.0, double(part.frames.size()));
    s.eA /= frames, s.bias /= frames;
    if (steps > 0.0) s.difference /= steps, s.excess /= steps, s.flickerOfError /= steps, s.referenceFlicker /= steps;
    if (part.still) s.noiseMean = part.still->mean, s.noiseP99 = part.still->p99;
    for (const EventRow& row : part.events) s.t90 = std::max(s.t90, row.t90), s.ghost += row.ghost;
    for (const PassRow& row : part.passes) s.milliseconds += row.median;
    return s;
}

std::string partText(const Part& part) {
    Json json{{"key", part.key}, {"flythrough", part.flythrough}, {"method", part.method}, {"preset", part.preset},
        {"settings", part.settings}, {"filter", part.filter}, {"falloff", part.falloff}, {"width", part.width}, {"height", part.height},
        {"rays", part.rays}, {"first", part.first}, {"end", part.end}, {"pictures", part.pictures}};
    json["frames"] = Json::array();
    for (const FrameRow& r : part.frames)
        json["frames"].push_back(
            {r.frame, r.time, r.eA, r.bias, r.rmse, r.share, r.difference, r.referenceDifference, r.flickerOfError, r.referenceFlicker});
    json["events"] = Json::array();
    for (const EventRow& r : part.events) json["events"].push_back({r.frame, r.pixels, r.t90, r.ghost});
    if (part.still) json["static"] = {part.still->mean, part.still->p99};
    json["passes"] = Json::array();
    for (const PassRow& r : part.passes) json["passes"].push_back({r.name, r.median, r.p95});
    return json.dump(1) + "\n";
}

std::optional<Part> readPart(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) return std::nullopt;
    try {
        const Json json = Json::parse(std::string(std::istreambuf_iterator<char>(in), {}));
        Part part;
        part.key = json.at("key");
        part.flythrough = json.at("flythrough");
        part.method = json.at("method");
        part.preset = json.at("preset");
        part.settings = json.at("settings");
        part.filter = json.at("filter");
        part.falloff = json.at("falloff");
        part.width = json.at("width");
        part.height = json.at("height");
        part.rays = json.at("rays");
        part.first = json.at("first");
        part.end = json.at("end");
        part.pictures = json.at("pictures");
        for (const Json& r : json.at("frames"))
            part.frames.push_back({r.at(0), r.at(1), r.at(2), r.at(3), r.at(4), r.at(5), r.at(6), r.at(7), r.at(8), r.at(9)});
        for (const Json& r : json.at("events")) part.events.push_back({r.at(0), r.at(1), r.at(2), r.at(3)});
        if (json.contains("static")) part.still = StaticRow{json["static"].at(0), json["static"].at(1)};
        for (const Json& r : json.at("passes")) part.passes.push_back({r.at(0), r.at(1), r.at(2)});
        return part;
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

std::vector<Part> joined(std::vector<Part> parts) {
    std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.first < b.first; });
    std::map<std::string, Part> whole;
    std::vector<std::string> order;
    for (Part& part : parts) {
        auto [at, fresh] = whole.try_emplace(part.name());
        Part& all = at->second;
        if (fresh) {
            order.push_back(part.name());
            all = std::move(part);
            continue;
        }
        const std::string what = all.name();
        if (part.key != all.key)
            throw app::Complaint(fmt::format("{}: chunks with different settings; size, rays, falloff and program must be equal", what));
        if (part.first != all.end)
            throw app::Complaint(fmt::format("{}: frames {} to {} are {}; give every chunk once", what, std::min(part.first, all.end),
                std::max(part.first, all.end) - 1, part.first > all.end ? "missing" : "given twice"));
        all.end = part.end;
        all.frames.insert(all.frames.end(), part.frames.begin(), part.frames.end());
        all.events.insert(all.events.end(), part.events.begin(), part.events.end());
        if (part.still) all.still = part.still;
    }
    std::sort(order.begin(), order.end());
    std::vector<Part> list;
    for (const std::string& name : order) list.push_back(std::move(whole[name]));
    return list;
}

namespace {

std::string head(const Part& p) { return fmt::format("{},{},{},{},{}", p.flythrough, p.method, p.preset, p.settings, p.filter); }
constexpr const char* kHead = "flythrough,method,preset,settings,filter";

}  // namespace

std::string framesCsv(const std::vector<Part>& parts) {
    std::string text = fmt::format(
        "{},frame,seconds,eA,bias,rmse,share,difference,reference_difference,excess_flicker,flicker_of_error,reference_flicker\n", kHead);
    for (const Part& part : parts)
        for (const FrameRow& r : part.frames)
            text += fmt::format("{},{},{:.6g},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", head(part), r.frame,
                r.time, r.eA, r.bias, r.rmse, r.share, r.difference, r.referenceDifference, r.difference - r.referenceDifference,
                r.flickerOfError, r.referenceFlicker);
    return text;
}

std::string eventsCsv(const std::vector<Part>& parts) {
    std::string text = fmt::format("{},frame,pixels,t90_frames,ghost\n", kHead);
    for (const Part& part : parts)
        for (const EventRow& r : part.events) text += fmt::format("{},{},{},{},{:.6f}\n", head(part), r.frame, r.pixels, r.t90, r.ghost);
    return text;
}

std::string staticCsv(const std::vector<Part>& parts) {
    std::string text = fmt::format("{},noise_mean,noise_p99\n", kHead);
    for (const Part& part : parts)
        if (part.still) text += fmt::format("{},{:.7f},{:.7f}\n", head(part), part.still->mean, part.still->p99);
    return text;
}

std::string passesCsv(const std::vector<Part>& parts) {
    std::string text = fmt::format("{},pass,median_ms,p95_ms\n", kHead);
    for (const Part& part : parts)
        for (const PassRow& r : part.passes) text += fmt::format("{},{},{:.4f},{:.4f}\n", head(part), r.name, r.median, r.p95);
    return text;
}

}  // namespace obscura::flythrough
