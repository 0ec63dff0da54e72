// Runs the loader's stages in order; each has its own file of this folder.
#include "scene/gltf/gltf.h"

#include <new>

#include <fmt/format.h>
#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

#include "scene/gltf/stages.h"
#include "scene/json_at.h"

namespace obscura::scene {
namespace {

std::shared_ptr<const Model> load(gltf::Context& context, gltf::Bytes bytes, const LoadOptions& options, std::string name) {
    try {
        context.spend(bytes.size(), "");
        context.addToHash(bytes);
        gltf::Document document = gltf::readDocument(context, std::move(bytes));
        gltf::checkDocument(context, *document.json, document.hasChunk);
        gltf::Asset asset = gltf::parse(context, document, options.loadImages);
        gltf::unpackViews(context, asset);

        auto model = std::make_shared<Model>();
        model->name = std::move(name);
        gltf::addMaterials(context, asset, options.loadImages, *model);
        gltf::addMeshes(context, asset, *model);
        gltf::addNodes(context, asset, options.scene, *model);
        gltf::moveToLocalOrigin(context, asset, *model);
        gltf::addAnimations(context, asset, *model);
        const uint8_t choice = uint8_t(options.scene + 1);
        context.addToHash({&choice, 1});
        model->hash = context.hash;
        model->extensions = std::move(context.extensions);
        model->variants = std::move(context.variants);
        model->warnings = std::move(context.warnings);
        return model;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        context.fail("", "out of memory; split the model or use smaller images");
    } catch (const std::exception& error) {  // from the libraries used by the stages
        context.fail("", fmt::format("cannot be read: {}", error.what()));
    }
}

}  // namespace

std::shared_ptr<const Model> loadGltf(const std::filesystem::path& file, const LoadOptions& options) {
    gltf::Context context;
    context.file = file.string();
    context.budget = options.maxBytes;
    std::error_code error;
    const std::filesystem::path parent = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    context.folder = std::filesystem::canonical(parent, error);
    if (error) context.fail("", fmt::format("cannot be opened: {}", error.message()));
    gltf::Bytes bytes = gltf::readFile(context, file, "", context.budget);
    return load(context, std::move(bytes), options, file.stem().string());
}

std::shared_ptr<const Model> loadGltfMemory(std::span<const uint8_t> bytes, const std::string& name, const LoadOptions& options) {
    gltf::Context context;
    context.file = name;
    context.budget = options.maxBytes;
    return load(context, gltf::Bytes(bytes.begin(), bytes.end()), options, std::filesystem::path(name).stem().string());
}

}  // namespace obscura::scene
