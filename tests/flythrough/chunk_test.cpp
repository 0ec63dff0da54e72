// Chunks of a flythrough run: files, joining, summaries; the stability gate.
#include <fstream>

#include <gtest/gtest.h>

#include "app/complaint.h"
#include "gate.h"
#include "report.h"

namespace obscura::flythrough {
namespace {

Chunk chunk(uint32_t first, uint32_t end) {
    Chunk p;
    p.key = "abc";
    p.flythrough = "round";
    p.method = "hbao";
    p.preset = "default";
    p.filter = "raw";
    p.falloff = "quadratic:2";
    p.width = 32, p.height = 18, p.rays = 64;
    p.first = first, p.end = end;
    for (uint32_t i = first; i < end; ++i)
        p.frames.push_back({i, float(i) / 30.0f, 0.1f * float(i), 0.01f, 0.2f, i ? 0.9f : 0.0f, i ? 0.04f : 0.0f, i ? 0.01f : 0.0f,
            i ? 0.02f : 0.0f, i ? 0.015f : 0.0f});
    if (first == 0) p.still = StaticRow{0.001f, 0.004f};
    else p.events.push_back({first, 100, 3, 0.5f});
    p.passes.push_back({"hbao.horizons", 2.0, 3.0});
    return p;
}

TEST(Chunks, roundTripsThroughItsFile) {
    const auto file = std::filesystem::temp_directory_path() / "obscura-chunk-test.json";
    const Chunk written = chunk(0, 5);
    std::ofstream(file) << chunkText(written);
    const auto read = readChunk(file);
    ASSERT_TRUE(read);
    EXPECT_EQ(chunkText(*read), chunkText(written));
    EXPECT_EQ(framesCsv({*read}), framesCsv({written}));
    std::ofstream(file) << chunkText(written).substr(0, 100);
    EXPECT_FALSE(readChunk(file));
    std::filesystem::remove(file);
    EXPECT_FALSE(readChunk(file));
}

TEST(Chunks, joinInAnyOrder) {
    const std::vector<Chunk> whole = joined({chunk(4, 6), chunk(0, 4)});
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_EQ(whole[0].frames.size(), 6u);
    EXPECT_EQ(framesCsv(whole), framesCsv({chunk(0, 6)}));
    EXPECT_TRUE(whole[0].still);
    EXPECT_EQ(whole[0].events.size(), 1u);
}

TEST(Chunks, gapsOverlapsAndOtherSettingsAreErrors) {
    const auto complaint = [](std::vector<Chunk> chunks) {
        try {
            joined(std::move(chunks));
            return std::string();
        } catch (const app::Complaint& c) {
            return std::string(c.what());
        }
    };
    EXPECT_NE(complaint({chunk(0, 4), chunk(5, 6)}).find("missing"), std::string::npos);
    EXPECT_NE(complaint({chunk(0, 4), chunk(3, 6)}).find("twice"), std::string::npos);
    Chunk other = chunk(4, 6);
    other.key = "other";
    EXPECT_NE(complaint({chunk(0, 4), other}).find("different settings"), std::string::npos);
}

TEST(Chunks, summaryIgnoresTheFirstFrame) {
    const Summary s = summarize(chunk(0, 5));
    EXPECT_NEAR(s.eA, 0.2, 1e-6);
    EXPECT_NEAR(s.difference, 0.04, 1e-6);
    EXPECT_NEAR(s.excess, 0.03, 1e-6);
    EXPECT_NEAR(s.flickerOfError, 0.02, 1e-6);
    EXPECT_NEAR(s.referenceFlicker, 0.015, 1e-6);
    EXPECT_EQ(s.worst, 4u);
    EXPECT_EQ(s.milliseconds, 2.0);
    EXPECT_EQ(summarize(chunk(4, 6)).t90, 3u);
}

TEST(FlickerBaseline, roundTripsAndFailsWhenWorse) {
    FlickerBaseline baseline;
    const FlickerKey hbao{"hbao", "default", "teleport", "temporal"};
    baseline.rows[hbao] = {0.0100, 0.0010, 4};
    const auto file = std::filesystem::temp_directory_path() / "obscura-flicker-test.json";
    std::ofstream(file) << baselineText(baseline);
    EXPECT_EQ(baselineText(readBaseline(file)), baselineText(baseline));
    std::filesystem::remove(file);

    const auto lines = [&](FlickerRow row) { return judge(baseline, {{hbao, row}}).size(); };
    EXPECT_EQ(lines({0.0100, 0.0010, 4}), 0u);
    EXPECT_EQ(lines({0.0104, 0.0010, 4}), 0u);
    EXPECT_EQ(lines({0.0106, 0.0010, 4}), 1u);
    EXPECT_EQ(lines({0.0050, 0.0010, 5}), 1u);
    EXPECT_EQ(lines({0.0106, 0.0012, 5}), 3u);
    EXPECT_EQ(judge(baseline, {{{"new", "default", "teleport", "temporal"}, {}}}).size(), 1u);
}

}  // namespace
}  // namespace obscura::flythrough
