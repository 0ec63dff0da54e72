// URIs: files inside the model's folder are read, all others are refused.
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "gltf_builder.h"

namespace obscura::scene::test {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
protected:
    void SetUp() override {
        m_root = fs::temp_directory_path() / ("obscura_files_" + std::to_string(getpid()));
        fs::create_directories(m_root / "model" / "sub");
        m_builder.triangle();
        for (const char* place : {"outside.bin", "model/inside.bin", "model/sub/with space.bin"})
            write(place, std::string(m_builder.bytes().begin(), m_builder.bytes().end()));
    }
    void TearDown() override { fs::remove_all(m_root); }

    void write(const fs::path& place, const std::string& text) const { std::ofstream(m_root / place, std::ios::binary) << text; }
    std::string errorOf(const std::string& uri, size_t length = 36) {
        m_builder.json["buffers"] = Json::array({{{"byteLength", length}, {"uri", uri}}});
        write("model/model.gltf", m_builder.text());
        try {
            loadGltf(m_root / "model" / "model.gltf");
            return {};
        } catch (const Error& error) {
            return error.what();
        }
    }
    fs::path m_root;
    GltfBuilder m_builder;
};

TEST_F(Files, BesideAndBelowAreRead) {
    EXPECT_EQ(errorOf("inside.bin"), "");
    EXPECT_EQ(errorOf("./inside.bin"), "");
    EXPECT_EQ(errorOf("sub/../inside.bin"), "");
    EXPECT_EQ(errorOf("sub/with%20space.bin"), "");
    EXPECT_EQ(errorOf("sub/with space.bin"), "");
}

TEST_F(Files, NothingOutsideIsRead) {
    for (const std::string& uri : {std::string("../outside.bin"), std::string("sub/../../outside.bin"), std::string("%2e%2e/outside.bin"),
             std::string("sub%2f..%2f..%2foutside.bin")})
        EXPECT_TRUE(contains(errorOf(uri), "leaves the model's folder")) << errorOf(uri);
    EXPECT_TRUE(contains(errorOf((m_root / "model/inside.bin").string()), "absolute path"));
    EXPECT_TRUE(contains(errorOf("/etc/passwd"), "absolute path"));
    EXPECT_TRUE(contains(errorOf("file:///etc/passwd"), "is not fetched"));
    EXPECT_TRUE(contains(errorOf("https://example.com/a.bin"), "is not fetched"));
    EXPECT_NE(errorOf(""), "");
    EXPECT_NE(errorOf("%00"), "");
    EXPECT_NE(errorOf("sub"), "") << "a folder is not a file";
}

TEST_F(Files, LinksMayNotLeave) {
    fs::create_symlink(m_root / "outside.bin", m_root / "model" / "link.bin");
    fs::create_directory_symlink(m_root, m_root / "model" / "up");
    fs::create_symlink(m_root / "model" / "inside.bin", m_root / "model" / "fine.bin");
    EXPECT_TRUE(contains(errorOf("link.bin"), "through a link")) << errorOf("link.bin");
    EXPECT_TRUE(contains(errorOf("up/outside.bin"), "through a link"));
    EXPECT_EQ(errorOf("fine.bin"), "");
}

TEST_F(Files, SizesAreChecked) {
    EXPECT_EQ(errorOf("inside.bin", 36), "");
    EXPECT_TRUE(contains(errorOf("inside.bin", 37), "/buffers/0: byteLength is 37"));
    EXPECT_TRUE(contains(errorOf("missing.bin"), "/buffers/0/uri: the file \"missing.bin\" cannot be found"));
    write("model/long.bin", std::string(1000, 'x'));
    EXPECT_EQ(errorOf("long.bin", 36), "") << "a longer file is valid";
}

TEST_F(Files, MissingImageIsAnError) {
    m_builder.json["images"] = {{{"uri", "no.png"}}};
    EXPECT_TRUE(contains(errorOf("inside.bin"), "/images/0/uri: the file \"no.png\"")) << errorOf("inside.bin");
}

TEST_F(Files, MissingModelIsOneErrorLine) {
    for (const char* name : {"none.gltf", "model", "nowhere/none.gltf"}) {
        try {
            loadGltf(m_root / name);
            FAIL() << name;
        } catch (const Error& error) {
            EXPECT_TRUE(contains(error.what(), (m_root / name).string())) << error.what();
        }
    }
}

TEST_F(Files, HashFollowsTheBuffers) {
    ASSERT_EQ(errorOf("inside.bin"), "");
    const uint64_t before = loadGltf(m_root / "model/model.gltf")->hash;
    EXPECT_EQ(loadGltf(m_root / "model/model.gltf")->hash, before);
    std::string bytes(m_builder.bytes().begin(), m_builder.bytes().end());
    bytes[2] = 1;
    write("model/inside.bin", bytes);
    EXPECT_NE(loadGltf(m_root / "model/model.gltf")->hash, before);
}

TEST(Memory, FilesAreRefused) {
    GltfBuilder b;
    b.triangle();
    b.json["buffers"] = Json::array({{{"byteLength", 36}, {"uri", "inside.bin"}}});
    EXPECT_TRUE(contains(b.error(), "was not opened from a folder")) << b.error();
}

}  // namespace
}  // namespace obscura::scene::test
