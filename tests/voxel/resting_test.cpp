// Geometry at rest: rasterised once, cached on disk, rebuilt if the file is damaged or stale; follows the world instance by instance.
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
        options.cachedTriangles = 1000;
        options.mostBricks = 1 << 16;
        options.say = [this](const std::string& line) { lines.push_back(line); };
        return options;
    }
    std::unique_ptr<Resting> build(const glm::mat4& placement = glm::mat4(1.0f), double cellSize = 0.125) {
        scene::World world;
        world.add({.model = model, .placement = placement});
        return build(world, cellSize);
    }
    std::unique_ptr<Resting> build(const scene::World& world, double cellSize = 0.125) {
        Resting::Options chosen = options();
        chosen.cellSize = cellSize;
        auto resting = std::make_unique<Resting>(chosen);
        std::vector<glm::ivec3> changed;
        resting->update(world, 0.0f, true, changed);
        return resting;
    }
    static bool fromCache(const std::unique_ptr<Resting>& resting) {
        EXPECT_EQ(resting->facts().fromCache + resting->facts().rasterised, 1u);
        return resting->facts().fromCache == 1;
    }
};

void expectSameCells(const Resting& a, const Resting& b) {
    EXPECT_EQ(a.facts().cells, b.facts().cells);
    for (uint32_t k = 0; k < 5; ++k)
        for (int x = -48; x < 48; ++x)
            for (int y = -48; y < 48; ++y)
                for (int z = -48; z < 48; ++z)
                    ASSERT_EQ(a.level(k).test({x, y, z}), b.level(k).test({x, y, z})) << k << ": " << x << " " << y << " " << z;
}

TEST_F(Kept, secondBuildReadsTheCache) {
    const auto first = build();
    EXPECT_FALSE(fromCache(first));
    EXPECT_GT(first->facts().cells, 10000u);
    ASSERT_EQ(folder.files().size(), 1u);  // and no temporary file
    EXPECT_EQ(folder.files()[0].extension(), ".vdb");
    const auto second = build();
    EXPECT_TRUE(fromCache(second));
    expectSameCells(*first, *second);
    EXPECT_TRUE(lines.empty()) << lines[0];
}

TEST_F(Kept, otherInputUsesAnotherFile) {
    build();
    EXPECT_FALSE(fromCache(build(glm::mat4(2.0f))));
    EXPECT_FALSE(fromCache(build(glm::mat4(1.0f), 0.25)));
    model = modelOf(randomSoup(3000, 4.0f, 0.8f));
    EXPECT_TRUE(fromCache(build()));  // other instances, same triangles
    model->meshes[0].primitives[0].positions[17].x += 0.5f;
    EXPECT_FALSE(fromCache(build()));
    EXPECT_EQ(folder.files().size(), 4u);
}

TEST_F(Kept, damagedFileIsRebuiltWithALogLine) {
    const auto whole = build();
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
        const auto again = build();
        EXPECT_FALSE(fromCache(again));
        ASSERT_EQ(lines.size(), 1u);
        EXPECT_NE(lines[0].find(file.string()), std::string::npos) << lines[0];
        EXPECT_EQ(again->facts().cells, whole->facts().cells);
    }
    lines.clear();
    EXPECT_TRUE(fromCache(build()));  // replaced
}

TEST_F(Kept, fileOfAnotherWorldIsRebuilt) {
    build();
    const std::filesystem::path first = folder.files().at(0);
    const auto other = build(glm::mat4(2.0f));
    for (const std::filesystem::path& file : folder.files())
        if (file != first) std::filesystem::copy_file(first, file, std::filesystem::copy_options::overwrite_existing);
    const auto again = build(glm::mat4(2.0f));
    EXPECT_FALSE(fromCache(again));
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("another world"), std::string::npos) << lines[0];
    expectSameCells(*other, *again);
}

TEST_F(Kept, unwritableFolderIsReported) {
    std::ofstream(folder.path() / "file") << "x";
    Resting::Options chosen = options();
    chosen.cache = folder.path() / "file" / "below";
    scene::World world;
    world.add({.model = model});
    Resting resting(chosen);
    std::vector<glm::ivec3> changed;
    resting.update(world, 0.0f, true, changed);
    EXPECT_GT(resting.facts().cells, 0u);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("without a cache"), std::string::npos) << lines[0];
}

// After each change of the world, a volume that followed has the cells of one that starts with that world, at every level.
TEST_F(Kept, followingEqualsStartingAnew) {
    const auto placed = [](float x) {
        glm::mat4 placement(1.0f);
        placement[3] = glm::vec4(x, 0.3f * x, -0.2f * x, 1.0f);
        return placement;
    };
    scene::World world;
    world.add({.model = model});
    Resting following(options());
    std::vector<glm::ivec3> changed;
    std::vector<uint32_t> ids;
    for (int step = 0; step < 6; ++step) {
        if (step == 1 || step == 2)
            ids.push_back(world.add({.model = modelOf(randomSoup(500, 3.0f, 0.9f)), .placement = placed(float(step))}));
        if (step == 3) world.remove(ids[0]);
        if (step == 4) world.add({.model = model, .placement = placed(-2.0f)});
        if (step == 5) world.remove(ids[1]);
        EXPECT_EQ(following.update(world, 0.0f, true, changed), step == 0);
        expectSameCells(following, *build(world));
    }
    // From now on the first instance is dynamic.
    const uint32_t first = world.instances()[0].id;
    EXPECT_TRUE(following.contains(first, {}));
    world.instances()[0].placement = placed(1.0f);
    following.update(world, 0.0f, true, changed);
    EXPECT_FALSE(following.contains(first, {}));
    scene::World others = world;
    others.remove(first);
    expectSameCells(following, *build(others));
    world.instances()[0].placement = placed(2.0f);
    changed.clear();
    following.update(world, 0.0f, true, changed);
    EXPECT_TRUE(changed.empty());
}

// A change of one instance touches only its own bricks, however large its neighbour is.
TEST_F(Kept, onlyTheChangedInstanceIsRedone) {
    scene::World world;
    world.add({.model = modelOf(randomSoup(200000, 4.0f, 0.4f))});
    Soup small;
    small.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const uint32_t id = world.add({.model = modelOf(small)});
    Resting resting(options());
    std::vector<glm::ivec3> changed;
    resting.update(world, 0.0f, true, changed);
    EXPECT_GT(changed.size(), 300u);
    EXPECT_EQ(resting.facts().rasterised, 2u);
    changed.clear();
    world.remove(id);
    resting.update(world, 0.0f, true, changed);
    EXPECT_GT(changed.size(), 0u);
    EXPECT_LT(changed.size(), 10u);
    changed.clear();
    world.add({.model = modelOf(small)});
    resting.update(world, 0.0f, true, changed);
    EXPECT_LT(changed.size(), 10u);
    EXPECT_EQ(resting.facts().rasterised, 3u);
}

// ---- Invalid input ----------------------------------------------------------------------------------------------------

TEST_F(Kept, hugeWorldGetsLargerCells) {
    Soup soup;
    soup.add({-5e5f, 0, -5e5f}, {5e5f, 0, -5e5f}, {0, 0, 5e5f});
    soup.add({-5e5f, 0, -5e5f}, {5e5f, 2e4f, -5e5f}, {0, 0, 5e5f});
    model = modelOf(soup);
    const auto resting = build(glm::mat4(1.0f), 0.0);
    EXPECT_GT(resting->facts().cells, 1000u);
    EXPECT_LE(resting->facts().bricks, options().mostBricks);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("too large"), std::string::npos) << lines[0];
}

TEST_F(Kept, oneTriangleAndEmptyWorld) {
    Soup soup;
    soup.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    model = modelOf(soup);
    EXPECT_GT(build(glm::mat4(1.0f), 0.0)->facts().cells, 100u);
    model = modelOf({});
    const auto none = build(glm::mat4(1.0f), 0.0);
    EXPECT_EQ(none->facts().cells, 0u);
    EXPECT_GT(none->cellSize(), 0.0);
    const auto empty = build(scene::World());
    EXPECT_EQ(empty->facts().cells, 0u);
    EXPECT_GT(empty->cellSize(), 0.0);
}

TEST_F(Kept, invalidVerticesAreReportedOnce) {
    Soup soup = randomSoup(100, 2.0f, 0.5f);
    soup.positions[7].x = std::numeric_limits<float>::quiet_NaN();
    soup.positions[70].y = std::numeric_limits<float>::infinity();
    model = modelOf(soup);
    const auto resting = build(glm::mat4(1.0f), 0.0);
    EXPECT_GT(resting->facts().cells, 100u);
    EXPECT_LT(resting->cellSize(), 0.2);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("2 triangles"), std::string::npos) << lines[0];
}

}  // namespace
}  // namespace obscura::test
