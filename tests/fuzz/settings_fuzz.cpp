// libFuzzer on texts of falloffs and settings: any bytes give values that their text gives again, or one line. An input is lines: methods,
// presets, settings, falloffs, cameras.
#include <cmath>

#include "ao/settings_text.h"
#include "measure/candidate.h"
#include "measure/measurement.h"
#include "target.h"

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned seed) {
    const char* samples[] = {"hbao\n8x4\nhbao.steps=4,8,16\nramp:0.385:1\nscene:3",
        "all\ndefault\nresolve=temporal\nexponential:.5\npath:a.json@2", "hybrid,gtao\nall\nvoxels=64,128\nquadratic:2,constant:1\nown",
        "horizon_split\ndefault\nrays_in=voxels\nwendland:3e2\nlook.json"};
    const char* sample = samples[seed / 8 % 4];
    if ((size < 8 || seed % 64 == 0) && std::strlen(sample) <= maxSize) {
        size = std::strlen(sample);
        std::memcpy(data, sample, size);
    }
    return LLVMFuzzerMutate(data, size, maxSize);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace obscura;
    std::vector<std::string> lines(1);
    for (const uint8_t byte : std::span(data, size))
        if (byte == '\n') lines.emplace_back();
        else if (byte) lines.back() += char(byte);
    lines.resize(5);
    for (const std::string& text : lines) {
        ao::Falloff falloff, again;
        if (!ao::parseFalloff(text.c_str(), falloff)) continue;
        if (!(falloff.length > 0.0f) || !std::isfinite(falloff.length) || !std::isfinite(ao::evaluate(falloff, 1.0f))) std::abort();
        if (!ao::parseFalloff(ao::falloffText(falloff).c_str(), again) || again.length != falloff.length || again.end != falloff.end)
            std::abort();
    }
    fuzz::expectOneLine([&] {
        for (const measure::Candidate& candidate : measure::variants({lines[0]}, {lines[1]}, {lines[2]}))
            for (const ao::Parameter& parameter : candidate.info().parameters) {
                const float value = candidate.values[parameter.id];
                if (!(value >= parameter.minimum && value <= parameter.maximum)) std::abort();
            }
    });
    fuzz::expectOneLine([&] { measure::falloffs({lines[3]}); });
    fuzz::expectOneLine([&] { measure::cameraOf(lines[4]); });
    return 0;
}
