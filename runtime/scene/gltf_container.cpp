// Bytes to JSON: the text and the binary container, with limits that keep hostile files from taking the parser down.
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/gltf_parts.h"
#include "scene/json_at.h"

namespace obscura::scene::gltf {
namespace {

// Deep enough for any exporter's extras; the recursive passes behind this stay well inside the stack.
constexpr int kDeepest = 64;

constexpr uint32_t kMagic = 0x46546c67;      // "glTF"
constexpr uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr uint32_t kBinChunk = 0x004e4942;   // "BIN\0"

uint32_t word(const Bytes& bytes, size_t offset) {
    uint32_t value;
    std::memcpy(&value, bytes.data() + offset, 4);
    return value;
}

void checkDepth(const Context& context, std::string_view text) {
    int depth = 0;
    bool inString = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (inString) {
            if (c == '\\') ++i;
            else if (c == '"') inString = false;
        } else if (c == '"') {
            inString = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kDeepest) context.fail("", fmt::format("JSON nested deeper than {} levels", kDeepest));
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

std::unique_ptr<nlohmann::json> parseText(const Context& context, std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf"))
        context.fail("", "starts with a byte-order mark, which glTF forbids; save as UTF-8 without it");
    checkDepth(context, text);
    try {
        return std::make_unique<nlohmann::json>(nlohmann::json::parse(text.begin(), text.end()));
    } catch (const nlohmann::json::exception& error) {
        std::string_view what = error.what();
        // The library's own tag at the front tells a user nothing.
        if (const size_t end = what.find("] "); end != what.npos) what.remove_prefix(end + 2);
        context.fail("", fmt::format("is not valid JSON: {}", what));
    }
}

}  // namespace

Document::Document() = default;
Document::~Document() = default;
Document::Document(Document&&) noexcept = default;

void Context::fail(std::string_view pointer, std::string_view what) const { throw Error(errorLine(file, pointer, what)); }

void Context::warn(std::string_view pointer, std::string_view what) {
    // A file with a million faults needs no million warnings.
    constexpr size_t kMost = 100;
    if (warnings.size() < kMost) warnings.push_back(errorLine(file, pointer, what));
}

void Context::spend(uint64_t bytes, std::string_view pointer) {
    if (bytes > budget) fail(pointer, "needs more memory than the loader's limit allows; split the model or raise maxBytes");
    budget -= size_t(bytes);
}

void Context::addToHash(std::span<const uint8_t> bytes) {
    constexpr uint64_t kPrime = 1099511628211ull;
    size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        uint64_t value;
        std::memcpy(&value, bytes.data() + i, 8);
        hash = (hash ^ value) * kPrime;
        hash ^= hash >> 29;
    }
    for (; i < bytes.size(); ++i) hash = (hash ^ bytes[i]) * kPrime;
    hash = (hash ^ bytes.size()) * kPrime;
}

Bytes readFile(const Context& context, const std::filesystem::path& file, std::string_view pointer, uint64_t limit) {
    std::error_code error;
    // A pipe or a device would hang or never end.
    if (!std::filesystem::is_regular_file(file, error))
        context.fail(pointer, fmt::format("{} is missing or not a file", file.filename().string()));
    const uint64_t size = std::filesystem::file_size(file, error);
    if (error) context.fail(pointer, fmt::format("{} cannot be read: {}", file.filename().string(), error.message()));
    if (size > limit) context.fail(pointer, fmt::format("{} has {} bytes, above the loader's limit", file.filename().string(), size));
    Bytes bytes(size);
    std::ifstream in(file, std::ios::binary);
    if (!in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size)))
        context.fail(pointer, fmt::format("{} cannot be read", file.filename().string()));
    return bytes;
}

Document readDocument(Context& context, Bytes bytes) {
    Document document;
    if (bytes.size() < 4) context.fail("", "is too short to be a glTF file");
    if (word(bytes, 0) != kMagic) {
        document.json = parseText(context, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        return document;
    }
    if (bytes.size() < 20) context.fail("", "ends inside the binary container's header; export it again");
    if (const uint32_t version = word(bytes, 4); version != 2)
        context.fail("", fmt::format("is binary glTF version {}; only 2 is supported", version));
    const size_t length = word(bytes, 8);
    if (length > bytes.size()) context.fail("", fmt::format("says it has {} bytes but has {}; the file was cut", length, bytes.size()));
    if (length < bytes.size()) context.warn("", fmt::format("{} bytes after its end are ignored", bytes.size() - length));

    size_t offset = 12;
    for (int index = 0; offset < length; ++index) {
        if (length - offset < 8) context.fail("", fmt::format("ends inside the header of chunk {}", index));
        const size_t size = word(bytes, offset);
        const uint32_t type = word(bytes, offset + 4);
        offset += 8;
        if (size > length - offset) context.fail("", fmt::format("chunk {} of {} bytes reaches past the end of the file", index, size));
        if (size % 4 != 0) context.fail("", fmt::format("chunk {} has {} bytes, not a multiple of four", index, size));
        if (index == 0) {
            if (type != kJsonChunk) context.fail("", "the first chunk must be JSON");
            document.json = parseText(context, {reinterpret_cast<const char*>(bytes.data()) + offset, size});
        } else if (type == kJsonChunk) {
            context.fail("", "has a second JSON chunk");
        } else if (type == kBinChunk) {
            if (index != 1) context.fail("", fmt::format("the BIN chunk must come second, it is number {}", index + 1));
            document.chunk.assign(bytes.begin() + ptrdiff_t(offset), bytes.begin() + ptrdiff_t(offset + size));
            document.hasChunk = true;
        }
        offset += size;
    }
    if (!document.json) context.fail("", "holds no JSON chunk");
    return document;
}

}  // namespace obscura::scene::gltf
