// Decodes PNG and JPEG to RGBA8, in parallel. One thread decodes each image, so the result does not depend on the threads' order.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf/stages.h"

namespace {

// Largest single allocation, in bytes, that stb_image may make for the image that this thread decodes. A damaged PNG can claim a chunk of a
// gigabyte, and stb_image allocates a chunk before it reads it.
thread_local size_t t_largest = 0;

void* allocate(size_t size) { return size <= t_largest ? std::malloc(size) : nullptr; }
void* reallocate(void* old, size_t size) { return size <= t_largest ? std::realloc(old, size) : nullptr; }

}  // namespace

// A private copy of stb_image, with PNG and JPEG only: other libraries in the process export the same symbols.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MALLOC(size) allocate(size)
#define STBI_REALLOC(old, size) reallocate(old, size)
#define STBI_FREE(old) std::free(old)
#include <stb_image.h>

namespace obscura::scene::gltf {
namespace {

// Bytes for stb_image's tables and rounding, beside four channels of 16 bits and the file itself.
constexpr size_t kScratch = size_t(1) << 20;
constexpr int kMaxSide = 16384;  // px; usual limit of graphics devices

// Decodes an image whose size is known. Returns an error text, empty on success: threads must not throw.
std::string decode(const Bytes& bytes, Image& image) {
    int width = 0, height = 0, channels = 0;
    t_largest = size_t(image.width) * image.height * 8 + bytes.size() * 2 + kScratch;
    const std::unique_ptr<uint8_t, void (*)(void*)> pixels{
        stbi_load_from_memory(bytes.data(), int(bytes.size()), &width, &height, &channels, 4), std::free};
    if (!pixels || uint32_t(width) != image.width || uint32_t(height) != image.height) {
        const char* reason = stbi_failure_reason();
        return fmt::format("cannot be decoded ({}); save the image again", reason != nullptr ? reason : "damaged");
    }
    try {
        image.rgba.assign(pixels.get(), pixels.get() + size_t(width) * size_t(height) * 4);
    } catch (const std::bad_alloc&) {
        return "out of memory while decoding; reduce the image's size";
    }
    return {};
}

Image white(const std::string& name, bool srgb) { return {name, 1, 1, srgb, {255, 255, 255, 255}}; }

}  // namespace

std::vector<Image> decodeImages(Context& context, const Asset& asset, const std::vector<ImageUse>& uses, bool withImages) {
    std::vector<Image> images;
    std::vector<size_t> decodes;  // uses to decode; later uses of the same source are copies
    for (size_t i = 0; i < uses.size(); ++i) {
        const auto& source = asset.gltf->images[size_t(uses[i].source)];
        images.push_back(white(source.name, uses[i].srgb));
        if (!withImages) continue;
        const std::string pointer = fmt::format("/images/{}", uses[i].source);
        int width = 0, height = 0, channels = 0;
        t_largest = source.image.size() + kScratch;
        if (source.image.size() > size_t(INT32_MAX) ||
            !stbi_info_from_memory(source.image.data(), int(source.image.size()), &width, &height, &channels))
            context.fail(pointer, "is not a readable PNG or JPEG; save the image again");
        if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
            context.fail(pointer, fmt::format("is {} x {} pixels; 1 to {} per side are supported", width, height, kMaxSide));
        context.spend(uint64_t(width) * uint64_t(height) * 4, pointer);
        images[i].width = uint32_t(width);
        images[i].height = uint32_t(height);
        const auto same =
            std::find_if(uses.begin(), uses.begin() + ptrdiff_t(i), [&](const ImageUse& u) { return u.source == uses[i].source; });
        if (same == uses.begin() + ptrdiff_t(i)) decodes.push_back(i);
    }

    std::vector<std::string> errors(uses.size());
    std::atomic<size_t> next{0};
    const auto work = [&] {
        for (size_t k = next++; k < decodes.size(); k = next++) {
            const size_t i = decodes[k];
            errors[i] = decode(asset.gltf->images[size_t(uses[i].source)].image, images[i]);
        }
    };
    std::vector<std::thread> threads;
    const size_t count = std::min<size_t>(decodes.size(), std::max(1u, std::thread::hardware_concurrency()));
    try {
        for (size_t i = 1; i < count; ++i) threads.emplace_back(work);
    } catch (const std::system_error&) {
        // The system allows no more threads; those already started do the work.
    }
    work();
    for (std::thread& thread : threads) thread.join();

    for (const size_t i : decodes)
        if (!errors[i].empty()) context.fail(fmt::format("/images/{}", uses[i].source), errors[i]);
    for (size_t i = 0; withImages && i < uses.size(); ++i)
        for (size_t k = 0; k < i && images[i].rgba.size() <= 4; ++k)
            if (uses[k].source == uses[i].source) images[i].rgba = images[k].rgba;
    return images;
}

}  // namespace obscura::scene::gltf
