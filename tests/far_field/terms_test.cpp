// Terms of the estimator: the falloff table against its integrals, sector widths, planes, and the grids in memory.
#include <bit>

#include "far_field/fixture.h"

namespace obscura::test {
namespace {

constexpr double kPi = 3.14159265358979;
constexpr uint32_t kColumns = 64, kRows = 128;

struct Table {
    std::vector<uint16_t> halves;
    // A0, A1, A2 at a column's angle, or at the next column's.
    double at(uint32_t column, uint32_t row, int which, bool next = false) const {
        return halfToFloat(halves[(size_t(row) * kColumns + column) * 8 + 2 * which + (next ? 1 : 0)]);
    }
};

class FalloffTableTest : public FarFieldTest {
protected:
    Table make(const char* text) {
        ao::Inputs inputs;
        EXPECT_TRUE(ao::parseFalloff(text, inputs.falloffDesc));
        ao::FalloffTable table;
        EXPECT_EQ(ao::FalloffTable::create(m_device, m_shaders, table), gpu::Status::ok);
        inputs.falloff = ao::falloffBlock(inputs.falloffDesc);
        Table result;
        result.halves.resize(size_t(kColumns) * kRows * 8);
        m_device.nextFrame();
        m_graph->begin();
        const gpu::Buffer back = readBack(*m_graph, table.add(*m_graph, inputs, "table"));
        EXPECT_EQ(
            m_device.runNow([&](VkCommandBuffer cmd) { EXPECT_EQ(m_executor->execute(*m_graph, cmd), gpu::Status::ok); }), gpu::Status::ok);
        std::memcpy(result.halves.data(), back.mapped(), result.halves.size() * 2);
        return result;
    }
};

TEST_F(FalloffTableTest, holdsTheIntegralsOfEveryFalloff) {
    for (const char* text : {"exponential:1", "linear:1.5", "quadratic:2", "wendland:2", "constant:1", "ramp:0.4:1"}) {
        const Table table = make(text);
        ao::Falloff rho;
        ao::parseFalloff(text, rho);
        for (const uint32_t row : {0u, 20u, 42u, 63u, 100u, 126u}) {
            const double v = row / double(kRows - 1), b = v * double(rho.length) / (1.0 - v);
            double a[3] = {0, 0, 0};
            const int steps = 2000;
            for (uint32_t column = 0; column < kColumns; ++column) {
                for (int which = 0; which < 3; ++which) {
                    ASSERT_NEAR(table.at(column, row, which), a[which], 0.004)
                        << text << " column " << column << " row " << row << " A" << which;
                    if (column) {
                        ASSERT_EQ(table.at(column, row, which), table.at(column - 1, row, which, true));
                    }
                }
                for (int i = 0; i < steps; ++i) {
                    const double t = (column + (i + 0.5) / steps) * kPi / (kColumns - 1),
                                 weight = double(ao::evaluate(rho, float(b / std::sin(t)))) * kPi / (kColumns - 1) / steps;
                    a[0] += weight;
                    a[1] += weight * std::cos(2 * t);
                    a[2] += weight * std::sin(2 * t);
                }
            }
        }
        for (int which = 0; which < 3; ++which)
            EXPECT_EQ(table.at(kColumns - 1, kRows - 1, which), 0.0) << "nothing is blocked at infinity";
    }
}

TEST_F(FalloffTableTest, knownValuesAndSymmetry) {
    const Table table = make("exponential:1");
    EXPECT_NEAR(table.at(kColumns - 1, 0, 0), kPi, 0.002);
    EXPECT_NEAR(table.at(kColumns - 1, 0, 1), 0.0, 0.002);
    EXPECT_NEAR(table.at(kColumns - 1, 0, 2), 0.0, 0.002);
    const double row = (kRows - 1) / 3.0, f = row - 42.0;  // b = 0.5: v = 1/3
    const auto at = [&](uint32_t column, int which) { return table.at(column, 42, which) * (1 - f) + table.at(column, 43, which) * f; };
    EXPECT_NEAR(at(kColumns - 1, 0), 1.28740, 0.003);
    EXPECT_NEAR(at(kColumns - 1, 1), -0.41804, 0.003);
    EXPECT_NEAR(at(kColumns - 1, 2), 0.0, 0.003);
    for (uint32_t i = 0; i < kColumns; ++i) {
        const uint32_t j = kColumns - 1 - i;
        EXPECT_NEAR(at(j, 0), at(kColumns - 1, 0) - at(i, 0), 0.003);
        EXPECT_NEAR(at(j, 1), at(kColumns - 1, 1) - at(i, 1), 0.003);
        EXPECT_NEAR(at(j, 2), at(i, 2), 0.003);
    }
}

TEST_F(FarFieldTest, tableIsFilledOnlyWhenTheFalloffChanges) {
    const Room room = crease();
    run(room, values({}), "exponential:1");
    EXPECT_TRUE(m_passes.count("far_field.table"));
    run(room, values({}), "exponential:1");
    EXPECT_FALSE(m_passes.count("far_field.table"));
    const Picture one = run(room, values({}), "exponential:2");
    EXPECT_TRUE(m_passes.count("far_field.table"));
    run(room, values({}), "linear:2");
    EXPECT_TRUE(m_passes.count("far_field.table"));
    EXPECT_EQ(run(room, values({}), "exponential:2"), one);
}

// At the bottom of a hole 1 px wide the whole hemisphere is blocked, for any normal. The deviation from 1 comes from K planes standing for
// the hemisphere, and from sector widths that do not add up to a full turn.
TEST_F(FarFieldTest, blockedHemisphereIsOne) {
    struct Case {
        float directions, most;
    };
    for (const auto& [directions, most] : {Case{8, 0.072f}, Case{16, 0.020f}, Case{32, 0.009f}}) {
        double sum = 0.0;
        int count = 0;
        for (const std::array<float, 3> n :
            {std::array{0.0f, 0.0f, 1.0f}, {0.5f, 0.0f, 0.9f}, {-0.3f, 0.6f, 0.7f}, {0.2f, -0.9f, 0.3f}, {0.7f, 0.7f, 0.2f}}) {
            Room room = plane({0.0f, 0.0f, 1.0f});
            const size_t middle = size_t(room.height / 2) * room.width + room.width / 2;
            room.depth[middle] = 40.0f;
            const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            for (int c = 0; c < 3; ++c) room.normals[4 * middle + c] = n[c] / length;
            const Picture picture =
                run(room, values({{"directions", directions}, {"segments", 1}, {"estimator", 0}, {"averaging", 0}}), "constant:1000");
            const float blocked = picture[size_t(room.height / 2 - room.guard) * room.visibleWidth() + room.width / 2 - room.guard];
            EXPECT_GT(blocked, 1.0f - most) << directions << " directions";
            sum += double(blocked);
            ++count;
        }
        EXPECT_NEAR(sum / count, 1.0, 0.6 * double(most)) << directions << " directions";
    }
}

// Planes at depths that few bits cannot hold.
TEST_F(FarFieldTest, planesAreOpen) {
    const auto at = [](const std::array<float, 3>& normal, float scale) {
        Room room = plane(normal);
        for (float& z : room.depth)
            if (z < 5e3f) z *= scale;
        return room;
    };
    for (const float scale : {1.0f, 0.61803f, 33.3337f}) {
        for (const char* preset : {"default", "fast", "paper_16x2", "paper_saao", "thin"})
            EXPECT_LT(highest(run(at({0, 0, 1}, scale), values({}, preset), "exponential:1")), 1e-5f) << preset << " " << scale;
        const Picture improved = run(at({0.5f, 0.3f, 1}, scale), values({}), "exponential:1"),
                      paper = run(at({0.5f, 0.3f, 1}, scale), values({{"interval", 5}}, "paper_16x2"), "exponential:1");
        EXPECT_LT(mean(improved), 0.0006) << scale;
        EXPECT_LT(highest(paper), 0.0045f) << scale;
        EXPECT_LT(highest(run(at({0, 1, 0}, scale), values({}), "exponential:1")), 0.02f) << scale;  // a floor up to the horizon
    }
}

TEST(FarFieldGrid, levelsDoNotOverlapAndOppositeDirectionsMirror) {
    for (const ao::Averaging averaging : {ao::Averaging::none, ao::Averaging::prefixSums, ao::Averaging::pyramid}) {
        for (const shared::uvec2 size : {shared::uvec2{8, 8}, {97, 61}, {384, 216}, {1536, 864}, {4916, 2766}}) {
            for (const uint32_t directions : {4u, 7u, 8u, 18u, 32u}) {
                const ao::FarFieldGrid grid = ao::farFieldGrid(size, directions, 5, 1, averaging, {1u << 28, 16384});
                EXPECT_LE(grid.bytes, 1u << 28);
                uint64_t end = 0;
                for (uint32_t i = 0; i < directions; ++i) {
                    // In the order of batches: directions, then their opposites.
                    const uint32_t sides = directions / grid.half, first = i / (sides * grid.batch) * grid.batch,
                                   count = std::min(grid.batch, grid.half - first), in = i - sides * first,
                                   k = in % count + first + in / count * grid.half;
                    const shared::Direction& d = grid.directions[k];
                    if (in == 0) end = 0;
                    EXPECT_EQ(d.base, end);
                    end += d.total;
                    const uint32_t shift = averaging == ao::Averaging::pyramid ? 2 : 1;
                    for (uint32_t n = 0; n < grid.levels; ++n) {  // as levelBase() counts
                        EXPECT_EQ(d.lines % (1u << n), 0u);
                        EXPECT_EQ(d.intervals % (1u << n), 0u);
                        const uint32_t from = d.total - (d.total >> (shift * n)),
                                       to = n + 1 < grid.levels ? d.total - (d.total >> (shift * (n + 1))) : d.total;
                        const uint64_t cells = uint64_t(averaging == ao::Averaging::pyramid ? d.lines >> n : d.lines) * (d.intervals >> n);
                        EXPECT_LE(from + cells, to) << "level " << n;
                    }
                    if (directions % 2 == 0 && k < directions / 2) {
                        EXPECT_EQ(d.lines, grid.directions[k + directions / 2].lines);
                        EXPECT_EQ(d.intervals, grid.directions[k + directions / 2].intervals);
                    }
                }
            }
        }
    }
}

TEST(FarFieldGrid, memoryMatchesTheGrid) {
    printf("memory of far_field's grids, MB (without the table, 128 KB, and images of the visible size)\n");
    for (const shared::uvec2 size : {shared::uvec2{768, 432}, {1536, 864}, {2304, 1296}, {4916, 2766}}) {
        for (const auto& [directions, interval, averaging, name] : {std::tuple{12u, 5u, ao::Averaging::pyramid, "default"},
                 {8u, 5u, ao::Averaging::pyramid, "8x4"}, {18u, 5u, ao::Averaging::pyramid, "fast"},
                 {8u, 10u, ao::Averaging::prefixSums, "paper_8x2"}, {16u, 10u, ao::Averaging::prefixSums, "paper_16x2"}}) {
            const ao::FarFieldGrid grid = ao::farFieldGrid(size, directions, interval, 1, averaging, {1u << 28, 16384});
            printf("%4ux%-4u %-10s K=%-2u B0=%-2u %6.1f, %u of %u at a time\n", size.x, size.y, name, directions, grid.interval,
                double(grid.bytes) * 1e-6, grid.batch, grid.half);
        }
    }
    EXPECT_LT(ao::farFieldGrid({1536, 864}, 8, 5, 1, ao::Averaging::pyramid).bytes, 24'000'000u);
}

}  // namespace
}  // namespace obscura::test
