// Pareto fronts, scaling exponents, comparisons, tables and lists of settings, on synthetic rows.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "../temporary_folder.h"
#include "app/complaint.h"
#include "compare.h"
#include "front.h"
#include "measure/candidate.h"
#include "rows.h"
#include "scaling.h"
#include "tables.h"

namespace obscura::bench {
namespace {

TEST(Bench, resultsRoundTripThroughTheirFile) {
    const Results written = results({row("hbao", "steps=4", 2.5, 0.05, true), row("layered", "", 4.0, 0.03)});
    const auto file = std::filesystem::temp_directory_path() / "obscura-bench-test.json";
    std::ofstream(file) << jsonText(written);
    EXPECT_EQ(jsonText(readResults(file)), jsonText(written));
    EXPECT_EQ(csv(readResults(file)), csv(written));
    std::ofstream(file) << jsonText(written).substr(0, 200);
    EXPECT_THROW(readResults(file), app::Complaint);
    // Counts that no 32 bits hold.
    for (const char* wrong : {"1e30", "-1", "4294967296", "1.5", "\"2\""}) {
        std::string text = jsonText(written);
        const size_t at = text.find("\"rounds\": ") + 10;
        std::ofstream(file) << text.replace(at, text.find(',', at) - at, wrong);
        EXPECT_THROW(readResults(file), app::Complaint) << wrong;
    }
    std::filesystem::remove(file);
}

TEST(Bench, frontHoldsUndominatedRows) {
    const Results r = results({row("slow", "", 9.0, 0.020), row("quick", "", 1.0, 0.080), row("worse", "", 5.0, 0.060),
        row("middle", "", 4.0, 0.040), row("none", "", 0.01, 0.3)});
    const std::vector<Front> list = fronts(r);
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].line, (std::vector<size_t>{1, 3, 0}));
    EXPECT_FALSE(list[0].both);
}

TEST(Bench, gapsAreBudgetsWhereABaselineLeads) {
    // A baseline method at 1 ms before any of ours, ours from 2 ms on, the baseline again from 6 ms, ours from 8 ms.
    const Results r = results(
        {row("yard", "a", 1.0, 0.08, true), row("ours", "a", 2.0, 0.05), row("yard", "b", 6.0, 0.04, true), row("ours", "b", 8.0, 0.03)});
    const std::vector<Front> list = fronts(r);
    ASSERT_EQ(list[0].gaps.size(), 2u);
    EXPECT_TRUE(list[0].both);
    EXPECT_EQ(list[0].gaps[0].from, 1.0);
    EXPECT_EQ(list[0].gaps[0].to, 2.0);
    EXPECT_EQ(list[0].gaps[0].ours, Gap::kNone);
    EXPECT_EQ(list[0].gaps[1].from, 6.0);
    EXPECT_EQ(list[0].gaps[1].to, 8.0);
    EXPECT_NE(gapText(list[0].gaps[1], r, "world").find("yard b (0.0400 in 6.00 ms) is ahead of ours a"), std::string::npos);
    EXPECT_TRUE(fronts(results({row("ours", "", 1.0, 0.05), row("yard", "", 2.0, 0.06, true)}))[0].gaps.empty());
    EXPECT_TRUE(std::isinf(fronts(results({row("ours", "", 1.0, 0.05), row("yard", "", 2.0, 0.04, true)}))[0].gaps[0].to));
}

TEST(Bench, exponentsMatchTheRows) {
    std::vector<Row> rows;
    for (const uint32_t scale : {1u, 2u, 4u}) {
        Row r = row("hbao", "", 0.5 * std::pow(double(scale), 2.2), 0.05);  // 1.1 over pixels
        r.width *= scale, r.height *= scale;
        rows.push_back(r);
    }
    for (const double steps : {4.0, 8.0, 16.0}) {
        Row r = row("hbao", "bias=5 steps=" + std::to_string(int(steps)), 0.2 * std::sqrt(steps), 0.05);
        r.varied = "steps", r.samples = steps;
        rows.push_back(r);
    }
    const std::vector<Fit> list = fits(results(rows));
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].axis, "pixels");
    EXPECT_NEAR(list[0].exponent, 1.1, 1e-9);
    EXPECT_NEAR(list[0].error, 0.0, 1e-6);
    EXPECT_EQ(list[1].axis, "steps");
    EXPECT_EQ(list[1].label, "hbao bias=5");
    EXPECT_NEAR(list[1].exponent, 0.5, 1e-9);
    EXPECT_NEAR(list[1].factor, 0.2, 1e-9);
    Fit bent{"x", "", "", {1.0, 2.0, 4.0}, {1.0, 4.0, 4.0}};
    fit(bent);
    EXPECT_NEAR(bent.exponent, 1.0, 1e-9);
    EXPECT_NEAR(bent.error, 1.0 / std::sqrt(3.0), 1e-9);
}

class Compared : public testing::Test {
protected:
    Results m_before = results({row("a", "", 2.0, 0.05), row("b", "", 4.0, 0.04), row("c", "", 8.0, 0.03)});
    Results m_now = m_before;
    void scale(size_t i, double factor) {
        for (double& round : m_now.rows[i].rounds) round *= factor;
        m_now.rows[i].median *= factor, m_now.rows[i].passes[0].median *= factor;
    }
};

TEST_F(Compared, unchangedRunPasses) {
    const Comparison c = compare(m_before, m_now, {});
    EXPECT_TRUE(c.passes());
    for (const TimeChange& t : c.times) {
        EXPECT_NEAR(t.ratio, 1.0, 1e-9);
        EXPECT_LE(t.low, 1.0);
        EXPECT_GE(t.high, 1.0);
    }
}

TEST_F(Compared, slowerMachineIsNoRegressionByDefault) {
    for (size_t i = 0; i < 3; ++i) scale(i, 1.5);
    const Comparison c = compare(m_before, m_now, {});
    EXPECT_TRUE(c.passes());
    EXPECT_NEAR(c.drift, 1.5, 1e-9);
    EXPECT_FALSE(compare(m_before, m_now, {.absolute = true}).passes());
}

TEST_F(Compared, slowerMethodFailsAndItsPassIsNamed) {
    scale(1, 1.2);
    const Comparison c = compare(m_before, m_now, {});
    EXPECT_FALSE(c.passes());
    EXPECT_TRUE(c.times[1].worse);
    EXPECT_FALSE(c.times[0].worse || c.times[2].worse);
    EXPECT_NEAR(c.times[1].ratio, 1.2, 0.01);
    EXPECT_NE(comparisonText(c, {}).find("SLOWER: b.only 4 -> 4.8 ms"), std::string::npos);
}

TEST_F(Compared, slowerWithinNoisePasses) {
    // The median is 20 % higher, but rounds scatter by a factor of two.
    m_before.rows[1].rounds = {3.0, 6.0, 4.0, 2.0, 5.0};
    m_now.rows[1].rounds = {3.6, 7.2, 4.8, 2.4, 6.0};
    EXPECT_TRUE(compare(m_before, m_now, {}).passes());
}

TEST_F(Compared, errorsFlickerMemoryAndMissingRowsFail) {
    const auto lines = [&] { return compare(m_before, m_now, {}).worse.size(); };
    m_now.rows[0].errors[0].eA = 0.0510;  // within 3 %
    EXPECT_EQ(lines(), 0u);
    m_now.rows[0].errors[0].eA = 0.0520;
    EXPECT_EQ(lines(), 1u);
    m_now.rows[1].flicker->ofError = 0.0045;
    EXPECT_EQ(lines(), 2u);
    m_now.rows[2].bytes = 1100000;
    EXPECT_EQ(lines(), 3u);
    m_now = m_before;
    m_now.rows.pop_back();
    EXPECT_EQ(compare(m_before, m_now, {}).missing.size(), 1u);
    EXPECT_FALSE(compare(m_before, m_now, {}).passes());
}

TEST_F(Compared, incomparableRunsAreReported) {
    m_now.device = "another";
    EXPECT_THROW(compare(m_before, m_now, {}), app::Complaint);
    m_now = m_before;
    m_now.rows[0].rounds.resize(2);
    EXPECT_THROW(compare(m_before, m_now, {}), app::Complaint);
    m_now = results({row("other", "", 1.0, 0.1)});
    EXPECT_THROW(compare(m_before, m_now, {}), app::Complaint);
}

TEST(Bench, tableMarksTheBestAndReplacesTheMarkedSection) {
    const Results r = results(
        {row("quick", "", 1.0, 0.08), row("yard", "", 2.0, 0.09, true), row("slow", "x=1", 4.0, 0.02), row("dear", "x=2", 8.0, 0.03)});
    const std::string all = markdown(r), brief = briefTable(r);
    EXPECT_NE(all.find("| **quick** | 1.00 |"), std::string::npos);
    EXPECT_NE(all.find("| yard (baseline) | 2.00 |"), std::string::npos);
    EXPECT_NE(all.find("| dear x=2 |"), std::string::npos);
    EXPECT_NE(brief.find("| **slow x=1** |"), std::string::npos);
    EXPECT_EQ(brief.find("dear"), std::string::npos);
    const std::string table = briefTable(results(
        {row("hbao", "", 1.0, 0.08, true), row("layered", "", 2.0, 0.04), row("hybrid", "", 3.0, 0.09), row("gtao", "", 4.0, 0.09, true)}));
    EXPECT_NE(table.find("(baseline) | Bavoil, Sainz, Dimitrov 2008 | depth, normals, (layers) | 1.00 |"), std::string::npos) << table;
    EXPECT_NE(table.find("| **layered** | our own | depth, normals, (layers) |"), std::string::npos);
    EXPECT_NE(table.find("| depth, normals, voxels | 3.00 |"), std::string::npos);
    EXPECT_NE(table.find("| Jimenez, Wu, Pesce, Jarabo 2016; XeGTAO, Strugar, McCalla 2021 |"), std::string::npos);
    EXPECT_EQ(citation("Timonen: Screen-Space Far-Field, HPG 2013, section 5"), "Timonen 2013");
    EXPECT_EQ(citation("Mittring: Finding Next Gen, CryEngine 2, SIGGRAPH 2007 courses; hemisphere form: de Vries, LearnOpenGL"),
        "Mittring 2007; hemisphere form: de Vries, LearnOpenGL");
    EXPECT_EQ(citation(""), "");
    const auto page = [](const Markers& markers, const std::string& table) {
        return std::string("before\n") + markers.begin + "\n" + table + markers.end + "\nafter\n";
    };
    Results measured = results({row("hbao", "", 2.0, 0.1), row("gtao", "", 1.0, 0.2)});
    EXPECT_EQ(withTables(page(kTimes, "old\n"), &measured, "x.md"), page(kTimes, briefTable(measured)));
    EXPECT_EQ(withTables(page(kTimes, "old\n"), nullptr, "x.md"), page(kTimes, "old\n"));
    EXPECT_THROW(withTables("before\n", &measured, "x.md"), app::Complaint);
    EXPECT_THROW(withTables(page(kCosts, ""), &measured, "x.md"), app::Complaint) << "no costs were counted";
    measured.gpu = "navi21", measured.gpuCompiler = "Mesa";
    measured.rows[0].gpu = GpuCost{2000, 0.25, 0.125, 40, 24, true, ""};
    measured.rows[1].gpu = GpuCost{3000, 0.5, 0.125, 48, 20, false, ""};
    const std::string costs = withTables(page(kCosts, ""), &measured, "x.md");
    EXPECT_EQ(costs, page(kCosts, costTable(measured)));
    const size_t cheap = costs.find("| ~2000 | 0.25 | 0.12 | 40 | 24 |"), dear = costs.find("| 3000 | 0.50 | 0.12 | 48 | 20 |");
    EXPECT_NE(dear, std::string::npos) << costs;
    EXPECT_LT(cheap, dear) << costs;
    const Results read = [&] {
        const test::TemporaryFolder folder;
        std::ofstream(folder.path() / "bench.json") << jsonText(measured);
        return readResults(folder.path() / "bench.json");
    }();
    EXPECT_EQ(costTable(read), costTable(measured));
}

TEST(Bench, listsOfSettingsExpandToEveryCombination) {
    const auto list =
        measure::variants({"hbao", "hybrid"}, {"default"}, {"hbao.steps=4,8", "hbao.directions=2,3", "voxels=64,128", "temporal=0.5"});
    std::vector<std::string> labels(list.size());
    std::transform(list.begin(), list.end(), labels.begin(), [](const measure::Candidate& candidate) { return candidate.label(); });
    EXPECT_EQ(labels, (std::vector<std::string>{"hbao steps=4 directions=2 temporal=0.5", "hbao steps=4 directions=3 temporal=0.5",
                          "hbao steps=8 directions=2 temporal=0.5", "hbao steps=8 directions=3 temporal=0.5",
                          "hybrid voxels=64 temporal=0.5", "hybrid voxels=128 temporal=0.5"}));
    EXPECT_EQ(list[0].varied, (std::vector<std::string>{"steps", "directions"}));
    EXPECT_EQ(list[4].voxels.over({}).cells, 64u);
    EXPECT_EQ(list[5].voxels.over({}).cells, 128u);
    EXPECT_THROW(measure::variants({"hbao"}, {"default"}, {"voxels=64"}), app::Complaint);
}

}  // namespace
}  // namespace obscura::bench
