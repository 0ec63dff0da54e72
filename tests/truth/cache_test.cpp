// The cache of references: hits, damaged files, keys.
#include <cstdlib>

#include "scratch.h"
#include "shapes.h"
#include "truth/cache.h"

namespace {

using namespace obscura;
using namespace obscura::truth;
using test::TemporaryFolder;

struct Setting {
    test::Shapes shapes;
    CapturedFrame frame = emptyFrame({16, 12}, {2, 2}, 1.0f, 0.1f);
    std::vector<RayFalloff> falloffs{rayFalloff("quadratic:2"), rayFalloff("exponential:1")};
    WorldGeometry geometry;
    WorldOptions options;
    Setting() {
        shapes.quad({0, 0, -3}, {9, 0, 0}, {0, 9, 0});
        shapes.sphere({0.3f, 0, -2.6f}, 0.3f, 12);
        frame.depth.assign(frame.depth.size(), 3.0f);
        frame.normals.assign(frame.normals.size(), glm::vec3(0, 0, 1));
    }
    std::string key() const { return worldKey(shapes.posed(), geometry, frame, falloffs, options); }
    Reference make() const { return WorldReference(shapes.posed(), geometry).trace(frame, falloffs, options); }
};

TEST(Cache, findsStoredReferences) {
    const TemporaryFolder scratch;
    const Setting setting;
    std::vector<std::string> lines;
    ReferenceCache cache(scratch / "deep/er", [&](const std::string& line) { lines.push_back(line); });
    int made = 0;
    const auto make = [&] { return ++made, setting.make(); };
    const Reference fresh = cache.get(setting.key(), make);
    EXPECT_FALSE(fresh.fromCache);
    const Reference found = cache.get(setting.key(), make);
    EXPECT_EQ(made, 1);
    EXPECT_TRUE(found.fromCache);
    ASSERT_EQ(found.channels.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(found.channels[i].name, setting.falloffs[i].name);
        EXPECT_EQ(found.channels[i].obscurance.values, fresh.channels[i].obscurance.values);
        EXPECT_EQ(found.channels[i].error.values, fresh.channels[i].error.values);
    }
    EXPECT_EQ(found.rays.values, fresh.rays.values);
    EXPECT_EQ(found.totalRays, fresh.totalRays);
    EXPECT_TRUE(lines.empty());
}

TEST(Cache, keepsBentNormals) {
    const TemporaryFolder scratch;
    Setting setting;
    const std::string without = setting.key();
    setting.options.bentNormals = true;
    EXPECT_NE(setting.key(), without);
    ReferenceCache cache(scratch.path());
    const Reference fresh = cache.get(setting.key(), [&] { return setting.make(); }),
                    found = cache.get(setting.key(), [&] { return setting.make(); });
    EXPECT_TRUE(found.fromCache);
    ASSERT_EQ(found.channels.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        for (size_t axis = 0; axis < 3; ++axis)
            EXPECT_EQ(found.channels[i].bent.mean[axis].values, fresh.channels[i].bent.mean[axis].values);
        EXPECT_EQ(found.channels[i].bent.above.values, fresh.channels[i].bent.above.values);
    }
}

TEST(Cache, damagedFilesAreReplacedWithALogLine) {
    const Setting setting;
    for (const int damage : {0, 1, 2}) {
        const TemporaryFolder scratch;
        std::vector<std::string> lines;
        ReferenceCache cache(scratch.path(), [&](const std::string& line) { lines.push_back(line); });
        const Reference fresh = cache.get(setting.key(), [&] { return setting.make(); });
        const auto file = cache.fileOf(setting.key());
        const std::string bytes = test::readText(file);
        if (damage == 0) test::writeText(file, bytes.substr(0, bytes.size() / 2));
        if (damage == 1) test::writeText(file, "");
        if (damage == 2) {
            Picture other;
            other.add("Z", Plane(3, 3));
            writeExr(file, other);
        }
        int made = 0;
        const Reference again = cache.get(setting.key(), [&] { return ++made, setting.make(); });
        EXPECT_EQ(made, 1) << damage;
        ASSERT_EQ(lines.size(), 1u) << damage;
        EXPECT_NE(lines[0].find("the reference is traced again"), std::string::npos);
        EXPECT_EQ(again.channels[0].obscurance.values, fresh.channels[0].obscurance.values);
        EXPECT_TRUE(cache.get(setting.key(), [&] { return setting.make(); }).fromCache);
    }
}

TEST(Cache, unwritableFolderIsReportedOnce) {
    const TemporaryFolder scratch;
    test::writeText(scratch / "file", "in the way");
    const Setting setting;
    int lines = 0, made = 0;
    ReferenceCache cache(scratch / "file", [&](const std::string&) { ++lines; });
    for (int i = 0; i < 2; ++i) cache.get(setting.key(), [&] { return ++made, setting.make(); });
    EXPECT_EQ(made, 2);
    EXPECT_EQ(lines, 1);
    ReferenceCache off{std::filesystem::path()};
    off.get(setting.key(), [&] { return ++made, setting.make(); });
    EXPECT_EQ(made, 3);
}

TEST(Cache, stoppedTraceLeavesNoFile) {
    const TemporaryFolder scratch;
    ReferenceCache cache(scratch.path());
    test::expectError([&] { cache.get("key", []() -> Reference { throw scene::Error("stopped"); }); }, "stopped");
    EXPECT_EQ(scratch.files().size(), 0u);
}

TEST(Cache, keyCoversAllInputs) {
    const Setting base;
    const std::string key = base.key();
    EXPECT_EQ(key, Setting().key());
    const auto differs = [&](const std::function<void(Setting&)>& change) {
        Setting other;
        change(other);
        EXPECT_NE(other.key(), key);
    };
    differs([](Setting& s) { s.shapes.quad({0, 0, -1}, {0.1f, 0, 0}, {0, 0.1f, 0}); });
    differs([](Setting& s) { s.shapes.model().hash = 1; });
    differs([](Setting& s) { s.geometry.skipMasked = true; });
    differs([](Setting& s) { s.frame.depth[40] = 3.0001f; });
    differs([](Setting& s) { s.frame.normals[40] = {0, 1, 0}; });
    differs([](Setting& s) { s.frame.projection[0][0] *= 1.001f; });
    differs([](Setting& s) { s.frame.camera.emplace().eye.x += 0.1f; });
    differs([](Setting& s) { s.falloffs.pop_back(); });
    differs([](Setting& s) { s.falloffs[0].rho = [](float d) { return d < 1.0f ? 1.0f - d : 0.0f; }; });  // other function, same name
    differs([](Setting& s) { s.falloffs[0].reach = 1.9f; });
    differs([](Setting& s) { s.options.seed = 2; });
    differs([](Setting& s) { s.options.maxRays = 64; });
    differs([](Setting& s) { s.options.targetError = 0.001f; });
    differs([](Setting& s) { s.options.stride = 2; });
    Setting same;
    same.options.threads = 7;
    same.options.progress = [](float) { return true; };
    EXPECT_EQ(same.key(), key);

    ScreenOptions options;
    const std::string screen = screenKey(base.frame, base.falloffs, options);
    EXPECT_NE(screen, key);
    options.thickness = 0.5f;
    EXPECT_NE(screenKey(base.frame, base.falloffs, options), screen);
}

TEST(Cache, notedReferenceIsFoundByItsViewKey) {
    const TemporaryFolder scratch;
    const Setting setting;
    ReferenceCache cache(scratch.path());
    EXPECT_FALSE(cache.find("view-none"));
    cache.note("view-dangling", setting.key());
    EXPECT_FALSE(cache.find("view-dangling")) << "the reference does not exist yet";
    const Reference made = cache.get(setting.key(), [&] { return setting.make(); });
    const auto found = cache.find("view-dangling");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->channels[0].obscurance.values, made.channels[0].obscurance.values);
    test::writeText(cache.fileOf(setting.key()), "");
    EXPECT_FALSE(cache.find("view-dangling")) << "the file is damaged";

    scene::World world;
    auto model = std::make_shared<scene::Model>();
    model->hash = 1;
    world.add({.model = model});
    const scene::Camera camera;
    const auto key = [&](const scene::World& w, float time, const scene::Camera& c, glm::uvec2 size, const std::string& falloff) {
        return viewKey(w, time, c, size, {}, rayFalloff(falloff));
    };
    const std::string first = key(world, 1.0f, camera, {8, 8}, "quadratic:2");
    EXPECT_EQ(first, key(world, 2.0f, camera, {8, 8}, "quadratic:2")) << "a resting world has one key at all times";
    scene::Camera near = camera, turned = camera;
    near.nearPlane *= 2.0f;
    turned.target.x += 1e-3f;
    EXPECT_EQ(first, key(world, 1.0f, near, {8, 8}, "quadratic:2"));
    EXPECT_NE(first, key(world, 1.0f, turned, {8, 8}, "quadratic:2"));
    EXPECT_NE(first, key(world, 1.0f, camera, {8, 9}, "quadratic:2"));
    EXPECT_NE(first, key(world, 1.0f, camera, {8, 8}, "quadratic:1"));
    WorldGeometry bare;
    bare.skipMasked = true;
    EXPECT_NE(first, viewKey(world, 1.0f, camera, {8, 8}, bare, rayFalloff("quadratic:2")));
    scene::World moved = world;
    moved.instances()[0].placement[3].x += 1.0f;
    EXPECT_NE(first, key(moved, 1.0f, camera, {8, 8}, "quadratic:2"));
    scene::World crowded = world;
    crowded.add({.model = model});
    EXPECT_NE(first, key(crowded, 1.0f, camera, {8, 8}, "quadratic:2"));
    scene::World animated;
    auto moving = std::make_shared<scene::Model>();
    moving->hash = 1;
    moving->animations.emplace_back().duration = 3.0f;
    animated.add({.model = moving});
    EXPECT_NE(key(animated, 1.0f, camera, {8, 8}, "quadratic:2"), key(animated, 2.0f, camera, {8, 8}, "quadratic:2"));
}

TEST(Cache, folderComesFromTheEnvironment) {
    const auto with = [](const char* own, const char* xdg, const char* home) {
        const char* names[] = {"OBSCURA_CACHE", "XDG_CACHE_HOME", "HOME"};
        const char* values[] = {own, xdg, home};
        std::string saved[3];
        bool had[3];
        for (int i = 0; i < 3; ++i) {
            const char* old = std::getenv(names[i]);
            if ((had[i] = old)) saved[i] = old;
            values[i] ? setenv(names[i], values[i], 1) : unsetenv(names[i]);
        }
        std::filesystem::path folder = scene::cacheFolder();
        for (int i = 0; i < 3; ++i) had[i] ? setenv(names[i], saved[i].c_str(), 1) : unsetenv(names[i]);
        return folder;
    };
    EXPECT_EQ(with("/own", "/xdg", "/home"), "/own");
    EXPECT_EQ(with(nullptr, "/xdg", "/home"), "/xdg/obscura");
    EXPECT_EQ(with(nullptr, nullptr, "/home"), "/home/.cache/obscura");
    EXPECT_EQ(with("", "/xdg", "/home"), "");
    EXPECT_EQ(with(nullptr, nullptr, nullptr), "");
}

}  // namespace
