// The search on functions with a known minimum, the parameter space, the objective, and acceptance on held-out scenes.
#include <cmath>

#include <gtest/gtest.h>

#include "app/complaint.h"
#include "search.h"
#include "space.h"
#include "tune.h"

namespace obscura::tune {
namespace {

measure::Candidate hand(const char* method, const char* preset = "default") { return measure::candidates({method}, {preset}, {})[0]; }

TEST(Search, findsTheMinimumOfABowlDeterministically) {
    const auto run = [](uint32_t seed, std::vector<std::vector<double>>& asked) {
        return search({0.9, 0.1, 0.5}, 150, seed, [&](const std::vector<double>& p) -> Answer {
            asked.push_back(p);
            return {std::pow(p[0] - 0.3, 2) + 2.0 * std::pow(p[1] - 0.7, 2) + 0.5 * std::pow(p[2] - 0.2, 2), true};
        });
    };
    std::vector<std::vector<double>> first, second;
    const std::vector<double> best = run(5, first);
    EXPECT_NEAR(best[0], 0.3, 0.05);
    EXPECT_NEAR(best[1], 0.7, 0.05);
    EXPECT_NEAR(best[2], 0.2, 0.08);
    EXPECT_EQ(first.front(), (std::vector<double>{0.9, 0.1, 0.5}));
    EXPECT_LE(first.size(), 150u);
    EXPECT_EQ(run(5, second), best);
    EXPECT_EQ(first, second);
}

TEST(Search, endsWhenAllIntegersAreTried) {
    size_t calls = 0;
    const std::vector<double> best =
        search({1.0}, 20, 1, [&](const std::vector<double>& p) -> Answer { return {std::round(p[0]), ++calls == 1}; });
    EXPECT_LT(best[0], 0.5);
    EXPECT_LT(calls, 2000u);
}

TEST(Space, startsAtThePresetAndStaysInRange) {
    const measure::Candidate start = hand("hbao", "8x4");
    const Space space(start, {"steps", "bias", "layered.sheet"});
    ASSERT_EQ(space.size(), 2u);
    EXPECT_TRUE(space.at(space.start()).settings.empty());
    const measure::Candidate low = space.at(std::vector<double>{0.0, 0.0}), high = space.at(std::vector<double>{1.0, 1.0});
    EXPECT_EQ(low.values["steps"], 1.0f);
    EXPECT_EQ(high.values["steps"], 16.0f);
    EXPECT_EQ(high.values["bias"], 40.0f);
    EXPECT_EQ(high.values["directions"], start.values["directions"]);
    EXPECT_EQ(high.label(), "hbao 8x4 steps=16 bias=40");
    EXPECT_THROW(Space(start, {"stepz"}), app::Complaint);
}

TEST(Space, defaultsToTheNumericParametersOfTheMethod) {
    for (const char* method : {"hbao", "layered", "hybrid", "far_field"}) {
        const Space space(hand(method), {});
        for (const std::string& setting : space.at(std::vector<double>(space.size(), 1.0)).settings) {
            EXPECT_FALSE(setting.starts_with("temporal") || setting.starts_with("offscreen")) << setting;
            for (const ao::Parameter& parameter : hand(method).info().parameters)
                EXPECT_FALSE(parameter.choices.size() > 0 && setting.starts_with(std::string(parameter.id) + "=")) << setting;
        }
    }
}

TEST(Objective, timeAndFlickerCostOnlyBeyondTheirLimits) {
    const Limits limits{1.0, 1.05};
    EXPECT_DOUBLE_EQ(objective({0.8, 1.0, 0.9, {}, {}}, limits), 0.8);
    EXPECT_GT(objective({0.8, 1.0, 1.2, {}, {}}, limits), 1.0);
    EXPECT_GT(objective({0.8, 1.3, 1.0, {}, {}}, limits), 1.0);
    EXPECT_DOUBLE_EQ(objective({0.8, 1.0, 1.9, {}, {}}, {2.0, 1.05}), 0.8);
}

TEST(Tuned, isAcceptedOnlyByHeldOutScenes) {
    Tuned t{hand("hbao"), hand("hbao"), {}, {}, {}, 1.0, 1.0, {"sponza@4 q", "sponza@4 e", "dragon@4 q"}};
    const Limits limits;
    t.heldOut = {0.95, 1.0, 1.0, {0.94, 0.94, 0.97}, {}};
    EXPECT_TRUE(t.real(limits));
    t.heldOut.errors = {0.90, 0.90, 1.05};  // worse on the dragon
    EXPECT_FALSE(t.real(limits));
    t.heldOut = {0.99, 1.0, 1.0, {0.99, 0.99, 0.99}, {}};
    EXPECT_FALSE(t.real(limits));
    t.heldOut = {0.90, 1.0, 1.2, {0.9, 0.9, 0.9}, {}};
    EXPECT_FALSE(t.real(limits));
    t.heldOut = {0.90, 1.3, 1.0, {0.9, 0.9, 0.9}, {}};
    EXPECT_FALSE(t.real(limits));
}

TEST(Tuned, presetTextListsNonInitialValues) {
    measure::Candidate candidate = hand("hbao", "8x4");
    candidate.values.set("spacing", 0.35f);
    EXPECT_EQ(presetText(candidate), "{\"directions\", 8}, {\"steps\", 4}, {\"spacing\", 0.35f}");
}

}  // namespace
}  // namespace obscura::tune
