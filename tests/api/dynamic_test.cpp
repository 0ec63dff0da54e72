// Dynamic resolution: frames of any size within one Frame::maxSize. Several views in a context.
#include <cstdio>
#include <functional>
#include <map>
#include <random>

#include "api/host.h"
#include "api/kept_pipelines.h"
#include "gpu/vulkan_counter.h"

namespace obscura::ao {
namespace {

using test::Geometry;
using test::Host;
using test::Picture;

// The same view at a share of 160 x 90 px.
Geometry sized(double share) {
    Geometry g;
    g.visible = {uint32_t(std::lround(160 * share)), uint32_t(std::lround(90 * share))};
    g.guard = {uint32_t(std::lround(16 * share)), uint32_t(std::lround(16 * share))};
    return g;
}
const VkExtent2D kMost = sized(1.0).size();

double meanOff(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i) sum += std::abs(double(a[i]) - b[i]);
    return sum / double(a.size());
}

class Dynamic : public test::GpuTest {
protected:
    gpu::Device& m_device = test::device();
    Host m_host{m_device};

    void SetUp() override {
        GpuTest::SetUp();
        test::KeptPipelines::attach(m_device);
    }
    void TearDown() override {
        m_host.clear();
        GpuTest::TearDown();
    }
    void make(Host& host, uint32_t views = 1) {
        host.clear();
        DeviceDesc d = host.desc();
        d.views = views;
        d.getInstanceProcAddr = &test::KeptPipelines::instanceProc;
        ASSERT_EQ(create(d, &host.context), Status::ok);
    }
    static void choose(Host& host, const char* method, const std::vector<Setting>& settings, const char* preset = "default") {
        MethodSettings chosen;
        chosen.preset = preset;
        chosen.settings = {settings.data(), settings.size()};
        chosen.falloff = {FalloffKind::quadratic, 1.5f, 0.0f};
        ASSERT_EQ(setMethod(host.context, method, chosen), Status::ok) << host.allSaid();
    }
    std::vector<float> run(Host& host, const Frame& frame, VkExtent2D visible) {
        const Output output = host.record(frame);
        EXPECT_EQ(output.status, Status::ok) << host.allSaid();
        EXPECT_EQ(output.size.width, visible.width);
        EXPECT_EQ(output.size.height, visible.height);
        return output.status == Status::ok ? host.pixels(output, visible) : std::vector<float>{};
    }
};

class DynamicMethod : public Dynamic, public testing::WithParamInterface<const char*> {};

// Bit for bit what a new context gives, and what one gives whose images have that size.
TEST_P(DynamicMethod, resultOfASizeDoesNotDependOnEarlierSizes) {
    const MethodInfo& info = *findMethod(GetParam());
    Host fixed(m_device), fresh(m_device);
    make(m_host);
    make(fixed);
    const auto frameOf = [&](Host& host, const Geometry& g, const Picture& seen, bool dynamic) {
        Frame f = host.frame({g}, seen);
        if (dynamic) f.maxSize = kMost;
        return f;
    };
    Geometry near = sized(1.0);
    near.camera.eye = {-0.5, 1.2, 2.5};
    const Picture other = test::trace(near);
    const auto compare = [&](const std::vector<Setting>& settings, const char* preset, std::initializer_list<double> shares, bool again) {
        choose(m_host, info.id, settings, preset);
        choose(fixed, info.id, settings, preset);
        run(m_host, frameOf(m_host, near, other, true), near.visible);  // what larger frames leave in the images
        for (const double share : shares) {
            const Geometry g = sized(share);
            const Picture seen = test::trace(g);
            const std::vector<float> found = run(m_host, frameOf(m_host, g, seen, true), g.visible);
            const std::string what = std::string(info.id) + ":" + preset +
                                     (settings.empty() ? "" : std::string(" ") + settings[0].id + " " + std::to_string(settings[0].value)) +
                                     " at " + std::to_string(share);
            const std::vector<float> exact = run(fixed, frameOf(fixed, g, seen, false), g.visible);
            // Only mipmap samples between the texels of an image that is larger than its view.
            if (std::string(info.id) == "mipmap") EXPECT_LE(meanOff(found, exact), 0.1 / 255.0) << what;
            else EXPECT_EQ(found, exact) << what;
            if (!again) continue;
            make(fresh);
            choose(fresh, info.id, settings, preset);
            EXPECT_EQ(found, run(fresh, frameOf(fresh, g, seen, true), g.visible)) << what << ", new context";
        }
    };
    for (const Preset& preset : info.presets) {
        const bool isDefault = std::string(preset.id) == "default";
        if (isDefault) compare({}, preset.id, {1.0, 0.5, 0.83, 0.67, 0.99}, false);
        compare({}, preset.id, {0.61}, isDefault);
        if (isDefault && std::string(info.id) == "mipmap") compare({}, preset.id, {0.5, 0.83}, true);
    }
    for (const Parameter& parameter : info.parameters)
        for (const char* id : {"offscreen", "depth_layers", "interleave", "rays_in"})
            if (std::string(parameter.id) == id)
                for (float value = 1.0f; value <= parameter.maximum; ++value) compare({{id, value}}, "default", {0.61}, false);
}
INSTANTIATE_TEST_SUITE_P(
    all, DynamicMethod, testing::ValuesIn(test::methodIds()), [](const auto& info) { return std::string(info.param); });

// Frames of random sizes between 50 and 100 %, of which none, but for the first few, makes a Vulkan object or allocates device memory.
TEST_F(Dynamic, changingSizesMakeNoObjects) {
    std::mt19937 random(20130717);
    std::uniform_int_distribution<int> percent(50, 100);
    std::map<int, Frame> frames;
    const auto frameOf = [&](int size) {
        if (const auto known = frames.find(size); known != frames.end()) return known->second;
        const Geometry g = sized(size * 0.01);
        const Picture seen = test::trace(g);
        const std::string set = " " + std::to_string(size);
        Frame f = m_host.frame({g}, seen, set);
        f.motion = m_host.floats("motion" + set, VK_FORMAT_R32G32_SFLOAT, f.size, std::vector<float>(2 * seen.depth.size(), 0.0f));
        f.maxSize = kMost;
        f.cut = false;
        return frames[size] = f;
    };
    for (int size = 50; size <= 100; ++size) frameOf(size);
    test::VulkanCounter counter(m_device);
    DeviceDesc d = m_host.desc();
    d.getInstanceProcAddr = &test::VulkanCounter::instanceProc;
    ASSERT_EQ(create(d, &m_host.context), Status::ok);
    uint64_t warm = 0;
    for (const MethodInfo* info : methods()) {
        choose(m_host, info->id, info->needs ? std::vector<Setting>{{"temporal", 0.92f}} : std::vector<Setting>{});
        const int count = std::string(info->id) == "gtao" ? 1000 : 40;
        uint64_t held = 0;
        for (int i = 0; i < count; ++i) {
            Frame f = frameOf(i < 3 ? 50 : percent(random));  // the first ones are the smallest
            f.index = uint64_t(i);
            counter.clear();
            ASSERT_EQ(m_host.record(f).status, Status::ok) << m_host.allSaid();
            if (i == 2) held = memoryUse(m_host.context);
            if (i < 3) continue;
            ++warm;
            for (const auto& [what, made] : counter.created) ASSERT_EQ(made, 0u) << what << ", " << info->id << ", frame " << i;
            // Images of methods before this one are given back after a while.
            ASSERT_LE(memoryUse(m_host.context), held) << info->id << ", frame " << i;
        }
    }
    std::printf("  %zu frames in which nothing was made\n", size_t(warm));
    m_host.clear();
}

// History survives a change of size: on a flight, with motion vectors and without, the error flickers less than that of pictures without
// noise if the size wanders by up to 4 % a frame, and much less than without history if it jumps. The truth is the mean of many pictures of
// the same camera at the largest size; pictures are enlarged to it. Edges in depth are left out: they move with the pixels of every size.
TEST_F(Dynamic, historyIsKeptThroughChangesOfSize) {
    constexpr int kFrames = 20, kFirst = 8, kPictures = 24;
    std::mt19937 random(7);
    std::vector<int> walk{75}, jumps;
    while (walk.size() < kFrames) walk.push_back(std::clamp(walk.back() + int(random() % 9) - 4, 50, 100));
    while (jumps.size() < kFrames) jumps.push_back(50 + int(random() % 51));
    const auto run20 = [](int percent) { return std::vector<int>(kFrames, percent); };
    for (const char* method : {"gtao", "hbao"})
        for (const bool orthographic : {false, true}) {
            make(m_host);
            choose(m_host, method, {{"temporal", 0.92f}});
            const auto geometry = [&](int percent, int frame) {
                Geometry g = sized(percent * 0.01);
                g.orthographic = orthographic;
                g.camera.eye += glm::dvec3(0.02, -0.01, -0.03) * double(frame);
                return g;
            };
            const auto frameOf = [&](const Geometry& g, const Picture& seen) {
                Frame f = m_host.frame({g}, seen);
                f.maxSize = kMost;
                return f;
            };
            const auto meanOf = [&](Frame f, const Geometry& g) {
                std::vector<float> mean(size_t(g.visible.width) * g.visible.height, 0.0f);
                for (f.index = 0; f.index < kPictures; ++f.index) {
                    const std::vector<float> one = run(m_host, f, g.visible);
                    for (size_t p = 0; p < one.size(); ++p) mean[p] += one[p] / float(kPictures);
                }
                return mean;
            };
            std::vector<std::vector<float>> truth(kFrames);
            for (int i = kFirst - 1; i < kFrames; ++i) {
                const Geometry g = geometry(100, i);
                truth[size_t(i)] = meanOf(frameOf(g, test::trace(g)), g);
            }
            enum class What : uint8_t { history, none, noNoise };
            const auto flicker = [&](const std::vector<int>& percents, bool hasMotion, What what = What::history) {
                std::vector<std::vector<float>> pictures;
                for (int i = 0; i < kFrames; ++i) {
                    const int last = std::max(i - 1, 0);
                    const Geometry g = geometry(percents[size_t(i)], i), before = geometry(percents[size_t(last)], last);
                    const Picture seen = test::trace(g);
                    Frame f = frameOf(g, seen);
                    f.cut = i == 0 || what != What::history;
                    f.index = uint64_t(i);
                    if (hasMotion) {  // in px of this frame
                        std::vector<float> motion = test::motionOf(g, before, seen);
                        const double x = double(f.size.width) / before.size().width, y = double(f.size.height) / before.size().height;
                        for (size_t p = 0; p < seen.depth.size(); ++p) {
                            const double px = double(p % f.size.width) + 0.5, py = double(p / f.size.width) + 0.5;
                            motion[2 * p] = float((motion[2 * p] + px) * x - px);
                            motion[2 * p + 1] = float((motion[2 * p + 1] + py) * y - py);
                        }
                        f.motion = m_host.floats("motion", VK_FORMAT_R32G32_SFLOAT, f.size, motion);
                    }
                    pictures.push_back(what == What::noNoise ? meanOf(f, g) : run(m_host, f, g.visible));
                }
                double sum = 0.0;
                size_t count = 0;
                for (int i = kFirst; i < kFrames; ++i) {
                    const Geometry g = geometry(percents[size_t(i)], i), before = geometry(percents[size_t(i - 1)], i - 1),
                                   full = geometry(100, i), fullBefore = geometry(100, i - 1);
                    const Picture seen = test::trace(full);
                    const std::vector<float> motion = test::motionOf(full, fullBefore, seen);
                    const auto isEdge = [&](size_t p) {
                        for (int y = -2; y <= 2; ++y)
                            for (int x = -2; x <= 2; ++x)
                                if (std::abs(seen.depth[p + size_t(y * int(kMost.width) + x)] - seen.depth[p]) > 0.05 * seen.depth[p])
                                    return true;
                        return false;
                    };
                    // At a place of the largest picture, guard band included, bilinear.
                    const auto at = [](const std::vector<float>& picture, const Geometry& of, double x, double y) {
                        const int w = int(of.visible.width), h = int(of.visible.height);
                        const double px = (x + 0.5) * of.size().width / kMost.width - 0.5 - of.guard.width,
                                     py = (y + 0.5) * of.size().height / kMost.height - 0.5 - of.guard.height;
                        const double left = std::floor(px), top = std::floor(py), fx = px - left, fy = py - top;
                        const auto texel = [&](int i, int k) {
                            return double(picture[size_t(std::clamp(int(top) + k, 0, h - 1)) * size_t(w) +
                                                  size_t(std::clamp(int(left) + i, 0, w - 1))]);
                        };
                        return (texel(0, 0) * (1 - fx) + texel(1, 0) * fx) * (1 - fy) + (texel(0, 1) * (1 - fx) + texel(1, 1) * fx) * fy;
                    };
                    for (uint32_t y = full.guard.height; y < full.guard.height + full.visible.height; ++y)
                        for (uint32_t x = full.guard.width; x < full.guard.width + full.visible.width; ++x) {
                            const size_t p = size_t(y) * kMost.width + x;
                            if (seen.depth[p] == 0.0 || isEdge(p)) continue;
                            const double bx = x + motion[2 * p], by = y + motion[2 * p + 1];
                            const double now = at(pictures[size_t(i)], g, x, y) - at(truth[size_t(i)], full, x, y),
                                         then = at(pictures[size_t(i - 1)], before, bx, by) - at(truth[size_t(i - 1)], fullBefore, bx, by);
                            sum += std::abs(now - then);
                            ++count;
                        }
                }
                return 255.0 * sum / double(count);
            };
            const double noNoise = flicker(walk, false, What::noNoise);
            for (const bool hasMotion : {true, false}) {
                double fixed = 0.0;
                for (const int percent : {50, 75, 100}) fixed += flicker(run20(percent), hasMotion) / 3.0;
                const double walking = flicker(walk, hasMotion), jumping = flicker(jumps, hasMotion),
                             none = flicker(jumps, hasMotion, What::none);
                std::printf(
                    "  %s%s%s: flicker of the error in 255ths: fixed sizes %.3f; sizes that wander %.3f, %.2f times, without noise "
                    "%.3f; sizes that jump %.3f, %.2f times, without history %.3f\n",
                    method, hasMotion ? ", motion" : "", orthographic ? ", orthographic" : "", fixed, walking, walking / fixed, noNoise,
                    jumping, jumping / fixed, none);
                EXPECT_LE(walking, noNoise) << method;
                EXPECT_LE(walking, (orthographic ? 3.0 : 1.8) * fixed) << method;
                EXPECT_LE(jumping, 0.6 * none) << method;
            }
        }
}

TEST_F(Dynamic, sizesAreCheckedAndMemoryIsForetold) {
    Host images(m_device);
    make(m_host);
    const Geometry g = sized(0.5), full = sized(1.0);
    Frame f = images.frame({g}, test::trace(g)), large = images.frame({full}, test::trace(full), " full");
    large.maxSize = kMost;
    f.maxSize = {kMost.width, f.size.height - 1};
    EXPECT_EQ(m_host.record(f).status, Status::invalid);
    EXPECT_TRUE(m_host.said("more than Frame::maxSize")) << m_host.allSaid();
    f.maxSize = {1u << 24, 1u << 24};
    EXPECT_EQ(m_host.record(f).status, Status::unsupported);
    f.maxSize = kMost;
    f.view = 1;
    EXPECT_EQ(m_host.record(f).status, Status::invalid);
    EXPECT_TRUE(m_host.said("Frame::view is 1; DeviceDesc::views is 1")) << m_host.allSaid();
    f.view = 0;
    for (const char* method : {"gtao", "far_field", "multi_resolution", "statistical", "mipmap"}) {
        make(m_host);
        choose(m_host, method, {{"temporal", 0.9f}});
        const uint64_t foretold = memoryUse(m_host.context, f);
        for (int i = 0; i < 4; ++i) run(m_host, f, g.visible);
        EXPECT_EQ(memoryUse(m_host.context), foretold) << method;
        for (int i = 0; i < 4; ++i) run(m_host, large, full.visible);
        EXPECT_EQ(memoryUse(m_host.context), foretold) << method;

        // trim() leaves what frames like the last one need.
        Frame small = f;
        small.maxSize = {};
        make(m_host);
        choose(m_host, method, {{"temporal", 0.9f}});
        const uint64_t least = memoryUse(m_host.context, small);
        EXPECT_LT(least, foretold) << method;
        for (int i = 0; i < 4; ++i) run(m_host, large, full.visible);
        for (int i = 0; i < 4; ++i) run(m_host, small, g.visible);
        EXPECT_GT(memoryUse(m_host.context), least) << method;
        trim(m_host.context);
        for (int i = 0; i < 6; ++i) run(m_host, small, g.visible);
        EXPECT_EQ(memoryUse(m_host.context), least) << method;
    }
    trim(nullptr);
}

// Two views in one context are as each in a context of its own, and a view that pauses keeps its history.
TEST_F(Dynamic, eachViewHasItsOwnHistory) {
    Host left(m_device), right(m_device);
    make(m_host, 2);
    make(left);
    make(right);
    for (Host* host : {&m_host, &left, &right}) choose(*host, "gtao", {{"temporal", 0.92f}});
    for (int i = 0; i < 6; ++i)
        for (const uint32_t view : {0u, 1u}) {
            Geometry g = sized(view ? 0.8 : 1.0);
            g.camera.eye += glm::dvec3(view ? 2.0 : 0.0, 0.0, 0.03 * i);
            const Picture seen = test::trace(g);
            Frame f = m_host.frame({g}, seen, view ? " right" : " left");
            f.index = uint64_t(i);
            f.cut = i == 0;
            f.view = view;
            f.maxSize = kMost;
            Frame own = f;
            own.view = 0;
            EXPECT_EQ(run(m_host, f, g.visible), run(view ? right : left, own, g.visible)) << "frame " << i << ", view " << view;
        }
}

}  // namespace
}  // namespace obscura::ao
