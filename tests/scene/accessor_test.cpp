// Accessors of every kind, tested through the loaded meshes.
#include <limits>

#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace obscura::scene::test {
namespace {

const Primitive& only(const std::shared_ptr<const Model>& model) { return model->meshes.at(0).primitives.at(0); }

TEST(Accessor, SparseReplacesElements) {
    GltfBuilder b;
    const int base = b.view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int where = b.view(std::vector<uint16_t>{0, 2});
    const int values = b.view(std::vector<float>{5, 6, 7, 8, 9, 10});
    b.mesh({{"POSITION", b.accessor({{"bufferView", base}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3},
                             {"sparse", {{"count", 2}, {"indices", {{"bufferView", where}, {"componentType", 5123}}},
                                            {"values", {{"bufferView", values}}}}}})}});
    const auto model = b.load();
    const Primitive& p = only(model);
    ASSERT_EQ(p.positions.size(), 3u);
    EXPECT_EQ(p.positions[0], glm::vec3(5, 6, 7));
    EXPECT_EQ(p.positions[1], glm::vec3(1, 0, 0));
    EXPECT_EQ(p.positions[2], glm::vec3(8, 9, 10));
}

TEST(Accessor, SparseWithoutBaseStartsFromZero) {
    GltfBuilder b;
    const int where = b.view(std::vector<uint8_t>{1});
    const int values = b.view(std::vector<float>{1, 2, 3});
    b.mesh({{"POSITION", b.accessor({{"componentType", 5126}, {"type", "VEC3"}, {"count", 3},
                             {"sparse", {{"count", 1}, {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                                            {"values", {{"bufferView", values}}}}}})}});
    const auto model = b.load();
    EXPECT_EQ(only(model).positions[0], glm::vec3(0));
    EXPECT_EQ(only(model).positions[1], glm::vec3(1, 2, 3));
}

TEST(Accessor, SparseIndicesMustRise) {
    GltfBuilder b;
    const int where = b.view(std::vector<uint16_t>{2, 1});
    const int values = b.view(std::vector<float>{1, 2, 3, 4, 5, 6});
    b.mesh({{"POSITION", b.accessor({{"componentType", 5126}, {"type", "VEC3"}, {"count", 3},
                             {"sparse", {{"count", 2}, {"indices", {{"bufferView", where}, {"componentType", 5123}}},
                                            {"values", {{"bufferView", values}}}}}})}});
    EXPECT_TRUE(contains(b.error(), "/accessors/0/sparse/indices: index 1 at 1")) << b.error();
}

TEST(Accessor, NormalizedIntegers) {
    GltfBuilder b;
    const int positions = b.accessor(std::vector<int16_t>{-32768, 0, 32767, 16384, 0, 0, 0, -32767, 0}, "VEC3", 5122, 3, true);
    const int colors = b.accessor(std::vector<uint8_t>{255, 0, 51, 255, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 5121, 4, true);
    const int uv = b.accessor(std::vector<uint16_t>{65535, 0, 13107, 0, 0, 0}, "VEC2", 5123, 2, true);
    b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    b.mesh({{"POSITION", positions}, {"COLOR_0", colors}, {"TEXCOORD_0", uv}});
    // Tightly packed shorts and bytes are not aligned to 4 bytes as glTF requires; the loader reads them all the same.
    const auto model = b.load();
    const Primitive& p = only(model);
    EXPECT_EQ(p.positions[0], glm::vec3(-1, 0, 1));
    EXPECT_FLOAT_EQ(p.positions[1].x, 16384.0f / 32767.0f);
    EXPECT_EQ(p.positions[2].y, -1.0f);
    EXPECT_EQ(p.colors[0], glm::vec4(1, 0, 0.2f, 1));
    EXPECT_FLOAT_EQ(p.uv0[1].x, 0.2f);
}

TEST(Accessor, PlainIntegersKeepTheirValues) {
    GltfBuilder b;
    b.mesh({{"POSITION", b.accessor(std::vector<int8_t>{-5, 0, 0, 7, 0, 0, 0, 100, 0}, "VEC3", 5120, 3)}});
    EXPECT_EQ(only(b.load()).positions[2], glm::vec3(0, 100, 0));
}

TEST(Accessor, InterleavedByStride) {
    GltfBuilder b;
    // x y z nx ny nz
    const int view = b.view(std::vector<float>{0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1}, 24);
    const Json common{{"bufferView", view}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}};
    Json normals = common;
    normals["byteOffset"] = 12;
    b.mesh({{"POSITION", b.accessor(common)}, {"NORMAL", b.accessor(normals)}});
    const auto model = b.load();
    EXPECT_EQ(only(model).positions[2], glm::vec3(0, 1, 0));
    EXPECT_EQ(only(model).normals[1], glm::vec3(0, 0, 1));
}

TEST(Accessor, IndicesOfEveryWidth) {
    const auto check = [](auto zero, int componentType) {
        using Index = decltype(zero);
        GltfBuilder b;
        Json& primitive = b.mesh({{"POSITION", b.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0})}, {"NORMAL", b.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1})}});
        primitive["indices"] = b.accessor(std::vector<Index>{2, 0, 1}, "SCALAR", componentType, 1);
        EXPECT_EQ(only(b.load()).indices, (std::vector<uint32_t>{2, 0, 1}));
    };
    check(uint8_t(), 5121);
    check(uint16_t(), 5123);
    check(uint32_t(), 5125);
}

TEST(Accessor, ReachingPastTheViewNamesTheAccessor) {
    GltfBuilder b;
    b.triangle();
    b.json["accessors"][0]["count"] = 4;
    EXPECT_TRUE(contains(b.error(), "built.gltf: /accessors/0: 4 elements, 48 bytes")) << b.error();
    b.json["accessors"][0]["count"] = uint64_t(1) << 40;
    EXPECT_TRUE(contains(b.error(), "/accessors/0/count")) << b.error();
}

TEST(Accessor, HugeCountsWithoutDataAreRefused) {
    GltfBuilder b;
    b.mesh({{"POSITION", b.accessor({{"componentType", 5126}, {"type", "VEC3"}, {"count", 2000000000}})}});
    EXPECT_TRUE(contains(b.error(), "/accessors/0/count: 2000000000 elements without a bufferView")) << b.error();
}

TEST(Accessor, NotANumberIsNamed) {
    GltfBuilder b;
    b.mesh({{"POSITION", b.vec3({0, 0, 0, 1, std::numeric_limits<float>::quiet_NaN(), 0, 0, 1, 0})}});
    EXPECT_TRUE(contains(b.error(), "/accessors/0: value 4 is not a finite number")) << b.error();
}

TEST(Accessor, MemoryLimitIsKept) {
    GltfBuilder b;
    b.mesh({{"POSITION", b.vec3(std::vector<float>(30000, 0.5f))}});
    LoadOptions small;
    small.maxBytes = 400000;
    EXPECT_TRUE(contains(b.error(small), "maxBytes")) << b.error(small);
    EXPECT_EQ(b.error(), "");
}

}  // namespace
}  // namespace obscura::scene::test
