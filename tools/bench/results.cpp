#include "results.h"

#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "app/complaint.h"
#include "app/statistics.h"
#include "scene/json_text.h"

namespace obscura::bench {

using app::digits;

std::string Row::label() const {
    std::string text = method;
    if (preset != "default") text += " " + preset;
    if (!settings.empty()) text += " " + settings;
    return text;
}

std::string Row::place() const { return fmt::format("{} {} {}x{} {}", scene, camera, width, height, falloff); }

const ErrorRow* Row::against(const std::string& reference) const {
    for (const ErrorRow& error : errors)
        if (error.reference == reference) return &error;
    return nullptr;
}

Json toJson(const Row& r) {
    Json json{{"method", r.method}, {"preset", r.preset}, {"settings", r.settings}, {"baseline", r.baseline}, {"scene", r.scene},
        {"camera", r.camera}, {"width", r.width}, {"height", r.height}, {"falloff", r.falloff}, {"triangles", r.triangles},
        {"reach", digits(r.reach)}, {"varied", r.varied}, {"samples", r.samples}, {"bytes", r.bytes}};
    Json& ms = json["milliseconds"];
    ms["median"] = digits(r.median);
    ms["p95"] = digits(r.p95);
    ms["frame"] = digits(r.frame);
    ms["rounds"] = Json::array();
    for (const double round : r.rounds) ms["rounds"].push_back(digits(round));
    ms["passes"] = Json::array();
    for (const PassTime& pass : r.passes)
        ms["passes"].push_back({{"name", pass.name}, {"median", digits(pass.median)}, {"p95", digits(pass.p95)}});
    json["errors"] = Json::array();
    for (const ErrorRow& e : r.errors)
        json["errors"].push_back({{"reference", e.reference}, {"eA", digits(e.eA)}, {"bias", digits(e.bias)}, {"rmse", digits(e.rmse)},
            {"p99", digits(e.p99)}, {"ssim", digits(e.ssim)}});
    if (r.flicker) json["flicker"] = {{"ofError", digits(r.flicker->ofError)}, {"ofReference", digits(r.flicker->ofReference)}};
    if (r.gpu)
        json["gpu"] = {{"cycles", digits(r.gpu->cycles)}, {"guessed", r.gpu->guessed}, {"ms_arithmetic", digits(r.gpu->arithmeticMs)},
            {"ms_memory", digits(r.gpu->memoryMs)}, {"vgprs", r.gpu->registers}, {"waves", r.gpu->waves}, {"geometry", r.gpu->geometry}};
    return json;
}

Row rowOf(const Json& json) {
    Row r;
    r.method = json.at("method"), r.preset = json.at("preset"), r.settings = json.at("settings"), r.baseline = json.at("baseline");
    r.scene = json.at("scene"), r.camera = json.at("camera"), r.width = scene::count(json.at("width")),
    r.height = scene::count(json.at("height")), r.falloff = json.at("falloff");
    r.triangles = json.at("triangles").get_ref<const Json::number_unsigned_t&>(), r.reach = json.at("reach"), r.varied = json.at("varied"),
    r.samples = json.at("samples"), r.bytes = json.at("bytes").get_ref<const Json::number_unsigned_t&>();
    const Json& ms = json.at("milliseconds");
    r.median = ms.at("median"), r.p95 = ms.at("p95"), r.frame = ms.at("frame");
    r.rounds = ms.at("rounds").get<std::vector<double>>();
    for (const Json& pass : ms.at("passes")) r.passes.push_back({pass.at("name"), pass.at("median"), pass.at("p95")});
    for (const Json& e : json.at("errors"))
        r.errors.push_back({e.at("reference"), e.at("eA"), e.at("bias"), e.at("rmse"), e.at("p99"), e.at("ssim")});
    if (json.contains("flicker")) r.flicker = Flicker{json["flicker"].at("ofError"), json["flicker"].at("ofReference")};
    if (json.contains("gpu")) {
        const Json& gpu = json["gpu"];
        r.gpu = GpuCost{gpu.at("cycles"), gpu.at("ms_arithmetic"), gpu.at("ms_memory"), gpu.at("vgprs"), gpu.at("waves"), gpu.at("guessed"),
            gpu.at("geometry")};
    }
    return r;
}

std::string jsonText(const Results& results) {
    Json json{{"device", results.device}, {"command", results.command}, {"guard", digits(results.guard)}, {"frames", results.frames},
        {"warmUp", results.warmUp}, {"rounds", results.rounds}, {"rays", results.rays}, {"flickerFrames", results.flickerFrames},
        {"flickerSize", {results.flickerWidth, results.flickerHeight}}, {"gpu", results.gpu}, {"gpuCompiler", results.gpuCompiler},
        {"rows", Json::array()}};
    for (const Row& row : results.rows) json["rows"].push_back(toJson(row));
    return scene::dump(json, 1) + "\n";
}

Results readResults(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw app::Complaint(fmt::format("{}: no such file; name the bench.json of an earlier run", file.string()));
    try {
        const Json json = Json::parse(std::string(std::istreambuf_iterator<char>(in), {}));
        Results results;
        results.device = json.at("device"), results.command = json.at("command"), results.guard = json.at("guard"),
        results.frames = scene::count(json.at("frames"));
        results.warmUp = scene::count(json.at("warmUp")), results.rounds = scene::count(json.at("rounds")),
        results.rays = scene::count(json.at("rays"));
        results.flickerFrames = scene::count(json.at("flickerFrames")), results.flickerWidth = scene::count(json.at("flickerSize").at(0)),
        results.flickerHeight = scene::count(json.at("flickerSize").at(1));
        results.gpu = json.value("gpu", ""), results.gpuCompiler = json.value("gpuCompiler", "");
        for (const Json& row : json.at("rows")) results.rows.push_back(rowOf(row));
        return results;
    } catch (const Json::exception& error) {
        throw app::Complaint(fmt::format("{}: is not a bench.json of obscura-bench ({})", file.string(), app::oneLine(error.what())));
    }
}

std::string csv(const Results& results) {
    std::string text =
        "scene,camera,width,height,triangles,falloff,reach_m,method,preset,settings,baseline,median_ms,p95_ms,frame_ms,bytes,reference,eA,"
        "bias,rmse,p99,ssim,"
        "flicker_of_error,flicker_of_reference,gpu_cycles\n";
    for (const Row& r : results.rows) {
        const std::string head = fmt::format("{},{},{},{},{},{},{:g},{},{},{},{},{:.4f},{:.4f},{:.4f},{}", r.scene, r.camera, r.width,
            r.height, r.triangles, r.falloff, r.reach, r.method, r.preset, r.settings, int(r.baseline), r.median, r.p95, r.frame, r.bytes);
        const std::string tail = (r.flicker ? fmt::format("{:.6f},{:.6f},", r.flicker->ofError, r.flicker->ofReference) : ",,") +
                                 (r.gpu ? fmt::format("{:.1f}", r.gpu->cycles) : "");
        for (const ErrorRow& e : r.errors)
            text +=
                fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{}\n", head, e.reference, e.eA, e.bias, e.rmse, e.p99, e.ssim, tail);
        if (r.errors.empty()) text += fmt::format("{},,,,,,,{}\n", head, tail);
    }
    return text;
}

std::string passesCsv(const Results& results) {
    std::string text = "scene,camera,width,height,falloff,method,preset,settings,pass,median_ms,p95_ms\n";
    for (const Row& r : results.rows)
        for (const PassTime& pass : r.passes)
            text += fmt::format("{},{},{},{},{},{},{},{},{},{:.4f},{:.4f}\n", r.scene, r.camera, r.width, r.height, r.falloff, r.method,
                r.preset, r.settings, pass.name, pass.median, pass.p95);
    return text;
}

}  // namespace obscura::bench
