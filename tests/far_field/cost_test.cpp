// The method's work is the same for every falloff, counted in dispatches, workgroups, pipelines, constants and memory. For times see
//     obscura-bench --scene atrium --method far_field --falloff exponential:0.25,exponential:100,wendland:2,constant:1,ramp:0.385:1
#include <cstddef>

#include "ao/falloff_table.h"
#include "far_field/fixture.h"
#include "gpu/vulkan_counter.h"

namespace obscura::test {
namespace {

class FarFieldCost : public FarFieldTest {
protected:
    VulkanCounter m_counter{m_device};
};

// FarFieldConstants and the size of the grids set the number of intervals, samples and directions. All are the same for every falloff,
// except `unit`, which scales depths. The falloff is in a table of fixed size, filled when the falloff changes.
TEST_F(FarFieldCost, isTheSameForEveryFalloff) {
    const Room room = crease(200, 150, 20);
    const char* const falloffs[] = {
        "exponential:1", "exponential:0.25", "exponential:100", "wendland:2", "constant:1", "ramp:0.385:1", "quadratic:2"};
    constexpr size_t kUnit = offsetof(shared::FarFieldConstants, unit);
    for (const char* preset : {"default", "paper_8x2"}) {
        SCOPED_TRACE(preset);
        std::vector<Dispatch> first;
        uint64_t bytes = 0;
        Dispatch table;
        for (const char* falloff : falloffs) {
            SCOPED_TRACE(falloff);
            run(room, values({}, preset), falloff);  // fills the table
            m_counter.clear();
            run(room, values({}, preset), falloff);
            std::vector<Dispatch> now = m_counter.dispatchesOf("far_field.");
            EXPECT_EQ(m_counter.dispatchesOf("far_field.table").size(), 0u) << "an existing table is not filled again";
            EXPECT_GE(now.size(), 2u);
            for (Dispatch& d : now) {
                ASSERT_GE(d.constants.size(), sizeof(shared::FarFieldConstants)) << d.pass;
                EXPECT_GT(d.constant<float>(kUnit), 0.0f) << d.pass;
                std::fill_n(d.constants.begin() + kUnit, sizeof(float), std::byte(0));
            }
            if (first.empty()) first = now, bytes = m_executor->frameBytes();
            EXPECT_EQ(now, first);
            EXPECT_EQ(m_executor->frameBytes(), bytes);
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
