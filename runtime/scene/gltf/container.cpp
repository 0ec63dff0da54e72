// Bytes to JSON: the text and the binary container (GLB), with limits against hostile files.
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/gltf/stages.h"
#include "scene/json_at.h"

namespace obscura::scene::gltf {
namespace {

// Nesting levels: enough for any exporter's extras, and few enough for the stack of the recursive passes that follow.
constexpr int kMaxDepth = 64;

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
            if (++depth > kMaxDepth) context.fail("", fmt::format("JSON is nested deeper than {} levels", kMaxDepth));
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

std::unique_ptr<nlohmann::json> parseText(const Context& context, std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) context.fail("", "starts with a byte-order mark, which glTF forbids; save as UTF-8 without it");
    checkDepth(context, text);
    try {
        return std::make_unique<nlohmann::json>(nlohmann::json::parse(text.begin(), text.end()));
    } catch (const nlohmann::json::exception& error) {
        std::string_view what = error.what();
        // Removes the library's own error code.
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
    constexpr size_t kMaxWarnings = 100;
    if (warnings.size() < kMaxWarnings) warnings.push_back(errorLine(file, pointer, what));
}

void Context::spend(uint64_t bytes, std::string_view pointer) {
    if (bytes > budget) fail(pointer, "exceeds the loader's memory limit; split the model or raise maxBytes");
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
    // Pipes and devices can block or never end.
    if (!std::filesystem::is_regular_file(file, error))
        context.fail(pointer, fmt::format("{} is missing or not a file", file.filename().string()));
    const uint64_t size = std::filesystem::file_size(file, error);
    if (error) context.fail(pointer, fmt::format("{} cannot be read: {}", file.filename().string(), error.message()));
    if (size > limit)
        context.fail(pointer, fmt::format("{} has {} bytes, above the loader's limit of {}", file.filename().string(), size, limit));
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
        context.fail("", fmt::format("is binary glTF version {}; export as version 2", version));
    const size_t length = word(bytes, 8);
    if (length > bytes.size())
        context.fail("", fmt::format("is truncated: it has {} of {} bytes; copy or export it again", bytes.size(), length));
    if (length < bytes.size()) context.warn("", fmt::format("{} bytes after the end of the container are ignored", bytes.size() - length));

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
            if (index != 1) context.fail("", fmt::format("the BIN chunk must be the second; it is number {}", index + 1));
            document.chunk.assign(bytes.begin() + ptrdiff_t(offset), bytes.begin() + ptrdiff_t(offset + size));
            document.hasChunk = true;
        }
        offset += size;
    }
    if (!document.json) context.fail("", "has no JSON chunk");
    return document;
}

}  // namespace obscura::scene::gltf
