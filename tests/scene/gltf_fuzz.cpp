// libFuzzer on the glTF loader: any bytes give a model or an Error, and a model can be posed. Half of the mutations change a
// JSON value instead of raw bytes, since most byte mutations fail in the JSON parser.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <random>

#include <nlohmann/json.hpp>

#include "fuzz/json_mutator.h"
#include "scene/gltf/gltf.h"
#include "scene/world.h"

using obscura::fuzz::Json;
using obscura::fuzz::mutateJson;

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t maxSize);

namespace {

constexpr size_t kHead = 20;  // bytes before the JSON in the binary container

uint32_t word(const uint8_t* data) {
    uint32_t value;
    std::memcpy(&value, data, 4);
    return value;
}

}  // namespace

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned seed) {
    std::mt19937 random(seed);
    const bool binary = size > kHead && std::memcmp(data, "glTF", 4) == 0;
    const size_t start = binary ? kHead : 0;
    const size_t length = binary ? std::min<size_t>(word(data + 12), size - kHead) : size;
    // Dumping is recursive; documents deeper than the loader accepts get byte mutations.
    const auto tooDeep = [](int depth, Json::parse_event_t, Json&) { return depth < 70; };
    if (random() % 2 == 0) {
        Json json = Json::parse(data + start, data + start + length, tooDeep, false);
        if (!json.is_discarded()) {
            mutateJson(json, random);
            std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
            while (binary && text.size() % 4 != 0) text += ' ';
            const size_t tail = size - start - length, total = start + text.size() + tail;
            if (total <= maxSize) {
                std::memmove(data + start + text.size(), data + start + length, tail);
                std::memcpy(data + start, text.data(), text.size());
                if (binary) {
                    const uint32_t sizes[] = {uint32_t(total), uint32_t(text.size())};
                    std::memcpy(data + 8, sizes, 8);
                }
                return total;
            }
        }
    }
    return LLVMFuzzerMutate(data, size, maxSize);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace obscura::scene;
    LoadOptions options;
    options.maxBytes = size_t(128) << 20;
    try {
        const std::shared_ptr<const Model> model = loadGltfMemory({data, size}, "fuzz", options);
        World world;
        world.add({model});
        for (const PosedPrimitive& entry : pose(world, 0.4f))
            for (const uint32_t index : entry.primitive->indices)
                if (index >= entry.positions.size()) std::abort();
    } catch (const Error& error) {
        if (std::strchr(error.what(), '\n') != nullptr) std::abort();
    }
    return 0;
}
