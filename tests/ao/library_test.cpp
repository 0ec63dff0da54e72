// Properties that hold for every method, on analytic frames.
#include "ao/room.h"
#include "graph/executor.h"
#include "graph/read_back.h"

namespace obscura::ao {
namespace {

class LibraryTest : public test::GpuTest {
protected:
    gpu::Device& m_device = test::device();
    graph::Graph m_graph{m_device};
    graph::Executor m_executor{m_device};
    static inline gpu::ShaderLibrary s_shaders;
    static inline std::unique_ptr<Library>
        s_library;  // shared by all tests: creating every method's pipelines takes longer than most tests
    uint64_t m_frame = 0;

    static void SetUpTestSuite() { s_shaders.add(shaders()); }
    static void TearDownTestSuite() {
        if (s_library) test::device().waitIdle();
        s_library.reset();
    }
    void SetUp() override {
        test::GpuTest::SetUp();
        if (!s_library) s_library = std::make_unique<Library>(m_device, s_shaders);
        s_library->discardHistory();
    }

    // Visibility of a room, row by row; empty when record() failed.
    std::vector<float> run(const test::Room& room, const Values& values, const char* falloff = "quadratic:2", bool withNormals = true,
        bool withMotion = false, bool readBack = true) {
        return run(*s_library, room, values, falloff, withNormals, withMotion, readBack);
    }
    std::vector<float> run(Library& library, const test::Room& room, const Values& values, const char* falloff = "quadratic:2",
        bool withNormals = true, bool withMotion = false, bool readBack = true) {
        const gpu::Image depth = room.image(m_device, false), normals = room.image(m_device, true);
        Falloff rho;
        EXPECT_TRUE(parseFalloff(falloff, rho));
        const auto import = [&](const char* name, const gpu::Image& image) {
            graph::External external{image.handle(), image.view(), image.desc()};
            external.layout = external.layoutAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
            return m_graph.import(name, external);
        };
        m_device.nextFrame();
        m_graph.begin();
        Sources sources;
        sources.depth = import("depth", depth);
        if (withNormals) sources.normals = import("normals", normals);
        sources.volume = m_graph.upload("bits", room.bits.data(), room.bits.size() * sizeof(uint32_t));
        gpu::Image motion;
        if (withMotion) {
            EXPECT_EQ(
                gpu::Image::create(m_device,
                    {VK_FORMAT_R32G32_SFLOAT, room.width, room.height, 1, 1, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                    "still", motion),
                gpu::Status::ok);
            const std::vector<float> still(size_t(room.width) * room.height * 2, 0.0f);
            EXPECT_EQ(
                gpu::upload(m_device, motion, std::as_bytes(std::span(still)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL), gpu::Status::ok);
            sources.motion = import("motion", motion);
        }
        Frame frame = room.frame();
        frame.index = m_frame++;
        const graph::ImageId visibility = library.add(m_graph, frame, sources, rho, values).visibility;
        if (!visibility) return {};
        if (!readBack) {  // no pass reads the method's output
            EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { EXPECT_EQ(m_executor.execute(m_graph, cmd), gpu::Status::ok); }),
                gpu::Status::ok);
            return {};
        }
        const gpu::Buffer back = test::readBack(m_graph, visibility);
        gpu::Status status = gpu::Status::ok;
        EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { status = m_executor.execute(m_graph, cmd); }), gpu::Status::ok);
        EXPECT_EQ(status, gpu::Status::ok);
        return test::halvesOf(back);
    }
    static Values preset(const MethodInfo& info, const Preset& preset) {
        Values values(info);
        values.apply(preset);
        return values;
    }
};

double mean(const std::vector<float>& values) {
    double sum = 0.0;
    for (const float v : values) sum += v;
    return sum / double(values.size());
}

TEST_F(LibraryTest, everyPresetGivesVisibilityBetweenZeroAndOne) {
    test::Room room;
    room.wall = -5.0f;
    room.build();
    for (const MethodInfo* info : methods())
        for (const Preset& p : info->presets)
            for (const float v : run(room, preset(*info, p))) {
                ASSERT_GE(v, 0.0f) << info->id << " " << p.id;
                ASSERT_LE(v, 1.0f) << info->id << " " << p.id;
            }
}

TEST_F(LibraryTest, sameFrameTwiceIsBitIdentical) {
    test::Room room;
    room.wall = -5.0f;
    room.build();
    for (const MethodInfo* info : methods()) EXPECT_EQ(run(room, Values(*info)), run(room, Values(*info))) << info->id;
}

// With history the samples rotate and their noise is averaged, with motion vectors and without.
TEST_F(LibraryTest, historyReducesNoiseOfEveryMethod) {
    test::Room room;
    room.wall = -5.0f;
    room.build();
    for (const MethodInfo* info : methods()) {
        if (std::string(info->id) == "none") continue;
        Values off(*info), on(*info);
        ASSERT_TRUE(on.set("temporal", 0.9f)) << info->id;
        on.set("temporal_clip", 0.0f);
        const std::vector<float> single = run(room, off);
        for (const bool hasMotion : {true, false}) {
            s_library->discardHistory();
            std::vector<float> gathered;
            for (int i = 0; i < 24; ++i) gathered = run(room, on, "quadratic:2", true, hasMotion);
            EXPECT_NEAR(mean(gathered), mean(single), 0.01) << info->id;
            const std::vector<float> next = run(room, on, "quadratic:2", true, hasMotion);
            double change = 0.0;
            for (size_t i = 0; i < next.size(); ++i) change += std::abs(next[i] - gathered[i]);
            EXPECT_LT(change / double(next.size()), 0.004) << info->id;
        }
    }
    const Values hbao = [] {
        Values v(*findMethod("hbao"));
        v.set("temporal", 0.9f);
        return v;
    }();
    s_library->discardHistory();
    const std::vector<float> first = run(room, hbao, "quadratic:2", true, true);
    s_library->discardHistory();
    EXPECT_NE(run(room, hbao, "quadratic:2", true, true), first) << "samples do not rotate";
}

// A frame whose output is not read culls the method's passes, but still writes what later frames read.
TEST_F(LibraryTest, culledFramesDoNotChangeLaterFrames) {
    test::Room room;
    room.wall = -5.0f;
    room.build();
    for (const MethodInfo* info : methods()) {
        const std::vector<float> expected = run(room, Values(*info));
        Library fresh(m_device, s_shaders);
        run(fresh, room, Values(*info), "quadratic:2", true, false, false);
        EXPECT_EQ(run(fresh, room, Values(*info)), expected) << info->id;
    }
}

TEST_F(LibraryTest, skyIsOpen) {
    test::Room room;
    room.build();
    std::fill(room.depth.begin(), room.depth.end(), 1e4f);
    for (const MethodInfo* info : methods())
        for (const float v : run(room, Values(*info))) ASSERT_EQ(v, 1.0f) << info->id;
}

TEST_F(LibraryTest, invalidDepthsAreSky) {
    test::Room room;
    room.build();
    const float bad[] = {std::nanf(""), INFINITY, -INFINITY, -3.0f, 0.0f};
    for (size_t i = 0; i < room.depth.size(); ++i) room.depth[i] = bad[i % std::size(bad)];
    for (const MethodInfo* info : methods())
        for (const float v : run(room, Values(*info))) ASSERT_EQ(v, 1.0f) << info->id;
}

// A wall at 5 m on a floor: every method darkens the crease more than the open floor, and leaves the open floor open,
// except for the known self-obscurance of some methods.
TEST_F(LibraryTest, creaseIsDarkAndOpenFloorIsOpen) {
    test::Room crease, open;
    crease.wall = -5.0f;
    crease.build();
    open.build();
    for (const MethodInfo* info : methods()) {
        if (std::string(info->id) == "none") continue;
        const Values values = preset(*info, info->presets[0]);
        const std::vector<float> wall = run(crease, values), flat = run(open, values);
        EXPECT_LT(mean(wall), 0.96) << info->id;
        EXPECT_GT(mean(flat), 0.94) << info->id;
    }
}

TEST_F(LibraryTest, hbaoTunedLeavesABareFloorOpen) {
    test::Room room;
    room.build();
    const MethodInfo& info = *findMethod("hbao");
    Values values(info);
    for (const Preset& p : info.presets)
        if (std::string(p.id) == "tuned") values = preset(info, p);
    for (const float v : run(room, values)) ASSERT_GT(v, 0.999f);
}

TEST_F(LibraryTest, normalsAreReconstructedFromDepth) {
    test::Room room;
    room.wall = -5.0f;
    room.build();
    for (const MethodInfo* info : methods()) {
        const std::vector<float> given = run(room, Values(*info)), reconstructed = run(room, Values(*info), "quadratic:2", false);
        double difference = 0.0;
        for (size_t i = 0; i < given.size(); ++i) difference += std::abs(given[i] - reconstructed[i]);
        EXPECT_LT(difference / double(given.size()), 0.004) << info->id;
    }
}

TEST_F(LibraryTest, longerFalloffDarkens) {
    test::Room room;
    room.wall = -5.0f;
    room.build();
    for (const MethodInfo* info : methods()) {
        if (std::string(info->id) == "none") continue;
        for (const char* falloff : {"exponential:0.5", "linear:1.5", "quadratic:1", "wendland:2", "constant:1", "ramp:0.385:1"})
            EXPECT_LT(mean(run(room, Values(*info), falloff)), 0.995) << info->id << " " << falloff;
        EXPECT_LT(mean(run(room, Values(*info), "quadratic:2")), mean(run(room, Values(*info), "quadratic:0.5"))) << info->id;
    }
}

// Intensity, power, floor and fading change every method's result by their formulas. gtao applies power and floor before its blur, to
// visibility of 8 bits.
TEST_F(LibraryTest, controlsChangeEveryMethodAlike) {
    test::Room room;
    room.wall = -5.0f;
    room.build();
    for (const MethodInfo* info : methods()) {
        if (std::string(info->id) == "none") continue;
        Values own(*info);
        if (own.has("denoise") && std::string(info->id) == "gtao") own.set("denoise", 0);
        const std::vector<float> as = run(room, own);
        const float tolerance = std::string(info->id) == "gtao" ? 2.5f / 255.0f : 1e-3f;
        const auto expect = [&](const char* what, std::initializer_list<Setting> settings, auto formula) {
            Values values = own;
            for (const Setting& setting : settings) ASSERT_TRUE(values.set(setting.id, setting.value)) << info->id << " " << setting.id;
            const std::vector<float> found = run(room, values);
            float worst = 0.0f;
            for (size_t i = 0; i < as.size(); ++i) {
                const size_t y = i / room.visibleWidth() + room.guard, x = i % room.visibleWidth() + room.guard;
                worst = std::max(worst, std::abs(found[i] - formula(as[i], room.depth[y * room.width + x])));
            }
            EXPECT_LE(worst, tolerance) << info->id << " " << what;
        };
        expect("neutral", {{"intensity", 1}, {"power", 1}, {"floor", 0}, {"fade_from", 3}}, [](float v, float) { return v; });
        expect("intensity", {{"intensity", 0.5f}}, [](float v, float) { return 1.0f - 0.5f * (1.0f - v); });
        expect("strong", {{"intensity", 4}}, [](float v, float) { return std::max(1.0f - 4.0f * (1.0f - v), 0.0f); });
        expect("power", {{"power", 2}}, [](float v, float) { return v * v; });
        expect("floor", {{"floor", 0.8f}}, [](float v, float) { return std::max(v, 0.8f); });
        expect("fade", {{"fade_from", 3}, {"fade_to", 4.5f}},
            [](float v, float z) { return 1.0f - std::clamp((4.5f - z) / 1.5f, 0.0f, 1.0f) * (1.0f - v); });
    }
}

// At half resolution every method gives about the picture of full resolution, also with odd sizes, a guard band that is not a multiple
// of 2, and history, with which the chosen pixels change.
TEST_F(LibraryTest, halfResolutionIsNearFullResolution) {
    for (const auto& [width, height, guard] : {std::array{160u, 96u, 8u}, {151u, 93u, 9u}}) {
        test::Room room;
        room.width = width;
        room.height = height;
        room.guard = guard;
        room.wall = -5.0f;
        room.build();
        for (const MethodInfo* info : methods()) {
            if (std::string(info->id) == "none") continue;
            for (const float scale : {1.0f, 2.0f}) {
                Values full(*info), reduced(*info);
                ASSERT_TRUE(reduced.set("scale", scale));
                const auto away = [&](const std::vector<float>& a, const std::vector<float>& b) {
                    double sum = 0.0;
                    for (size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
                    return sum / double(a.size());
                };
                EXPECT_LT(away(run(room, full), run(room, reduced)), scale > 1.0f ? 0.05 : 0.03) << info->id << " " << width;
                for (Values* values : {&full, &reduced}) values->set("temporal", 0.9f), values->set("temporal_clip", 0.0f);
                s_library->discardHistory();
                std::vector<float> still, calm;
                for (int i = 0; i < 16; ++i) still = run(room, full, "quadratic:2", true, true);
                s_library->discardHistory();
                for (int i = 0; i < 16; ++i) calm = run(room, reduced, "quadratic:2", true, true);
                EXPECT_LT(away(still, calm), scale > 1.0f ? 0.05 : 0.03) << info->id << " with history " << width;
            }
        }
    }
}

// Half resolution is the frame of every other pixel, with the projection that shows these: at them both give the same, for every method.
TEST_F(LibraryTest, halfResolutionIsTheFrameOfTheChosenPixels) {
    test::Room room, chosen;
    room.wall = chosen.wall = -5.0f;
    room.build();
    chosen.width = room.width / 2;
    chosen.height = room.height / 2;
    chosen.guard = room.guard / 2;
    chosen.build();
    std::copy(std::begin(room.projection), std::end(room.projection), chosen.projection);
    // Chosen pixels lie up and left of the middle of theirs.
    chosen.projection[8] = -1.0f / float(room.width);
    chosen.projection[9] = -1.0f / float(room.height);
    for (uint32_t y = 0; y < chosen.height; ++y)
        for (uint32_t x = 0; x < chosen.width; ++x) {
            const size_t from = 2 * y * room.width + 2 * x, to = y * chosen.width + x;
            chosen.depth[to] = room.depth[from];
            for (size_t c = 0; c < 4; ++c) chosen.normals[4 * to + c] = room.normals[4 * from + c];
        }
    for (const MethodInfo* info : methods()) {
        if (std::string(info->id) == "none") continue;
        Values full(*info), half(*info);
        half.set("scale", 1);
        const std::vector<float> large = run(room, half), small = run(chosen, full);
        float worst = 0.0f;
        for (uint32_t y = 0; y < chosen.visibleHeight(); ++y)
            for (uint32_t x = 0; x < chosen.visibleWidth(); ++x)
                worst = std::max(worst, std::abs(large[2 * y * room.visibleWidth() + 2 * x] - small[y * chosen.visibleWidth() + x]));
        EXPECT_LE(worst, 2e-3f) << info->id;
    }
}

// A post two pixels wide, 3 m in front of a dark crease and out of its reach: at half resolution neither takes the other's visibility.
TEST_F(LibraryTest, halfResolutionKeepsSurfacesApart) {
    test::Room room;
    room.wall = -5.0f;
    room.build();
    const auto onPost = [](uint32_t x) { return x == 81 || x == 82; };
    for (uint32_t y = 0; y < room.height; ++y)
        for (uint32_t x = 0; x < room.width; ++x) {
            if (!onPost(x)) continue;
            room.depth[y * room.width + x] = 2.0f;
            for (size_t c = 0; c < 4; ++c) room.normals[4 * (y * room.width + x) + c] = c == 2 ? 1.0f : 0.0f;
        }
    for (const char* id : {"hbao", "horizon_split", "multi_resolution", "layered"}) {
        const MethodInfo& info = *findMethod(id);
        Values full(info), half(info);
        half.set("scale", 1);
        const std::vector<float> a = run(room, full), b = run(room, half);
        float post = 1.0f, beside = 0.0f;
        for (uint32_t y = 0; y < room.visibleHeight(); ++y)
            for (uint32_t x = 70; x < 78; ++x) {
                const size_t i = y * room.visibleWidth() + x;
                if (onPost(x + room.guard)) post = std::min(post, b[i] + (1.0f - a[i]));
                else beside = std::max(beside, b[i] - a[i]);
            }
        std::printf("  %-20s post %.3f, beside it %.3f brighter\n", id, post, beside);
        EXPECT_GT(post, 0.95f) << id;
        EXPECT_LT(beside, 0.2f) << id;
    }
}

TEST_F(LibraryTest, oddAndTinySizesGiveValidVisibility) {
    for (const auto& [width, height, guard] : {std::array{1u, 1u, 0u}, {8u, 8u, 0u}, {17u, 9u, 2u}, {333u, 5u, 1u}, {3u, 257u, 1u}}) {
        test::Room room;
        room.width = width;
        room.height = height;
        room.guard = guard;
        room.wall = -4.0f;
        room.build();
        for (const MethodInfo* info : methods())
            for (const float scale : {0.0f, 1.0f, 2.0f}) {
                Values values(*info);
                values.set("scale", scale);
                for (const float v : run(room, values)) ASSERT_TRUE(v >= 0.0f && v <= 1.0f) << info->id << " " << width << "x" << height;
            }
    }
}

}  // namespace
}  // namespace obscura::ao
