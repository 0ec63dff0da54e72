// Loading of topologies, missing attributes, materials and textures.
#include <cmath>

#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace obscura::scene::test {
namespace {

const Primitive& only(const std::shared_ptr<const Model>& model) { return model->meshes.at(0).primitives.at(0); }

// A 1x1 PNG, red.
constexpr const char* kPixel =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC";

GltfBuilder quad(int mode) {
    GltfBuilder b;
    Json& p =
        b.mesh({{"POSITION", b.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0})}, {"NORMAL", b.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})}});
    p["mode"] = mode;
    return b;
}

TEST(Mesh, StripsAndFansKeepTheirWinding) {
    const auto strip = quad(5).load(), fan = quad(6).load();
    EXPECT_EQ(only(strip).indices, (std::vector<uint32_t>{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(only(fan).indices, (std::vector<uint32_t>{1, 2, 0, 2, 3, 0}));
}

TEST(Mesh, PointsAndLinesAreDroppedWithAWarning) {
    for (int mode = 0; mode < 4; ++mode) {
        const auto model = quad(mode).load();
        EXPECT_TRUE(model->meshes[0].primitives.empty());
        ASSERT_EQ(model->warnings.size(), 1u);
        EXPECT_TRUE(contains(model->warnings[0], "/meshes/0/primitives/0"));
    }
}

TEST(Mesh, MissingNormalsAreFlat) {
    GltfBuilder b;
    Json& p = b.mesh({{"POSITION", b.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1})}});
    p["indices"] = b.accessor(std::vector<uint16_t>{0, 1, 2, 0, 3, 1}, "SCALAR", 5123, 1);
    const auto model = b.load();
    const Primitive& out = only(model);
    ASSERT_EQ(out.positions.size(), 6u) << "flat-shaded faces do not share vertices";
    EXPECT_EQ(out.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(out.normals[5], glm::vec3(0, 1, 0));
    EXPECT_EQ(out.uv0.size(), 6u);
    EXPECT_TRUE(out.uv1.empty());
}

TEST(Mesh, FlatNormalsFollowMorphs) {
    GltfBuilder b;
    Json& p = b.triangle();
    p["targets"] = {{{"POSITION", b.vec3({0, 0, 0, -1, 0, 1, 0, 0, 0})}}};  // turns the triangle to face -x
    const auto model = b.load();
    const Primitive& out = only(model);
    EXPECT_NEAR(glm::length(out.normals[0] + out.targets[0].normals[0] - glm::vec3(-1, 0, 0)), 0.0f, 1e-6f);
}

TEST(Mesh, TangentsFollowTheTexture) {
    GltfBuilder b;
    // u along +y, v along -x: cross(n, t) = (-1,0,0) is along v, so w is -1, since green points against v.
    b.mesh({{"POSITION", b.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0})}, {"NORMAL", b.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1})},
        {"TEXCOORD_0", b.accessor(std::vector<float>{0, 1, 0, 0, 1, 1}, "VEC2", 5126, 2)}});
    const auto model = b.load();
    for (const glm::vec4& t : only(model).tangents) {
        EXPECT_NEAR(glm::length(glm::vec3(t) - glm::vec3(0, 1, 0)), 0.0f, 1e-6f);
        EXPECT_EQ(t.w, -1.0f);
    }
}

TEST(Mesh, TangentsAreValidWithoutTexture) {
    GltfBuilder b;
    b.mesh({{"POSITION", b.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0})}, {"NORMAL", b.vec3({0, 0, -1, 0, 1, 0, 0, 0, 0})}});
    const auto model = b.load();
    for (size_t i = 0; i < 3; ++i) {
        const glm::vec3 n = only(model).normals[i], t = only(model).tangents[i];
        EXPECT_NEAR(glm::length(n), 1.0f, 1e-5f);
        EXPECT_NEAR(glm::length(t), 1.0f, 1e-5f);
        EXPECT_NEAR(glm::dot(n, t), 0.0f, 1e-5f);
    }
    EXPECT_EQ(only(model).normals[2], glm::vec3(0, 0, 1)) << "a zero normal is replaced by that of the adjacent triangles";
}

TEST(Mesh, IndexOutOfRangeIsNamed) {
    GltfBuilder b;
    b.triangle()["indices"] = b.accessor(std::vector<uint16_t>{0, 1, 7}, "SCALAR", 5123, 1);
    EXPECT_EQ(b.error(), "built.gltf: /meshes/0/primitives/0/indices: index 7 at 2 is out of range, there are 3 vertices");
}

TEST(Mesh, DefaultMaterialIsAppended) {
    GltfBuilder b;
    b.triangle();
    b.json["materials"] = {{{"name", "other"}}};
    const auto model = b.load();
    ASSERT_EQ(model->materials.size(), 2u);
    EXPECT_EQ(only(model).material, 1);
    EXPECT_EQ(model->materials[1].baseColor, glm::vec4(1));
}

TEST(Material, EveryFieldIsLoaded) {
    GltfBuilder b;
    b.triangle()["material"] = 0;
    b.json["images"] = {{{"uri", kPixel}}};
    b.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"minFilter", 9729}, {"magFilter", 9728}}};
    b.json["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}};
    b.json["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_emissive_strength", "KHR_materials_unlit"};
    b.json["materials"] = {{{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}, {"doubleSided", true}, {"emissiveFactor", {0.5, 0, 1}},
        {"normalTexture", {{"index", 1}, {"scale", 2}, {"texCoord", 1}}}, {"occlusionTexture", {{"index", 1}, {"strength", 0.5}}},
        {"pbrMetallicRoughness",
            {{"metallicFactor", 0.1}, {"roughnessFactor", 0.2}, {"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                {"baseColorTexture",
                    {{"index", 0}, {"extensions", {{"KHR_texture_transform",
                                                      {{"offset", {1, 2}}, {"scale", {3, 4}}, {"rotation", 0.5}, {"texCoord", 1}}}}}}}}},
        {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}, {"KHR_materials_unlit", Json::object()}}}}};
    const auto model = b.load();
    const Material& m = model->materials[0];
    EXPECT_EQ(m.alphaMode, AlphaMode::mask);
    EXPECT_EQ(m.alphaCutoff, 0.25f);
    EXPECT_TRUE(m.doubleSided && m.unlit);
    EXPECT_EQ(m.emission, glm::vec3(2, 0, 4));
    EXPECT_EQ(m.normalScale, 2.0f);
    EXPECT_EQ(m.normalTexture.texCoord, 1);
    EXPECT_EQ(m.occlusionStrength, 0.5f);
    EXPECT_FLOAT_EQ(m.baseColor.w, 0.4f);
    const TextureUse& use = m.baseColorTexture;
    EXPECT_EQ(use.offset, glm::vec2(1, 2));
    EXPECT_EQ(use.scale, glm::vec2(3, 4));
    EXPECT_EQ(use.rotation, 0.5f);
    EXPECT_EQ(use.texCoord, 1);
    const Sampler& s = model->textures[size_t(use.texture)].sampler;
    EXPECT_TRUE(s.wrapU == Wrap::clamp && s.wrapV == Wrap::mirror && !s.linearMag && s.linearMin && !s.mipmaps);
    // One image, used as colour and as data, appears twice.
    ASSERT_EQ(model->images.size(), 2u);
    const Image& colour = model->images[size_t(model->textures[size_t(use.texture)].image)];
    const Image& data = model->images[size_t(model->textures[size_t(m.normalTexture.texture)].image)];
    EXPECT_TRUE(colour.srgb);
    EXPECT_FALSE(data.srgb);
    EXPECT_EQ(colour.rgba, (std::vector<uint8_t>{255, 0, 0, 255}));
    EXPECT_EQ(data.rgba, colour.rgba);
    LoadOptions bare;
    bare.loadImages = false;
    EXPECT_EQ(b.load(bare)->images[0].rgba, (std::vector<uint8_t>{255, 255, 255, 255}));
}

TEST(Material, DamagedImageIsNamed) {
    GltfBuilder b;
    b.triangle()["material"] = 0;
    b.json["images"] = {{{"uri", "data:image/png;base64,iVBORw0KGgo="}}};
    b.json["textures"] = {{{"source", 0}}};
    b.json["materials"] = {{{"normalTexture", {{"index", 0}}}}};
    EXPECT_TRUE(contains(b.error(), "built.gltf: /images/0: ")) << b.error();
}

TEST(Material, UnsupportedImageFormatFallsBack) {
    GltfBuilder b;
    b.triangle()["material"] = 0;
    b.json["extensionsUsed"] = {"EXT_texture_webp"};
    b.json["images"] = {{{"uri", kPixel}}, {{"uri", "data:image/webp;base64,AAAA"}}};
    b.json["textures"] = {{{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}}};
    b.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
    const auto model = b.load();
    EXPECT_EQ(model->images.size(), 1u);
    EXPECT_FALSE(model->warnings.empty());
    b.json["extensionsRequired"] = {"EXT_texture_webp"};
    EXPECT_TRUE(contains(b.error(), "needs the extension EXT_texture_webp")) << b.error();
}

}  // namespace
}  // namespace obscura::scene::test
