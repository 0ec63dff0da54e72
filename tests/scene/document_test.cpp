// glTF containers, structure and extensions: refused files and their error lines.
#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace obscura::scene::test {
namespace {

std::string withNodes(const Json& nodes, const Json& roots = Json::array({0})) {
    GltfBuilder b;
    b.json["nodes"] = nodes;
    b.json["scenes"] = Json::array({{{"nodes", roots}}});
    return b.error();
}

TEST(Document, BinaryContainer) {
    GltfBuilder b;
    b.triangle();
    const auto text = b.load(), binary = GltfBuilder::loadText(b.binary());
    EXPECT_EQ(binary->meshes[0].primitives[0].positions, text->meshes[0].primitives[0].positions);
    EXPECT_EQ(binary->triangleCount(), 1u);
    EXPECT_NE(binary->hash, text->hash);
    EXPECT_EQ(binary->hash, GltfBuilder::loadText(b.binary())->hash);
    std::string cut = b.binary();
    cut.resize(cut.size() - 5);
    EXPECT_TRUE(contains(GltfBuilder::errorOf(cut), "built.gltf: is truncated")) << GltfBuilder::errorOf(cut);
    for (size_t size = 0; size < b.binary().size(); size += 3) EXPECT_NE(GltfBuilder::errorOf(b.binary().substr(0, size)), "");
}

TEST(Document, EveryTruncationIsOneErrorLine) {
    GltfBuilder b;
    b.triangle();
    const std::string whole = b.text();
    for (size_t size = 0; size < whole.size(); size += 5) {
        const std::string error = GltfBuilder::errorOf(whole.substr(0, size));
        EXPECT_TRUE(error.starts_with("built.gltf: ")) << error;
        EXPECT_FALSE(contains(error, "\n")) << error;
    }
}

TEST(Document, DeepNestingIsRefused) {
    const std::string deep = R"({"asset":{"version":"2.0"},"extras":)" + std::string(100000, '[') + std::string(100000, ']') + "}";
    EXPECT_TRUE(contains(GltfBuilder::errorOf(deep), "nested deeper")) << GltfBuilder::errorOf(deep);
}

TEST(Document, NewlinesInNamesAreEscaped) {
    GltfBuilder b;
    b.json["extensionsRequired"] = {"EVIL\nextension"};
    EXPECT_EQ(
        b.error(), "built.gltf: /extensionsRequired/0: needs the extension EVIL?extension, which is not supported; export without it");
}

TEST(Document, VersionsAreChecked) {
    GltfBuilder b;
    b.json["asset"]["version"] = "1.0";
    EXPECT_TRUE(contains(b.error(), "/asset/version: is glTF 1.0")) << b.error();
    b.json["asset"] = {{"version", "2.1"}, {"minVersion", "2.0"}};
    EXPECT_EQ(b.error(), "");
    b.json["asset"]["minVersion"] = "2.1";
    EXPECT_TRUE(contains(b.error(), "/asset/minVersion")) << b.error();
}

TEST(Document, UnknownUsedExtensionIsAWarning) {
    GltfBuilder b;
    b.triangle();
    b.json["extensionsUsed"] = {"KHR_materials_sheen"};
    const auto model = b.load();
    ASSERT_EQ(model->warnings.size(), 1u);
    EXPECT_TRUE(contains(model->warnings[0], "KHR_materials_sheen"));
}

TEST(Document, NodeLoopsAndSharedChildren) {
    const Json leaf = Json::object();
    EXPECT_TRUE(contains(withNodes(Json::array({{{"children", {0}}}}), Json::array()), "/nodes/0: is its own ancestor"));
    EXPECT_TRUE(contains(withNodes(Json::array({leaf, {{"children", {2}}}, {{"children", {1}}}})), "is its own ancestor"));
    EXPECT_TRUE(contains(
        withNodes(Json::array({{{"children", {2}}}, {{"children", {2}}}, leaf})), "/nodes/1/children/0: node 2 already is a child"));
    EXPECT_TRUE(contains(withNodes(Json::array({{{"children", {1}}}, leaf}), Json::array({1})), "/scenes/0/nodes/0: node 1 is not a root"));
    EXPECT_TRUE(contains(withNodes(Json::array({{{"mesh", 0}}})), "/nodes/0/mesh: mesh 0 does not exist"));
}

TEST(Document, LongChainsDoNotExhaustTheStack) {
    GltfBuilder b;
    constexpr int kCount = 50000;
    for (int i = 0; i < kCount; ++i) {
        Json node = Json::object();
        if (i + 1 < kCount) node["children"] = Json::array({i + 1});
        b.json["nodes"].push_back(std::move(node));
    }
    b.json["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
    EXPECT_EQ(b.load()->order.size(), size_t(kCount));
}

TEST(Document, WrongTypesAreNamed) {
    GltfBuilder b;
    b.triangle();
    const Json valid = b.json;
    const auto errorWith = [&](const char* pointer, const Json& value) {
        b.json = valid;
        b.json[Json::json_pointer(pointer)] = value;
        const std::string error = b.error();
        EXPECT_TRUE(contains(error, pointer)) << pointer << " -> " << error;
    };
    for (const Json& wrong : {Json(nullptr), Json("text"), Json(-1), Json(1.5), Json::array({"x"}), Json::object({{"x", 1}})}) {
        for (const char* pointer : {"/accessors/0/bufferView", "/accessors/0/count", "/accessors/0/componentType", "/bufferViews/0/buffer",
                 "/bufferViews/0/byteLength", "/nodes/0/mesh", "/meshes/0/primitives/0/attributes/POSITION"})
            errorWith(pointer, wrong);
    }
    for (const Json& wrong : {Json("text"), Json(3), Json::object()})
        for (const char* pointer : {"/nodes", "/meshes", "/accessors", "/bufferViews", "/scenes", "/meshes/0/primitives"})
            errorWith(pointer, wrong);
    errorWith("/nodes/0/rotation", Json::array({0, 0, 0, 0}));
    errorWith("/nodes/0/scale", Json::array({1, 2}));
    errorWith("/nodes/0/translation", Json::array({1, 2, 1e300}));
}

TEST(Document, ScenesAreChosen) {
    GltfBuilder b;
    b.triangle();
    b.json["nodes"].push_back({{"name", "second"}, {"children", Json::array({2})}});
    b.json["nodes"].push_back(Json::object());
    b.json["scenes"].push_back({{"nodes", {1}}});
    EXPECT_EQ(b.load()->roots, std::vector<int>{0});
    LoadOptions second;
    second.scene = 1;
    EXPECT_EQ(b.load(second)->order, (std::vector<int>{1, 2}));
    b.json["scene"] = 1;
    EXPECT_EQ(b.load()->roots, std::vector<int>{1});
    second.scene = 2;
    EXPECT_TRUE(contains(b.error(second), "/scenes: scene 2 does not exist")) << b.error(second);
    b.json.erase("scenes");
    b.json.erase("scene");
    EXPECT_EQ(b.load()->roots, (std::vector<int>{0, 1})) << "without scenes all root nodes are loaded";
}

TEST(Document, WrongMeshoptSizesAreRefused) {
    GltfBuilder b;
    b.triangle();
    b.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 0}, {"byteLength", 36}, {"byteStride", 12}, {"count", 3}, {"mode", "ATTRIBUTES"}};
    EXPECT_TRUE(contains(b.error(), "/bufferViews/0/extensions/EXT_meshopt_compression: the compressed data is damaged")) << b.error();
    b.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["byteLength"] = 37;
    EXPECT_TRUE(contains(b.error(), "reach past the end of buffer 0")) << b.error();
}

TEST(Document, DamagedDracoIsRefused) {
    GltfBuilder b;
    b.triangle()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
    EXPECT_TRUE(contains(b.error(), "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression")) << b.error();
}

TEST(Document, AttributesOfExtensionsInUseAreIgnored) {
    GltfBuilder b;
    b.triangle();
    const Json splats{{"POSITION", 0}, {"KHR_gaussian_splatting:OPACITY", b.scalars({1, 1, 1})}};
    b.json["meshes"][0]["primitives"].push_back({{"mode", 0}, {"attributes", splats}});
    b.json["extensionsUsed"] = {"KHR_gaussian_splatting", "KHR_texture_transform"};
    const auto model = b.load();
    EXPECT_EQ(model->triangleCount(), 1u);
    ASSERT_EQ(model->extensions.size(), 2u);
    EXPECT_EQ(model->extensions[0].name, "KHR_gaussian_splatting");
    EXPECT_FALSE(model->extensions[0].read);
    EXPECT_TRUE(model->extensions[1].read);
    ASSERT_FALSE(model->warnings.empty());
    EXPECT_TRUE(contains(model->warnings[0], "the extension KHR_gaussian_splatting is ignored"));
    // Of an extension that the file does not name, or that it requires.
    b.json["extensionsUsed"] = {"KHR_texture_transform"};
    EXPECT_TRUE(contains(b.error(), "KHR_gaussian_splatting:OPACITY: is not a glTF attribute"));
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_gaussian_splatting"};
    EXPECT_TRUE(contains(b.error(), "needs the extension KHR_gaussian_splatting"));
}

TEST(Document, VariantsAreListed) {
    GltfBuilder b;
    b.triangle();
    b.json["extensionsUsed"] = {"KHR_materials_variants"};
    b.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "red"}}, {{"name", "blue"}}};
    EXPECT_EQ(b.load()->variants, (std::vector<std::string>{"red", "blue"}));
}

}  // namespace
}  // namespace obscura::scene::test
