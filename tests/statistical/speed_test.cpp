// What the method's cost does and does not depend on. Variants take turns in one process and the best of many frames counts,
// so that what else the machine does is left out; margins are wide all the same.
#include <map>

#include "statistical/bench.h"

namespace obscura::test {
namespace {

class StatisticalSpeed : public StatisticalTest {
protected:
    using Times = std::map<std::string, double>;  // milliseconds by pass, the best

    std::vector<Times> race(const Room& room, const std::vector<ao::Values>& variants, uint32_t rounds) {
        std::vector<Times> best(variants.size());
        std::map<uint64_t, size_t> variantOf;
        for (uint32_t i = 0; i < rounds * variants.size(); ++i) {
            run(room, variants[i % variants.size()]);
            variantOf[m_device.frame()] = i % variants.size();
            const auto& timings = m_graph->timings();
            const auto known = variantOf.find(timings.frame);
            if (known == variantOf.end()) continue;
            for (const graph::PassTime& pass : timings.passes) {
                const auto at = best[known->second].try_emplace(pass.name, 1e9).first;
                at->second = std::min(at->second, pass.milliseconds);
            }
        }
        return best;
    }
    static double sum(const Times& times, std::initializer_list<const char*> parts) {
        double result = 0.0;
        for (const auto& [name, time] : times)
            for (const char* part : parts)
                if (name.find(part) != std::string::npos) result += time;
        return result;
    }
    static Room hills() {
        Room room;
        room.width = 320;
        room.height = 180;
        room.guard = 20;
        room.wall = -6.0f;
        room.build();
        return room;
    }
};

TEST_F(StatisticalSpeed, theRadiusCostsNothing) {
    const std::vector<Times> best = race(hills(), {values({{"radius", 0.05f}}), values({{"radius", 1}}), values({{"radius", 4}})}, 40);
    const double small = sum(best[0], {"statistical."}), middle = sum(best[1], {"statistical."}), large = sum(best[2], {"statistical."});
    printf("half width 0.05 m %.2f ms, 1 m %.2f ms, 4 m %.2f ms\n", small, middle, large);
    EXPECT_LT(std::max({small, middle, large}), 1.3 * std::min({small, middle, large}));
}

TEST_F(StatisticalSpeed, smallerTablesAreCheaper) {
    const std::vector<Times> best = race(hills(), {values({}, "paper"), values({}, "paper_half")}, 30);
    const auto tables = {"statistical.root", "statistical.first", "statistical.second"};
    const double full = sum(best[0], tables), half = sum(best[1], tables);
    printf("four tables of full size %.2f ms, of half size %.2f ms: %.1f times as fast\n", full, half, full / half);
    EXPECT_GT(full, 2.5 * half);
}

}  // namespace
}  // namespace obscura::test
