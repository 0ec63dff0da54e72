// libFuzzer on captured frames: any JSON and EXR give a frame that passes its own check, or one line. An input is the JSON's length in two
// bytes, the JSON, and the EXR.
#include <iterator>

#include "target.h"
#include "truth/captured_frame.h"

namespace {

std::vector<uint8_t> bytesOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<uint8_t> joined(const std::vector<uint8_t>& json, const std::vector<uint8_t>& exr) {
    std::vector<uint8_t> input{uint8_t(json.size() & 255), uint8_t(json.size() >> 8)};
    input.insert(input.end(), json.begin(), json.end());
    input.insert(input.end(), exr.begin(), exr.end());
    return input;
}

const std::vector<uint8_t>& sample() {
    static const std::vector<uint8_t> bytes = [] {
        using namespace obscura;
        truth::CapturedFrame frame = truth::emptyFrame({8, 4}, {1, 1}, 1.0f, 0.1f, scene::Camera());
        for (size_t i = 0; i < frame.depth.size(); i += 2) frame.depth[i] = 1.0f + float(i), frame.normals[i] = {0, 0, 1};
        const std::filesystem::path stem = fuzz::file("sample", {});
        truth::writeCapture(stem, frame);
        return joined(bytesOf(stem.string() + ".json"), bytesOf(stem.string() + ".capture.exr"));
    }();
    return bytes;
}

}  // namespace

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned seed) {
    std::mt19937 random(seed);
    if (size < 8 && sample().size() <= maxSize) {
        std::copy(sample().begin(), sample().end(), data);
        return sample().size();
    }
    const size_t length = size < 2 ? 0 : data[0] + 256u * data[1];
    if (size < 2 || length > size - 2) return LLVMFuzzerMutate(data, size, maxSize);
    std::vector<uint8_t> json(data + 2, data + 2 + length), exr(data + 2 + length, data + size);
    std::vector<uint8_t>& part = random() % 2 ? json : exr;
    const size_t before = part.size();
    part.resize(before + 256);
    const size_t after = &part == &json ? obscura::fuzz::mutateJsonText(part.data(), before, part.size(), seed, "{\"near\":1}")
                                        : LLVMFuzzerMutate(part.data(), before, part.size());
    part.resize(after);
    const std::vector<uint8_t> input = joined(json, exr);
    if (input.size() > maxSize || json.size() > 65535) return size;
    std::copy(input.begin(), input.end(), data);
    return input.size();
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace obscura;
    const size_t length = size < 2 ? 0 : data[0] + 256u * data[1];
    if (size < 2 || length > size - 2) return 0;
    std::filesystem::path stem = fuzz::file("frame.json", {data + 2, length});
    fuzz::file("frame.capture.exr", {data + 2 + length, size - 2 - length});
    stem.replace_extension();
    fuzz::expectOneLine([&] {
        truth::CapturedFrame frame = truth::readCapture(stem);
        frame.check("fuzz");
        if (!frame.hasNormals()) frame.reconstructNormals();
        frame.check("fuzz");
        if (frame.visibleMask().size() != size_t(frame.visible().x) * frame.visible().y) std::abort();
    });
    return 0;
}
