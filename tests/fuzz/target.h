// Shared by the fuzz targets: inputs as files, and the promise that bad input ends in one line.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <span>
#include <string>

#include "app/complaint.h"
#include "json_mutator.h"
#include "scene/gltf/gltf.h"
#include "temporary_folder.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t maxSize);

namespace obscura::fuzz {

inline std::filesystem::path file(const char* name, std::span<const uint8_t> bytes) {
    static const test::TemporaryFolder folder;
    std::ofstream(folder / name, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    return folder / name;
}

// Runs `work`, which may throw the errors of bad input, each of one line. Others end the fuzzer.
template <class Work>
void expectOneLine(const Work& work) {
    const auto check = [](const char* what) {
        if (!*what || std::strchr(what, '\n')) std::abort();
    };
    try {
        work();
    } catch (const scene::Error& error) {
        check(error.what());
    } catch (const app::Complaint& complaint) {
        check(complaint.what());
    }
}

// Replaces an input that is no JSON by the sample, changes a value of others, or changes raw bytes.
inline size_t mutateJsonText(uint8_t* data, size_t size, size_t maxSize, unsigned seed, const std::string& sample) {
    std::mt19937 random(seed);
    if (random() % 8 == 0) return LLVMFuzzerMutate(data, size, maxSize);
    const auto tooDeep = [](int depth, Json::parse_event_t, Json&) { return depth < 70; };
    Json json = Json::parse(data, data + size, tooDeep, false);
    if (json.is_discarded() || !json.is_structured() || json.empty()) json = Json::parse(sample);
    mutateJson(json, random);
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > maxSize) return LLVMFuzzerMutate(data, size, maxSize);
    std::memcpy(data, text.data(), text.size());
    return text.size();
}

}  // namespace obscura::fuzz
