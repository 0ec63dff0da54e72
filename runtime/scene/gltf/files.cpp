// Reads the bytes of buffers and images: data URIs, the BIN chunk, and files, which must be inside the model's folder.
#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/gltf/stages.h"
#include "scene/json_at.h"

namespace obscura::scene::gltf {
namespace {

namespace fs = std::filesystem;

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string percentDecode(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0) {
            out += char(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2]));
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

Bytes base64Decode(const JsonAt& at, std::string_view text) {
    static const std::array<int8_t, 256> kTable = [] {
        std::array<int8_t, 256> table;
        table.fill(-1);
        constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (size_t i = 0; i < kDigits.size(); ++i) table[uint8_t(kDigits[i])] = int8_t(i);
        return table;
    }();
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    if (text.size() % 4 == 1) at.fail("the data URI's base64 is truncated; export the model again");
    Bytes out;
    out.reserve(text.size() / 4 * 3 + 3);
    uint32_t bits = 0;
    int bitCount = 0;
    for (const char c : text) {
        const int8_t digit = kTable[uint8_t(c)];
        if (digit < 0) at.fail("the data URI has a character that is not base64; export the model again");
        bits = bits << 6 | uint32_t(digit);
        bitCount += 6;
        if (bitCount >= 8) {
            bitCount -= 8;
            out.push_back(uint8_t(bits >> bitCount));
        }
    }
    return out;
}

bool isData(std::string_view uri) { return uri.starts_with("data:"); }

Bytes readData(const JsonAt& at, std::string_view uri) {
    const size_t comma = uri.find(',');
    if (comma == uri.npos) at.fail("the data URI has no comma before its data");
    if (!uri.substr(0, comma).ends_with(";base64")) at.fail("only base64 data URIs are supported");
    return base64Decode(at, uri.substr(comma + 1));
}

// Resolves a URI to a file. Fails unless the file, with links resolved, is inside the model's folder.
fs::path locate(const Context& context, const JsonAt& at, const std::string& uri) {
    // A scheme [RFC 3986, 3.1] has more than one letter; a single letter is a drive, refused below.
    const size_t colon = uri.find(':');
    const bool scheme = colon != uri.npos && colon > 1 && std::all_of(uri.begin(), uri.begin() + ptrdiff_t(colon), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.';
    });
    if (scheme) at.fail(fmt::format("the address \"{}\" is not fetched; put the file beside the model", uri));
    if (context.folder.empty()) at.fail(fmt::format("refers to the file \"{}\", but this model was not opened from a folder", uri));
    const std::string name = percentDecode(uri);
    if (name.empty()) at.fail("the URI is empty");
    if (name.find('\0') != name.npos) at.fail("the URI has a zero byte");
    fs::path relative(name);
    if (relative.is_absolute() || name.front() == '\\' || (name.size() > 1 && name[1] == ':'))
        at.fail(fmt::format("\"{}\" is an absolute path; only files in the model's folder are read", uri));
    std::error_code error;
    // Some exporters write names with a literal percent sign.
    if (!fs::exists(context.folder / relative, error) && fs::exists(context.folder / uri, error)) relative = uri;
    // Refused before the file is looked up: an error must not reveal which files exist elsewhere.
    if (*relative.lexically_normal().begin() == "..") at.fail(fmt::format("\"{}\" leaves the model's folder", uri));
    fs::path file = fs::canonical(context.folder / relative, error);
    if (error) at.fail(fmt::format("the file \"{}\" cannot be found beside the model", uri));
    const auto [end, rest] = std::mismatch(context.folder.begin(), context.folder.end(), file.begin(), file.end());
    if (end != context.folder.end()) at.fail(fmt::format("\"{}\" leaves the model's folder through a link", uri));
    return file;
}

}  // namespace

std::vector<Bytes> readBuffers(Context& context, Document& document) {
    std::vector<Bytes> buffers;
    const JsonAt root(context.file, *document.json);
    const auto list = root.find("buffers");
    for (size_t i = 0; list && i < list->size(); ++i) {
        const JsonAt at = list->at(i);
        const uint64_t length = at.at("byteLength").whole(1);
        Bytes bytes;
        if (const auto uri = at.find("uri")) {
            const std::string text = uri->text();
            if (isData(text)) {
                bytes = readData(*uri, text);
            } else {
                bytes = readFile(context, locate(context, *uri, text), uri->pointer(), context.budget);
                context.addToHash(bytes);
            }
        } else if (i == 0 && document.hasChunk) {
            bytes = std::move(document.chunk);
        } else {
            buffers.emplace_back();
            continue;
        }
        if (bytes.size() < length) at.fail(fmt::format("byteLength is {}, but its data has only {} bytes", length, bytes.size()));
        context.spend(bytes.size(), at.pointer());
        bytes.resize(size_t(length));
        buffers.push_back(std::move(bytes));
    }
    return buffers;
}

std::vector<Bytes> readImages(Context& context, const nlohmann::json& json, const std::vector<bool>& wanted) {
    std::vector<Bytes> images(wanted.size());
    const JsonAt root(context.file, json);
    for (size_t i = 0; i < wanted.size(); ++i) {
        const JsonAt at = root.at("images").at(i);
        const auto uri = at.find("uri");
        if (!uri) continue;
        const std::string text = uri->text();
        if (isData(text)) {
            images[i] = readData(*uri, text);
        } else {
            const fs::path file = locate(context, *uri, text);
            if (!wanted[i]) continue;
            images[i] = readFile(context, file, uri->pointer(), context.budget);
            context.addToHash(images[i]);
        }
        context.spend(images[i].size(), at.pointer());
        if (images[i].empty()) uri->fail("the image is empty");
    }
    return images;
}

}  // namespace obscura::scene::gltf
