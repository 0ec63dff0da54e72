// Chunks of a flythrough run: files, joining, summaries; the stability gate.
#include <fstream>

#include <gtest/gtest.h>

#include "app/complaint.h"
#include "gate.h"
#include "report.h"

namespace obscura::flythrough {
namespace {

Part part(uint32_t first, uint32_t end) {
    Part p;
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

TEST(Parts, roundTripsThroughItsFile) {
    const auto file = std::filesystem::temp_directory_path() / "obscura-part-test.json";
    const Part written = part(0, 5);
    std::ofstream(file) << partText(written);
    const auto read = readPart(file);
    ASSERT_TRUE(read);
    EXPECT_EQ(partText(*read), partText(written));
    EXPECT_EQ(framesCsv({*read}), framesCsv({written}));
    std::ofstream(file) << partText(written).substr(0, 100);
    EXPECT_FALSE(readPart(file));
    std::filesystem::remove(file);
    EXPECT_FALSE(readPart(file));
}

TEST(Parts, joinInAnyOrder) {
    const std::vector<Part> whole = joined({part(4, 6), part(0, 4)});
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_EQ(whole[0].frames.size(), 6u);
    EXPECT_EQ(framesCsv(whole), framesCsv({part(0, 6)}));
    EXPECT_TRUE(whole[0].still);
    EXPECT_EQ(whole[0].events.size(), 1u);
}

TEST(Parts, gapsOverlapsAndOtherSettingsAreErrors) {
    const auto complaint = [](std::vector<Part> parts) {
        try {
            joined(std::move(parts));
            return std::string();
        } catch (const app::Complaint& c) {
            return std::string(c.what());
        }
    };
    EXPECT_NE(complaint({part(0, 4), part(5, 6)}).find("missing"), std::string::npos);
    EXPECT_NE(complaint({part(0, 4), part(3, 6)}).find("twice"), std::string::npos);
    Part other = part(4, 6);
    other.key = "other";
    EXPECT_NE(complaint({part(0, 4), other}).find("different settings"), std::string::npos);
}

TEST(Parts, summaryIgnoresTheFirstFrame) {
    const Summary s = summarize(part(0, 5));
    EXPECT_NEAR(s.eA, 0.2, 1e-6);
    EXPECT_NEAR(s.difference, 0.04, 1e-6);
    EXPECT_NEAR(s.excess, 0.03, 1e-6);
    EXPECT_NEAR(s.flickerOfError, 0.02, 1e-6);
    EXPECT_NEAR(s.referenceFlicker, 0.015, 1e-6);
    EXPECT_EQ(s.worst, 4u);
    EXPECT_EQ(s.milliseconds, 2.0);
    EXPECT_EQ(summarize(part(4, 6)).t90, 3u);
}

TEST(Calm, roundTripsAndFailsWhenWorse) {
    Calm baseline;
    const CalmKey hbao{"hbao", "default", "teleport", "temporal"};
    baseline.rows[hbao] = {0.0100, 0.0010, 4};
    const auto file = std::filesystem::temp_directory_path() / "obscura-calm-test.json";
    std::ofstream(file) << calmText(baseline);
    EXPECT_EQ(calmText(readCalm(file)), calmText(baseline));
    std::filesystem::remove(file);

    const auto lines = [&](CalmRow row) { return judge(baseline, {{hbao, row}}).size(); };
    EXPECT_EQ(lines({0.0100, 0.0010, 4}), 0u);
    EXPECT_EQ(lines({0.0104, 0.0010, 4}), 0u);
    EXPECT_EQ(lines({0.0106, 0.0010, 4}), 1u);
    EXPECT_EQ(lines({0.0050, 0.0010, 5}), 1u);
    EXPECT_EQ(lines({0.0106, 0.0012, 5}), 3u);
    EXPECT_EQ(judge(baseline, {{{"new", "default", "teleport", "temporal"}, {}}}).size(), 1u);
}

}  // namespace
}  // namespace obscura::flythrough
