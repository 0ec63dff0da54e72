#include "app/picture.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include "app/complaint.h"
#include "app/files.h"

namespace obscura::app {

Picture Picture::half() const {
    Picture small{width / 2, height / 2, {}};
    small.rgba.resize(size_t(small.width) * small.height * 4);
    for (uint32_t y = 0; y < small.height; ++y)
        for (uint32_t x = 0; x < small.width; ++x)
            for (uint32_t c = 0; c < 4; ++c) {
                const size_t top = (size_t(2 * y) * width + 2 * x) * 4 + c;
                const size_t bottom = top + size_t(width) * 4;
                const int sum = rgba[top] + rgba[top + 4] + rgba[bottom] + rgba[bottom + 4];
                small.rgba[(size_t(y) * small.width + x) * 4 + c] = uint8_t((sum + 2) / 4);
            }
    return small;
}

std::vector<std::byte> encodePng(const Picture& picture) {
    std::vector<uint8_t> rgb(size_t(picture.width) * picture.height * 3);
    for (size_t i = 0; i < rgb.size() / 3; ++i)
        for (size_t c = 0; c < 3; ++c) rgb[3 * i + c] = picture.rgba[4 * i + c];
    std::vector<std::byte> png;
    const auto append = [](void* context, void* data, int size) {
        auto& out = *static_cast<std::vector<std::byte>*>(context);
        const auto* bytes = static_cast<const std::byte*>(data);
        out.insert(out.end(), bytes, bytes + size);
    };
    if (!stbi_write_png_to_func(append, &png, int(picture.width), int(picture.height), 3, rgb.data(), int(picture.width) * 3))
        throw Complaint("a picture could not be encoded as PNG: out of memory", kFailed);
    return png;
}

void writePng(const std::filesystem::path& file, const Picture& picture) { writeFile(file, encodePng(picture)); }

}  // namespace obscura::app
