// Validation of a glTF file's JSON, 1 of 3: version, extensions, buffers, views, accessors. tinygltf does not report wrong types, indices
// and counts, so they are checked before it parses the file.
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/gltf/stages.h"
#include "scene/json_at.h"

namespace obscura::scene::gltf {

int componentsOf(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    if (type == "MAT4") return 16;
    return 0;
}

size_t bytesOf(int componentType) {
    switch (componentType) {
        case 5120:
        case 5121: return 1;
        case 5122:
        case 5123: return 2;
        case 5125:
        case 5126: return 4;
        default: return 0;
    }
}

size_t elementBytes(std::string_view type, int componentType) {
    const size_t size = bytesOf(componentType);
    // Matrix columns start on multiples of four bytes [glTF 2.0, 3.6.2.4].
    if (type == "MAT2") return 2 * ((2 * size + 3) & ~size_t(3));
    if (type == "MAT3") return 3 * ((3 * size + 3) & ~size_t(3));
    return size_t(componentsOf(type)) * size;
}

size_t lastElementBytes(std::string_view type, int componentType) {
    const size_t columns = type == "MAT2" ? 2 : type == "MAT3" ? 3 : 1;
    const size_t column = elementBytes(type, componentType) / columns;
    return (columns - 1) * column + size_t(componentsOf(type)) / columns * bytesOf(componentType);
}

namespace {

constexpr std::array kSupported{kDraco, kMeshopt, kTransform, kUnlit, kEmissiveStrength, kQuantization};

bool supported(const std::string& extension) { return std::find(kSupported.begin(), kSupported.end(), extension) != kSupported.end(); }

void checkAsset(const JsonAt& root) {
    const JsonAt asset = root.at("asset").expectObject();
    const auto number = [](const JsonAt& at) {
        const std::string text = at.text();
        const size_t dot = text.find('.');
        const auto digits = [](std::string_view s) {
            return !s.empty() && s.size() < 6 && std::all_of(s.begin(), s.end(), [](char c) { return c >= '0' && c <= '9'; });
        };
        if (dot == text.npos || !digits(std::string_view(text).substr(0, dot)) || !digits(std::string_view(text).substr(dot + 1)))
            at.fail(fmt::format("\"{}\" is not a version; write MAJOR.MINOR, such as 2.0", text));
        return std::pair(std::stoi(text), std::stoi(text.substr(dot + 1)));
    };
    const JsonAt version = asset.at("version");
    if (number(version).first != 2) version.fail(fmt::format("is glTF {}; export as glTF 2.0", version.text()));
    if (const auto least = asset.find("minVersion"); least && number(*least) > std::pair(2, 0))
        least->fail(fmt::format("requires glTF {}; at most 2.0 is supported", least->text()));
    for (const char* name : {"generator", "copyright"})
        if (const auto at = asset.find(name)) at->text();
}

void checkExtensions(Context& context, const JsonAt& root) {
    const auto used = root.find("extensionsUsed");
    const auto required = root.find("extensionsRequired");
    std::vector<std::string> names;
    if (used) {
        used->expectArray();
        for (size_t i = 0; i < used->size(); ++i) names.push_back(used->at(i).text());
    }
    for (size_t i = 0; required && i < required->expectArray().size(); ++i) {
        const JsonAt at = required->at(i);
        if (!supported(at.text())) at.fail(fmt::format("needs the extension {}, which is not supported; export without it", at.text()));
    }
    for (size_t i = 0; i < names.size(); ++i) {
        context.extensions.push_back({names[i], supported(names[i])});
        if (!supported(names[i])) context.warn(used->at(i).pointer(), fmt::format("the extension {} is ignored", names[i]));
    }
    constexpr const char* kVariants = "KHR_materials_variants";
    const auto extensions = root.find("extensions");
    if (!extensions || !extensions->expectObject().has(kVariants)) return;
    const JsonAt variants = extensions->at(kVariants).at("variants").expectArray();
    for (size_t i = 0; i < variants.size(); ++i)
        context.variants.push_back(variants.at(i).has("name") ? variants.at(i).at("name").text() : fmt::format("variant {}", i));
}

void checkMeshopt(const JsonAt& view, size_t bufferCount) {
    const JsonAt at = view.at("extensions").at(kMeshopt);
    const JsonAt buffer = at.at("buffer");
    buffer.index(bufferCount, "buffer");
    const uint64_t length = at.at("byteLength").whole(1);
    const uint64_t offset = at.has("byteOffset") ? at.at("byteOffset").whole() : 0;
    const std::string mode = at.at("mode").text();
    const std::string filter = at.has("filter") ? at.at("filter").text() : "NONE";
    const uint64_t stride = at.at("byteStride").whole(1, 256);
    const uint64_t count = at.at("count").whole(1, uint64_t(1) << 31);
    if (mode != "ATTRIBUTES" && mode != "TRIANGLES" && mode != "INDICES")
        at.at("mode").fail(fmt::format("unknown mode \"{}\"; use ATTRIBUTES, TRIANGLES or INDICES", mode));
    if (filter != "NONE" && filter != "OCTAHEDRAL" && filter != "QUATERNION" && filter != "EXPONENTIAL")
        at.at("filter").fail(fmt::format("unknown filter \"{}\"; use NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL", filter));
    if (mode == "ATTRIBUTES") {
        if (stride % 4 != 0) at.at("byteStride").fail("must be a multiple of four for attributes");
        if (filter == "OCTAHEDRAL" && stride != 4 && stride != 8) at.at("byteStride").fail("must be 4 or 8 for the octahedral filter");
        if (filter == "QUATERNION" && stride != 8) at.at("byteStride").fail("must be 8 for the quaternion filter");
    } else {
        if (filter != "NONE") at.at("filter").fail("only the mode ATTRIBUTES has filters; use NONE");
        if (stride != 2 && stride != 4) at.at("byteStride").fail("must be 2 or 4 for indices");
        if (mode == "TRIANGLES" && count % 3 != 0) at.at("count").fail("must be a multiple of three for triangles");
    }
    if (view.at("byteLength").whole() != count * stride)
        view.at("byteLength").fail(fmt::format("must be count * byteStride of {}: {} * {} bytes", kMeshopt, count, stride));
    if (offset > JsonAt::kLargest - length) at.fail("byteOffset and byteLength overflow");
}

bool isCompressed(const JsonAt& view) { return view.has("extensions") && view.at("extensions").has(kMeshopt); }

void checkBuffers(const JsonAt& root, bool hasChunk) {
    const auto buffers = root.find("buffers");
    const size_t count = buffers ? buffers->expectArray().size() : 0;
    for (size_t i = 0; i < count; ++i) {
        const JsonAt at = buffers->at(i).expectObject();
        at.at("byteLength").whole(1);
        if (const auto uri = at.find("uri")) uri->text();
        if (const auto name = at.find("name")) name->text();
    }
    const auto hasData = [&](size_t i) { return buffers->at(i).has("uri") || (i == 0 && hasChunk); };
    const auto within = [&](const JsonAt& at, size_t buffer) {
        const uint64_t length = at.at("byteLength").whole(1);
        const uint64_t offset = at.has("byteOffset") ? at.at("byteOffset").whole() : 0;
        const uint64_t size = buffers->at(buffer).at("byteLength").whole();
        if (offset > size || length > size - offset)
            at.fail(fmt::format("bytes {} to {} reach past the end of buffer {} ({} bytes)", offset, offset + length, buffer, size));
    };
    const auto views = root.find("bufferViews");
    for (size_t i = 0; views && i < views->expectArray().size(); ++i) {
        const JsonAt at = views->at(i).expectObject();
        const size_t buffer = at.at("buffer").index(count, "buffer");
        within(at, buffer);
        if (const auto name = at.find("name")) name->text();
        if (const auto target = at.find("target"); target && target->whole() != 34962 && target->whole() != 34963)
            target->fail("must be 34962 (vertices) or 34963 (indices)");
        if (const auto stride = at.find("byteStride"); stride && stride->whole(4, 252) % 4 != 0) stride->fail("must be a multiple of four");
        if (const auto extensions = at.find("extensions")) extensions->expectObject();
        if (!isCompressed(at)) continue;
        checkMeshopt(at, count);
        const JsonAt packed = at.at("extensions").at(kMeshopt);
        const size_t source = packed.at("buffer").index(count, "buffer");
        within(packed, source);
        if (!hasData(source)) packed.at("buffer").fail(fmt::format("buffer {} has neither a uri nor a BIN chunk", source));
    }
}

// `size` bytes at `offset` within a view.
void checkInView(const JsonAt& root, const JsonAt& at, size_t view, uint64_t offset, uint64_t size, uint64_t count) {
    const uint64_t length = root.at("bufferViews").at(view).at("byteLength").whole();
    if (offset > length || size > length - offset)
        at.fail(fmt::format(
            "{} elements, {} bytes from byte {}, reach past the end of bufferView {} ({} bytes)", count, size, offset, view, length));
}

void checkSparse(const JsonAt& root, const JsonAt& accessor, size_t viewCount, size_t element, size_t lastElement, size_t alignment) {
    const JsonAt at = accessor.at("sparse").expectObject();
    const uint64_t count = at.at("count").whole(1, accessor.at("count").whole());
    const auto check = [&](const char* key, size_t bytes, size_t last, size_t align) {
        const JsonAt from = at.at(key).expectObject();
        const size_t view = from.at("bufferView").index(viewCount, "bufferView");
        const uint64_t offset = from.has("byteOffset") ? from.at("byteOffset").whole() : 0;
        if (offset % align != 0) from.at("byteOffset").fail(fmt::format("must be a multiple of {}", align));
        if (root.at("bufferViews").at(view).has("byteStride")) from.at("bufferView").fail("sparse data must be tightly packed");
        checkInView(root, from, view, offset, (count - 1) * bytes + last, count);
    };
    const JsonAt type = at.at("indices").at("componentType");
    const uint64_t component = type.whole();
    if (component != 5121 && component != 5123 && component != 5125) type.fail("must be 5121, 5123 or 5125");
    const size_t size = bytesOf(int(component));
    check("indices", size, size, size);
    check("values", element, lastElement, alignment);
}

void checkAccessors(const JsonAt& root) {
    const auto views = root.find("bufferViews");
    const size_t viewCount = views ? views->size() : 0;
    const auto list = root.find("accessors");
    for (size_t i = 0; list && i < list->expectArray().size(); ++i) {
        const JsonAt at = list->at(i).expectObject();
        // Later stages use 32-bit element indices.
        const uint64_t count = at.at("count").whole(1, uint64_t(1) << 31);
        const uint64_t component = at.at("componentType").whole();
        if (component > 65535 || bytesOf(int(component)) == 0)
            at.at("componentType").fail(fmt::format("{} is not a component type; use 5120 to 5123, 5125 or 5126", component));
        const std::string type = at.at("type").text();
        const int components = componentsOf(type);
        if (components == 0)
            at.at("type").fail(fmt::format("\"{}\" is not an accessor type; use SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4", type));
        if (const auto normalized = at.find("normalized"); normalized && normalized->truth() && component >= 5125)
            normalized->fail("floats and 32-bit integers cannot be normalized");
        for (const char* bound : {"min", "max"})
            if (const auto values = at.find(bound)) values->expectNumbers(size_t(components));
        if (const auto name = at.find("name")) name->text();
        const size_t size = bytesOf(int(component));
        const size_t element = elementBytes(type, int(component));
        const size_t last = lastElementBytes(type, int(component));
        const uint64_t offset = at.has("byteOffset") ? at.at("byteOffset").whole() : 0;
        if (at.has("sparse")) checkSparse(root, at, viewCount, element, last, size);
        const auto view = at.find("bufferView");
        if (!view) {
            if (at.has("byteOffset")) at.at("byteOffset").fail("requires a bufferView");
            continue;
        }
        const size_t index = view->index(viewCount, "bufferView");
        const JsonAt source = views->at(index);
        uint64_t stride = element;
        if (source.has("byteStride")) {
            stride = source.at("byteStride").whole();
            if (stride < element)
                view->fail(fmt::format("bufferView {} has a byteStride of {}, but an element has {} bytes", index, stride, element));
        }
        const uint64_t base = source.has("byteOffset") ? source.at("byteOffset").whole() : 0;
        if (offset % size != 0 || (base + offset) % size != 0)
            at.fail(fmt::format("starts at byte {} of its buffer, not on a multiple of {}", base + offset, size));
        if (offset > JsonAt::kLargest) at.at("byteOffset").fail("is out of range");
        checkInView(root, at, index, offset, (count - 1) * stride + last, count);
    }
}

}  // namespace

void checkDocument(Context& context, const nlohmann::json& json, bool hasChunk) {
    const JsonAt root(context.file, json);
    root.expectObject();
    checkAsset(root);
    checkExtensions(context, root);
    for (const char* key : {"scenes", "nodes", "meshes", "skins", "cameras", "animations", "materials", "textures", "images", "samplers",
             "accessors", "bufferViews", "buffers"})
        if (const auto list = root.find(key)) {
            list->expectArray();
            for (size_t i = 0; i < list->size(); ++i) {
                const JsonAt at = list->at(i).expectObject();
                if (const auto name = at.find("name")) name->text();
                if (const auto extensions = at.find("extensions")) extensions->expectObject();
            }
        }
    checkBuffers(root, hasChunk);
    checkAccessors(root);
    checkMaterials(context, json, hasChunk);
    checkMeshes(context, json);
    checkScenes(context, json);
}

}  // namespace obscura::scene::gltf
