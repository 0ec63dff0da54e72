// Both generated scenes: triangle count, determinism, looping animation, valid geometry.
#include "atrium/atrium_layout.h"
#include "atrium/atrium_scene.h"
#include "content_helpers.h"
#include "meshkit/file_output.h"
#include "meshkit/glb_writer.h"
#include "toasters/toaster_scene.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <ostream>
#include <set>

namespace obscura::content {

using namespace kit;

namespace {

struct File {
    const char* name;
    const Scene& (*scene)();
    Scene (*build)();
    std::size_t fewest;
    std::size_t most;
};

void PrintTo(const File& file, std::ostream* out) { *out << file.name; }

class Scenes : public testing::TestWithParam<File> {
protected:
    const Scene& scene() const { return GetParam().scene(); }
};

std::vector<float> keyValue(const Scene& scene, const Channel& channel, std::size_t key) {
    const std::size_t width = scene.channelWidth(channel);
    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    const std::size_t start = (cubic ? key * 3 + 1 : key) * width;
    return {
        channel.values.begin() + static_cast<std::ptrdiff_t>(start), channel.values.begin() + static_cast<std::ptrdiff_t>(start + width)};
}

}  // namespace

TEST_P(Scenes, TriangleCountIsInRange) {
    EXPECT_GE(scene().triangleCount(), GetParam().fewest);
    EXPECT_LE(scene().triangleCount(), GetParam().most);
}

TEST_P(Scenes, TwoRunsGiveTheSameBytes) {
    const std::vector<std::uint8_t> first = writeGlb(scene());
    EXPECT_EQ(first, writeGlb(GetParam().build()));
    constexpr std::size_t kLargestFile = 8u << 20;
    EXPECT_LT(first.size(), kLargestFile);
    ASSERT_GT(first.size(), 12u);
    EXPECT_EQ(std::string(first.begin(), first.begin() + 4), "glTF");
}

TEST_P(Scenes, EveryChannelLoops) {
    EXPECT_EQ(scene().animation, "walk");
    for (const Channel& channel : scene().channels) {
        const std::string& name = scene().nodes[channel.node].name;
        EXPECT_FLOAT_EQ(channel.times.front(), 0.0f) << name;
        EXPECT_FLOAT_EQ(channel.times.back(), 10.0f) << name;
        EXPECT_TRUE(std::is_sorted(channel.times.begin(), channel.times.end())) << name;
        std::vector<float> first = keyValue(scene(), channel, 0);
        const std::vector<float> last = keyValue(scene(), channel, channel.times.size() - 1);
        // A quaternion and its negative are the same rotation.
        if (channel.path == Path::Rotation && std::inner_product(first.begin(), first.end(), last.begin(), 0.0f) < 0.0f)
            for (float& v : first) v = -v;
        for (std::size_t i = 0; i < first.size(); ++i) EXPECT_NEAR(first[i], last[i], 1e-5f) << name;
    }
}

TEST_P(Scenes, HasNodeSkinOrMorphAnimationAndACamera) {
    std::set<Path> paths;
    std::set<Interpolation> interpolations;
    for (const Channel& channel : scene().channels) {
        paths.insert(channel.path);
        interpolations.insert(channel.interpolation);
    }
    EXPECT_TRUE(paths.contains(Path::Rotation));
    EXPECT_TRUE(paths.contains(Path::Weights));
    EXPECT_TRUE(interpolations.contains(Interpolation::Linear));
    EXPECT_TRUE(interpolations.contains(Interpolation::CubicSpline));
    const int camera = scene().findNode("main");
    ASSERT_NE(camera, kNone);
    EXPECT_NE(scene().nodes[camera].camera, kNone);
    EXPECT_FALSE(scene().images.empty());
}

TEST_P(Scenes, NormalsAreUnitAndFaceOutOfTheirTriangles) {
    for (const Geometry& geometry : scene().geometries) {
        for (const Vertex& vertex : geometry.mesh.vertices) ASSERT_NEAR(glm::length(vertex.normal), 1.0f, 1e-4f);
        for (const Triangle& triangle : geometry.mesh.triangles) {
            const Vertex& a = geometry.mesh.vertices[triangle.corner[0]];
            const Vertex& b = geometry.mesh.vertices[triangle.corner[1]];
            const Vertex& c = geometry.mesh.vertices[triangle.corner[2]];
            const glm::vec3 face = glm::cross(b.position - a.position, c.position - a.position);
            for (const Vertex* vertex : {&a, &b, &c}) ASSERT_GT(glm::dot(face, vertex->normal), 0.0f);
        }
    }
}

TEST_P(Scenes, SolidsAreClosedAndWoundOutwards) {
    for (const MeshUse& use : scene().meshes) {
        const Mesh& mesh = scene().geometries[use.geometry].mesh;
        const auto isSheet = [&](const Triangle& triangle) { return scene().materials[use.materials.at(triangle.material)].doubleSided; };
        if (std::all_of(mesh.triangles.begin(), mesh.triangles.end(), isSheet)) continue;
        // Floor tiles lie on a bed and have no hidden underside.
        if (use.name.find("floor") != std::string::npos && use.name != "upper floor") continue;
        EXPECT_EQ(openEdges(mesh, atrium::kSlotCount), 0) << use.name;
        double volume = 0.0;
        for (const Triangle& triangle : mesh.triangles)
            volume += glm::dot(mesh.vertices[triangle.corner[0]].position,
                glm::cross(mesh.vertices[triangle.corner[1]].position, mesh.vertices[triangle.corner[2]].position));
        EXPECT_GT(volume, 0.0) << use.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Generated, Scenes,
    testing::Values(File{"toasters", toasters, obscura::toasters::buildScene, 17000, 24000},
        File{"atrium", atrium, obscura::atrium::buildScene, 150000, 300000}),
    [](const testing::TestParamInfo<File>& file) { return file.param.name; });

TEST(Atrium, HasAMaskedAndADoubleSidedMaterial) {
    const auto& materials = atrium().materials;
    EXPECT_TRUE(std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.masked; }));
    EXPECT_TRUE(std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.doubleSided && !m.masked; }));
}

TEST(FileOutput, ErrorNamesTheFileAndLeavesNoPartialFile) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "obscura-content-test";
    std::filesystem::remove_all(folder);
    const std::vector<std::uint8_t> bytes{1, 2, 3};
    writeFile(folder / "deep" / "a.bin", bytes);
    EXPECT_EQ(std::filesystem::file_size(folder / "deep" / "a.bin"), 3u);
    EXPECT_FALSE(std::filesystem::exists(folder / "deep" / "a.bin.partial"));
    EXPECT_THROW(writeFile(folder, bytes), std::runtime_error);
    EXPECT_THROW(writeFile(folder / "deep" / "a.bin" / "b.bin", bytes), std::runtime_error);
    std::filesystem::remove_all(folder);
}

}  // namespace obscura::content
