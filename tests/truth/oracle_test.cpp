// Both ray-traced references against stored ones of independent implementations. The folder lies beside the project or is
// named by OBSCURA_ORACLE; without it these tests are skipped.
#include <ctime>

#include "folders.h"
#include "gpu/test_device.h"
#include "truth/screen_reference.h"
#include "truth/world_reference.h"

namespace {

using namespace obscura;
using namespace obscura::truth;
namespace fs = std::filesystem;

// "quadratic_2" -> quadratic:2
RayFalloff falloffOf(const std::string& channel) {
    const std::string name = channel.substr(channel.find('.') + 1);
    if (name == "xegtao_1") return rayFalloff("ramp:0.385:1");
    const size_t bar = name.find('_');
    return rayFalloff(name.substr(0, bar) + ":" + name.substr(bar + 1));
}

struct Stored {
    CapturedFrame frame;
    std::vector<Picture::Channel> channels;
    std::vector<RayFalloff> falloffs;

    Stored(const std::string& name, const std::string& kind) {
        const fs::path oracle = test::oracleFolder();
        if (!fs::exists(oracle / (name + ".json")))
            test::skip("no " + (oracle / name).string() + ".json; set OBSCURA_ORACLE to the stored references");
        frame = readCapture(oracle / name);
        for (const auto& channel : readExr(oracle / (name + ".reference.exr")).channels)
            if (channel.name.starts_with(kind + ".")) {
                channels.push_back(channel);
                falloffs.push_back(falloffOf(channel.name));
            }
    }

    void expectClose(const std::string& name, const Reference& reference, double allowed) const {
        ASSERT_FALSE(channels.empty());
        for (size_t c = 0; c < channels.size(); ++c) {
            double sum = 0.0;
            size_t count = 0;
            for (size_t i = 0; i < channels[c].values.size(); ++i) {
                if (reference.rays.values[i] == 0.0f) continue;
                sum += std::fabs(reference.channels[c].obscurance.values[i] - channels[c].values[i]);
                ++count;
            }
            ASSERT_GT(count, 2000u);
            const double difference = sum / double(count);
            printf("%-8s %-20s mean absolute difference %.5f, standard error %.5f, %zu pixels\n", name.c_str(), channels[c].name.c_str(),
                difference, double(reference.meanError(c)), count);
            EXPECT_LE(difference, allowed) << name << " " << channels[c].name;
        }
    }
};

void expectWorld(const std::string& name, const fs::path& file, uint32_t stride) {
    const Stored stored(name, "world");
    if (!fs::exists(file)) test::skip("no " + file.string());
    scene::World world;
    scene::Instance instance;
    instance.model = scene::loadGltf(file, {.loadImages = false});
    world.add(instance);
    const WorldReference reference(scene::pose(world, 0.0f), {.skipMasked = true});
    WorldOptions options;
    options.minRays = options.maxRays = 1024;
    options.targetError = 0.0f;
    options.stride = stride;
    stored.expectClose(name, reference.trace(stored.frame, stored.falloffs, options), 0.004);
}

TEST(WorldOracle, corner) { expectWorld("corner", test::oracleFolder() / "corner.glb", 4); }
TEST(WorldOracle, sphere) { expectWorld("sphere", test::oracleFolder() / "sphere.glb", 3); }
TEST(WorldOracle, atrium) { expectWorld("atrium", test::oracleFolder() / "atrium.glb", 4); }
TEST(WorldOracle, sponza) { expectWorld("sponza_a", test::contentFolder() / "sponza/512/Sponza.gltf", 9); }
TEST(WorldOracle, dragon) { expectWorld("dragon", test::contentFolder() / "scenes/dragon.glb", 8); }

// A measurement, not a test: obscura_truth_tests --gtest_also_run_disabled_tests --gtest_filter='*raysPerSecond'
TEST(WorldOracle, DISABLED_raysPerSecond) {
    const Stored stored("sponza_a", "world");
    const fs::path file = test::contentFolder() / "sponza/512/Sponza.gltf";
    if (!fs::exists(file)) test::skip("no " + file.string());
    scene::World world;
    scene::Instance instance;
    instance.model = scene::loadGltf(file);
    world.add(instance);
    const auto posed = scene::pose(world, 0.0f);
    const auto processorSeconds = [] {
        timespec time{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
    };
    for (const bool skipMasked : {true, false}) {
        const WorldReference reference(posed, {.skipMasked = skipMasked});
        printf("%zu triangles, tree in %.2f s, masked primitives %s\n", reference.triangles(), reference.buildSeconds(),
            skipMasked ? "skipped" : "included");
        for (const char* falloff : {"constant:2", "quadratic:2", "exponential:1"})
            for (const bool packets : {false, true})
                for (const uint32_t threads : {1u, 2u}) {
                    WorldOptions options;
                    options.minRays = options.maxRays = 256;
                    options.targetError = 0.0f;
                    options.stride = 6;
                    options.threads = threads;
                    options.packets = packets;
                    const std::vector falloffs{rayFalloff(falloff)};
                    const double start = processorSeconds();
                    const Reference result = reference.trace(stored.frame, falloffs, options);
                    const double used = processorSeconds() - start;
                    printf("  %-14s %-7s %u threads: %5.2f million rays/s, %5.2f per CPU second\n", falloff, packets ? "packets" : "single",
                        threads, 1e-6 * double(result.totalRays) / result.seconds, 1e-6 * double(result.totalRays) / used);
                }
    }
}

class ScreenOracle : public test::GpuTest {
protected:
    void expectScreen(const std::string& name, uint32_t stride) {
        const Stored stored(name, "screen");
        gpu::ShaderLibrary shaders;
        shaders.add(truth::shaders());
        ScreenReference reference(test::device(), shaders);
        ScreenOptions options;
        options.minRays = options.maxRays = 256;
        options.targetError = 0.0f;
        options.stride = stride;
        stored.expectClose(name, reference.trace(stored.frame, stored.falloffs, options), 0.01);
    }
};

TEST_F(ScreenOracle, corner) { expectScreen("corner", 4); }
TEST_F(ScreenOracle, sphere) { expectScreen("sphere", 3); }
TEST_F(ScreenOracle, atrium) { expectScreen("atrium", 4); }

}  // namespace
