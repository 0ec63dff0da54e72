// The method's work does not depend on the falloff, counted: dispatches, workgroups, pipelines, constants, memory. The times that go with it:
//     obscura-bench --scene atrium --method far_field --falloff exponential:0.25,exponential:100,wendland:2,constant:1,ramp:0.385:1
#include <cstddef>

#include "ao/methods/far_field_parts.h"
#include "far_field/bench.h"
#include "gpu/vulkan_counter.h"

namespace obscura::test {
namespace {

class FarFieldCost : public FarFieldTest {
protected:
    VulkanCounter m_counter{m_device};
};

// Intervals, samples and directions are counted by FarFieldConstants and by the grids' size. All of these are the same for every falloff but
// for `unit`, by which depths are scaled; the falloff itself is in a table of one size, which is filled when the falloff changes.
TEST_F(FarFieldCost, isTheSameForEveryFalloff) {
    const Room room = crease(200, 150, 20);
    const char* const falloffs[] = {"exponential:1", "exponential:0.25", "exponential:100", "wendland:2", "constant:1", "ramp:0.385:1",
                                    "quadratic:2"};
    constexpr size_t kUnit = offsetof(shared::FarFieldConstants, unit);
    for (const char* preset : {"default", "paper_8x2"}) {
        SCOPED_TRACE(preset);
        std::vector<Dispatch> first;
        uint64_t bytes = 0;
        Dispatch table;
        for (const char* falloff : falloffs) {
            SCOPED_TRACE(falloff);
            run(room, values({}, preset), falloff);  // makes the table
            m_counter.clear();
            run(room, values({}, preset), falloff);
            std::vector<Dispatch> now = m_counter.dispatchesOf("far_field.");
            EXPECT_EQ(m_counter.dispatchesOf("far_field.table").size(), 0u) << "a table that is there is not made again";
            EXPECT_GE(now.size(), 2u);
            for (Dispatch& d : now) {
                ASSERT_GE(d.constants.size(), sizeof(shared::FarFieldConstants)) << d.pass;
                EXPECT_GT(d.constant<float>(kUnit), 0.0f) << d.pass;
                std::fill_n(d.constants.begin() + kUnit, sizeof(float), std::byte(0));
            }
            if (first.empty()) first = now, bytes = m_graph->frameBytes();
            EXPECT_EQ(now, first);
            EXPECT_EQ(m_graph->frameBytes(), bytes);
        }
        for (const char* falloff : falloffs) {
            m_counter.clear();
            run(room, values({}, preset), falloff);
            const std::vector<Dispatch> made = m_counter.dispatchesOf("far_field.table");
            ASSERT_EQ(made.size(), 1u) << falloff;
            if (!table.pipeline) table = made[0];
            EXPECT_EQ(made[0].pipeline, table.pipeline) << falloff;
            EXPECT_EQ(made[0].groups, table.groups) << falloff;
        }
    }
}

}  // namespace
}  // namespace obscura::test
