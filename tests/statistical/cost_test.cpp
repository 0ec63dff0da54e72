// What the method's work does and does not depend on, counted: dispatches, workgroups, pipelines, constants, loops in shaders, texels.
// The times that go with it: obscura-bench --scene atrium --method statistical --set radius=0.05,1,4   and   --preset paper,paper_half
#include "gpu/vulkan_counter.h"
#include "statistical/bench.h"

namespace obscura::test {
namespace {

class StatisticalCost : public StatisticalTest {
protected:
    struct Work {
        std::vector<Dispatch> dispatches;
        uint64_t bytes = 0;  // of device memory
    };
    // Of the method's own passes, once its images and buffers are there.
    Work workOf(const Room& room, const ao::Values& values) {
        run(room, values);
        m_counter.clear();
        run(room, values);
        return {m_counter.dispatchesOf("statistical."), m_graph->frameBytes()};
    }
    // Texels that the summed-area tables sum up, over all layers: both halves of a table go once over each.
    static uint64_t texelsSummed(const Work& work) {
        uint64_t sum = 0;
        for (const Dispatch& d : work.dispatches)
            if (d.pass.ends_with(" rows")) sum += uint64_t(d.constant(0)) * d.constant(4) * d.constant(8);  // RowConstants: size, layers
        return sum;
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

    VulkanCounter m_counter{m_device};
};

// Every radius runs the same pipelines in as many workgroups on as much memory. Constants may differ only where the shader has no loop:
// no number of steps can follow from the radius.
TEST_F(StatisticalCost, isTheSameForEveryRadius) {
    const Work middle = workOf(hills(), values({{"radius", 1}}));
    ASSERT_FALSE(middle.dispatches.empty());
    for (const float radius : {0.05f, 0.78f, 4.0f}) {
        SCOPED_TRACE(radius);
        const Work other = workOf(hills(), values({{"radius", radius}}));
        EXPECT_EQ(other.bytes, middle.bytes);
        ASSERT_EQ(other.dispatches.size(), middle.dispatches.size());
        uint32_t differ = 0;
        for (size_t i = 0; i < middle.dispatches.size(); ++i) {
            const Dispatch &a = middle.dispatches[i], &b = other.dispatches[i];
            EXPECT_EQ(a.pass, b.pass);
            EXPECT_EQ(a.pipeline, b.pipeline) << a.pass;
            EXPECT_EQ(a.groups, b.groups) << a.pass;
            if (a.constants == b.constants) continue;
            ++differ;
            // Of texels.comp, the loops over the pixels of a texel: their number is Box::texelSide.
            if (a.pass == "statistical.texels") EXPECT_EQ(a.constant(12), b.constant(12));
            else EXPECT_EQ(a.loops, 0u) << a.pass << " has loops, and other constants at another radius";
        }
        EXPECT_GT(differ, 0u) << "the radius must arrive somewhere";
    }
}

TEST_F(StatisticalCost, goesWithTheTexelsOfTheTables) {
    const Work full = workOf(hills(), values({}, "paper")), half = workOf(hills(), values({}, "paper_half"));
    const Work quarter = workOf(hills(), values({}, "paper_quarter"));
    ASSERT_EQ(full.dispatches.size(), half.dispatches.size());
    ASSERT_EQ(full.dispatches.size(), quarter.dispatches.size());
    const Room room = hills();
    const uint64_t pixels = uint64_t(room.width) * room.height, tables = 1 + 1 + 2;  // root, first, second
    EXPECT_EQ(texelsSummed(full), tables * pixels);
    EXPECT_EQ(texelsSummed(half), tables * pixels / 4);
    EXPECT_EQ(texelsSummed(quarter), tables * pixels / 16);
    uint64_t groups[2] = {};
    for (size_t i = 0; i < full.dispatches.size(); ++i) {
        const Dispatch &a = full.dispatches[i], &b = half.dispatches[i];
        EXPECT_EQ(a.pass, b.pass);
        EXPECT_EQ(a.pipeline, b.pipeline);
        EXPECT_LE(b.workgroups(), a.workgroups()) << a.pass;
        groups[0] += a.workgroups(), groups[1] += b.workgroups();
    }
    EXPECT_LT(groups[1], groups[0]);
    EXPECT_LT(half.bytes, full.bytes);
}

}  // namespace
}  // namespace obscura::test
