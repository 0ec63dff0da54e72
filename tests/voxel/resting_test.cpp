// Static geometry: rasterised once, cached on disk, rebuilt if the file is damaged or stale.
#include <fstream>
#include <limits>

#include "shapes.h"
#include "voxel/resting.h"

namespace obscura::test {
namespace {

using voxel::Resting;

struct Kept : testing::Test {
    TemporaryFolder folder;
    std::vector<std::string> lines;
    std::shared_ptr<scene::Model> model = modelOf(randomSoup(3000, 4.0f, 0.8f));

    Resting::Options options() {
        Resting::Options options;
        options.cells = 64;
        options.cellSize = 0.125;
        options.cache = folder.path();
        options.mostBricks = 1 << 16;
        options.say = [this](const std::string& line) { lines.push_back(line); };
        return options;
    }
    Resting build(const glm::mat4& placement = glm::mat4(1.0f), double cellSize = 0.125) {
        scene::World world;
        world.add({.model = model, .placement = placement});
        Resting resting;
        Resting::Options chosen = options();
        chosen.cellSize = cellSize;
        resting.build(world, 0.0f, chosen);
        return resting;
    }
};

void expectSameCells(const Resting& a, const Resting& b) {
    EXPECT_EQ(a.facts().cells, b.facts().cells);
    for (int x = -48; x < 48; ++x)
        for (int y = -48; y < 48; ++y)
            for (int z = -48; z < 48; ++z) ASSERT_EQ(a.sparse().test({x, y, z}), b.sparse().test({x, y, z}));
}

TEST_F(Kept, secondBuildReadsTheCache) {
    const Resting first = build();
    EXPECT_FALSE(first.facts().fromCache);
    EXPECT_GT(first.facts().cells, 10000u);
    ASSERT_EQ(folder.files().size(), 1u);  // and no temporary file
    EXPECT_EQ(folder.files()[0].extension(), ".vdb");
    const Resting second = build();
    EXPECT_TRUE(second.facts().fromCache);
    expectSameCells(first, second);
    EXPECT_TRUE(lines.empty()) << lines[0];
}

TEST_F(Kept, otherInputUsesAnotherFile) {
    build();
    EXPECT_FALSE(build(glm::mat4(2.0f)).facts().fromCache);
    EXPECT_FALSE(build(glm::mat4(1.0f), 0.25).facts().fromCache);
    model = modelOf(randomSoup(3000, 4.0f, 0.8f));
    EXPECT_TRUE(build().facts().fromCache);  // other instances, same triangles
    model->meshes[0].primitives[0].positions[17].x += 0.5f;
    EXPECT_FALSE(build().facts().fromCache);
    EXPECT_EQ(folder.files().size(), 4u);
}

TEST_F(Kept, damagedFileIsRebuiltWithALogLine) {
    const Resting whole = build();
    const std::filesystem::path file = folder.files().at(0);
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::vector<std::string> broken{"", "no file", bytes.substr(0, bytes.size() / 2), bytes.substr(0, bytes.size() - 1)};
    for (size_t at = 0; at < bytes.size(); at += bytes.size() / 13) {
        broken.push_back(bytes);
        broken.back()[at] = char(broken.back()[at] ^ 0x10);
    }
    for (const std::string& text : broken) {
        std::ofstream(file, std::ios::binary) << text;
        lines.clear();
        const Resting again = build();
        EXPECT_FALSE(again.facts().fromCache);
        ASSERT_EQ(lines.size(), 1u);
        EXPECT_NE(lines[0].find(file.string()), std::string::npos) << lines[0];
        EXPECT_EQ(again.facts().cells, whole.facts().cells);
    }
    lines.clear();
    EXPECT_TRUE(build().facts().fromCache);  // replaced
}

TEST_F(Kept, fileOfAnotherWorldIsRebuilt) {
    build();
    const std::filesystem::path first = folder.files().at(0);
    const Resting other = build(glm::mat4(2.0f));
    for (const std::filesystem::path& file : folder.files())
        if (file != first) std::filesystem::copy_file(first, file, std::filesystem::copy_options::overwrite_existing);
    const Resting again = build(glm::mat4(2.0f));
    EXPECT_FALSE(again.facts().fromCache);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("another world"), std::string::npos) << lines[0];
    expectSameCells(other, again);
}

TEST_F(Kept, unwritableFolderIsReported) {
    std::ofstream(folder.path() / "file") << "x";
    Resting::Options chosen = options();
    chosen.cache = folder.path() / "file" / "below";
    scene::World world;
    world.add({.model = model});
    Resting resting;
    resting.build(world, 0.0f, chosen);
    EXPECT_GT(resting.facts().cells, 0u);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("without a cache"), std::string::npos) << lines[0];
}

TEST_F(Kept, isValidUntilStaticGeometryMoves) {
    scene::World world;
    const uint32_t id = world.add({.model = model});
    Resting resting;
    Resting::Options chosen = options();
    EXPECT_FALSE(resting.holds(world, chosen.picked));
    resting.build(world, 0.0f, chosen);
    EXPECT_TRUE(resting.holds(world, chosen.picked));
    Soup small;
    small.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    world.add({.model = modelOf(small)});
    EXPECT_TRUE(resting.holds(world, chosen.picked));  // the new instance is a dynamic object
    world.instances()[0].placement[3].x = 1.0f;
    EXPECT_FALSE(resting.holds(world, chosen.picked));
    resting.build(world, 0.0f, chosen);
    EXPECT_TRUE(resting.holds(world, chosen.picked));
    EXPECT_FALSE(resting.contains(id, {}));
    world.instances()[0].placement[3].x = 2.0f;
    EXPECT_TRUE(resting.holds(world, chosen.picked));  // instance 0 is dynamic now, so nothing is rebuilt
}

// ---- Invalid input ----------------------------------------------------------------------------------------------------

TEST_F(Kept, hugeWorldGetsLargerCells) {
    Soup soup;
    soup.add({-5e5f, 0, -5e5f}, {5e5f, 0, -5e5f}, {0, 0, 5e5f});
    soup.add({-5e5f, 0, -5e5f}, {5e5f, 2e4f, -5e5f}, {0, 0, 5e5f});
    model = modelOf(soup);
    const Resting resting = build(glm::mat4(1.0f), 0.0);
    EXPECT_GT(resting.facts().cells, 1000u);
    EXPECT_LE(resting.facts().bricks, options().mostBricks);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("too large"), std::string::npos) << lines[0];
}

TEST_F(Kept, oneTriangleAndEmptyWorld) {
    Soup soup;
    soup.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    model = modelOf(soup);
    EXPECT_GT(build(glm::mat4(1.0f), 0.0).facts().cells, 100u);
    model = modelOf({});
    const Resting none = build(glm::mat4(1.0f), 0.0);
    EXPECT_EQ(none.facts().cells, 0u);
    EXPECT_GT(none.cellSize(), 0.0);
    scene::World empty;
    Resting resting;
    resting.build(empty, 0.0f, options());
    EXPECT_EQ(resting.facts().cells, 0u);
    EXPECT_TRUE(resting.holds(empty, {}));
}

TEST_F(Kept, invalidVerticesAreReportedOnce) {
    Soup soup = randomSoup(100, 2.0f, 0.5f);
    soup.positions[7].x = std::numeric_limits<float>::quiet_NaN();
    soup.positions[70].y = std::numeric_limits<float>::infinity();
    model = modelOf(soup);
    const Resting resting = build(glm::mat4(1.0f), 0.0);
    EXPECT_GT(resting.facts().cells, 100u);
    EXPECT_LT(glm::length(resting.bounds().max), 10.0f);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("2 triangles"), std::string::npos) << lines[0];
}

}  // namespace
}  // namespace obscura::test
