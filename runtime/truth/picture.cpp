// OpenEXR input and output; the only file that includes tinyexr.
#include "truth/picture.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <tinyexr.h>
#include <unistd.h>

#include "scene/json_at.h"

namespace obscura::truth {
namespace {

constexpr int kLargestSide = 32768;
constexpr uint64_t kLargestFile = uint64_t(4) << 30;

[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what) {
    throw scene::Error(scene::errorLine(file.string(), "", what));
}

// RAII wrappers of tinyexr's C structs.
struct Header {
    EXRHeader exr;
    Header() { InitEXRHeader(&exr); }
    ~Header() { FreeEXRHeader(&exr); }
    Header(const Header&) = delete;
};
struct Image {
    EXRImage exr;
    Image() { InitEXRImage(&exr); }
    ~Image() { FreeEXRImage(&exr); }
    Image(const Image&) = delete;
};

std::string takeMessage(const char* message) {
    std::string text = message ? message : "unreadable";
    if (message) FreeEXRErrorMessage(message);
    while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
    return text;
}

std::vector<unsigned char> readBytes(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) fail(file, "is missing or not a file");
    const uintmax_t size = std::filesystem::file_size(file, error);
    if (error || size > kLargestFile) fail(file, "cannot be read, or is larger than 4 GiB");
    std::vector<unsigned char> bytes(size);
    std::ifstream in(file, std::ios::binary);
    if (!in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size))) fail(file, "cannot be read; check its permissions");
    return bytes;
}

uint64_t littleEndian(const unsigned char* at, int bytes) {
    uint64_t value = 0;
    for (int i = bytes; i-- > 0;) value = value << 8 | at[i];
    return value;
}

// Checks that every block of scan lines is inside the file and has the right line number. tinyexr would reconstruct a bad offset table, or
// read past the end [OpenEXR file layout: offset table after the header, then y, size, data].
void checkBlocks(const std::filesystem::path& file, const std::vector<unsigned char>& bytes, const EXRHeader& header, int height) {
    const auto& type = header.compression_type;
    const int lines = type == TINYEXR_COMPRESSIONTYPE_ZIP ? 16 : type == TINYEXR_COMPRESSIONTYPE_PIZ ? 32 : 1;
    const size_t blocks = size_t(height + lines - 1) / size_t(lines);
    const size_t table = header.header_len + 8;  // 8: magic number and version
    const char* truncated = "is truncated; write it again";
    if (table + blocks * 8 > bytes.size()) fail(file, truncated);
    for (size_t i = 0; i < blocks; ++i) {
        const uint64_t offset = littleEndian(bytes.data() + table + i * 8, 8);
        if (offset < table + blocks * 8 || offset > bytes.size() || bytes.size() - offset < 8) fail(file, truncated);
        const uint64_t size = littleEndian(bytes.data() + offset + 4, 4);
        if (size > bytes.size() - offset - 8) fail(file, truncated);
        const int64_t line = int32_t(littleEndian(bytes.data() + offset, 4));
        if (line != int64_t(header.data_window.min_y) + int64_t(i) * lines && header.line_order == 0)
            fail(file, "is damaged: its scan lines are out of order");
    }
}

}  // namespace

const Picture::Channel* Picture::find(std::string_view name) const {
    for (const Channel& channel : channels)
        if (channel.name == name) return &channel;
    return nullptr;
}

Plane Picture::plane(std::string_view name) const {
    const Channel* channel = find(name);
    if (!channel) {
        std::string have;
        for (const Channel& c : channels) have += (have.empty() ? "" : ", ") + c.name;
        throw scene::Error(fmt::format("no channel \"{}\" in the image; there are {}", name, have.empty() ? "none" : have));
    }
    Plane plane(width, height);
    plane.values = channel->values;
    return plane;
}

void Picture::add(std::string name, Plane plane) {
    if (channels.empty()) {
        width = plane.width;
        height = plane.height;
    }
    assert(plane.width == width && plane.height == height);
    channels.push_back({std::move(name), std::move(plane.values)});
}

Picture readExr(const std::filesystem::path& file, std::initializer_list<std::string_view> names) {
    const std::vector<unsigned char> bytes = readBytes(file);
    EXRVersion version{};
    if (ParseEXRVersionFromMemory(&version, bytes.data(), bytes.size()) != TINYEXR_SUCCESS) fail(file, "is not an OpenEXR file");
    if (version.multipart || version.non_image) fail(file, "is multipart or has deep data; save it as a single flat part");
    if (version.tiled) fail(file, "is tiled; save it with scan lines");

    Header header;
    const char* message = nullptr;
    if (ParseEXRHeaderFromMemory(&header.exr, &version, bytes.data(), bytes.size(), &message) != TINYEXR_SUCCESS)
        fail(file, fmt::format("has no readable header ({}); write it again", takeMessage(message)));
    const int64_t width = int64_t(header.exr.data_window.max_x) - header.exr.data_window.min_x + 1;
    const int64_t height = int64_t(header.exr.data_window.max_y) - header.exr.data_window.min_y + 1;
    if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
        fail(file, fmt::format("is {} x {} pixels; 1 to {} a side can be read", width, height, kLargestSide));

    std::vector<int> wanted;
    std::string have;
    for (int c = 0; c < header.exr.num_channels; ++c) have += fmt::format("{}{}", c ? ", " : "", header.exr.channels[c].name);
    for (const std::string_view name : names) {
        int found = -1;
        for (int c = 0; c < header.exr.num_channels; ++c)
            if (name == header.exr.channels[c].name) found = c;
        if (found < 0) fail(file, fmt::format("channel {} is missing; there are {}", name, have));
        wanted.push_back(found);
    }
    if (names.size() == 0)
        for (int c = 0; c < header.exr.num_channels; ++c) wanted.push_back(c);
    for (int c = 0; c < header.exr.num_channels; ++c) {
        const EXRChannelInfo& info = header.exr.channels[c];
        if (info.x_sampling != 1 || info.y_sampling != 1) fail(file, fmt::format("channel {} is subsampled; save it in full", info.name));
        if (header.exr.pixel_types[c] == TINYEXR_PIXELTYPE_HALF) header.exr.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
    }
    for (const int c : wanted)
        if (header.exr.pixel_types[c] == TINYEXR_PIXELTYPE_UINT)
            fail(file, fmt::format("channel {} holds integers; save it as float", header.exr.channels[c].name));
    checkBlocks(file, bytes, header.exr, int(height));

    Image image;
    image.exr.num_channels = header.exr.num_channels;  // number of planes that tinyexr frees on failure
    if (LoadEXRImageFromMemory(&image.exr, &header.exr, bytes.data(), bytes.size(), &message) != TINYEXR_SUCCESS) {
        InitEXRImage(&image.exr);  // clears pointers to planes that tinyexr has already freed
        fail(file, fmt::format("is damaged or truncated ({}); write it again", takeMessage(message)));
    }
    if (image.exr.width != width || image.exr.height != height || !image.exr.images) fail(file, "is damaged; write it again");

    Picture picture;
    picture.width = uint32_t(width);
    picture.height = uint32_t(height);
    for (const int c : wanted) {
        const float* values = reinterpret_cast<const float*>(image.exr.images[c]);
        picture.channels.push_back({header.exr.channels[c].name, std::vector<float>(values, values + width * height)});
    }
    return picture;
}

void writeExr(const std::filesystem::path& file, const Picture& picture) {
    if (picture.channels.empty() || picture.width == 0 || picture.height == 0) fail(file, "nothing to write: the image is empty");
    // OpenEXR stores channels in alphabetical order.
    std::vector<const Picture::Channel*> sorted;
    for (const Picture::Channel& channel : picture.channels) sorted.push_back(&channel);
    std::sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) { return a->name < b->name; });

    const size_t count = sorted.size();
    std::vector<EXRChannelInfo> infos(count);
    std::vector<int> types(count, TINYEXR_PIXELTYPE_FLOAT);
    std::vector<unsigned char*> planes(count);
    for (size_t c = 0; c < count; ++c) {
        assert(sorted[c]->values.size() == size_t(picture.width) * picture.height);
        std::memset(&infos[c], 0, sizeof infos[c]);
        sorted[c]->name.copy(infos[c].name, sizeof infos[c].name - 1);
        planes[c] = reinterpret_cast<unsigned char*>(const_cast<float*>(sorted[c]->values.data()));  // tinyexr only reads
    }
    EXRHeader header;  // points to the arrays above, hence not freed
    InitEXRHeader(&header);
    header.num_channels = int(count);
    header.channels = infos.data();
    header.pixel_types = header.requested_pixel_types = types.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    EXRImage image;
    InitEXRImage(&image);
    image.num_channels = int(count);
    image.images = planes.data();
    image.width = int(picture.width);
    image.height = int(picture.height);

    unsigned char* encoded = nullptr;
    const char* message = nullptr;
    const size_t bytes = SaveEXRImageToMemory(&image, &header, &encoded, &message);
    const std::unique_ptr<unsigned char, decltype(&free)> owner(encoded, &free);
    if (bytes == 0) fail(file, fmt::format("cannot be encoded ({})", takeMessage(message)));
    writeWhole(file, encoded, bytes);
}

void writeWhole(const std::filesystem::path& file, const void* bytes, size_t count) {
    std::filesystem::path temporary = file;
    temporary += fmt::format(".{}.tmp", ::getpid());
    std::error_code error;
    {
        std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
        out.write(static_cast<const char*>(bytes), std::streamsize(count));
        out.close();
        if (!out) {
            std::filesystem::remove(temporary, error);
            fail(file, "cannot be written; check that its folder exists, is writable and has free space");
        }
    }
    std::filesystem::rename(temporary, file, error);
    if (error) {
        const std::string reason = error.message();
        std::filesystem::remove(temporary, error);
        fail(file, fmt::format("cannot be replaced: {}", reason));
    }
}

}  // namespace obscura::truth
