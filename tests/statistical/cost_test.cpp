// Work of the method, counted in dispatches, workgroups, pipelines, constants, shader loops and texels: independent of the radius.
// For times see obscura-bench --scene atrium --method statistical --set radius=0.05,1,4   and   --preset paper,paper_half
#include "gpu/vulkan_counter.h"
#include "statistical/fixture.h"

namespace obscura::test {
namespace {

class StatisticalCost : public StatisticalTest {
protected:
    struct Work {
        std::vector<Dispatch> dispatches;
        uint64_t bytes = 0;  // device memory
    };
    // Counts the method's own passes once its resources exist.
    Work workOf(const Room& room, const ao::Values& values) {
        run(room, values);
        m_counter.clear();
        run(room, values);
        return {m_counter.dispatchesOf("statistical."), m_executor->frameBytes()};
    }
    // Texels summed by the summed-area tables, over all layers: both passes of a table read each once.
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

// Every radius runs the same pipelines with the same workgroups and memory. Constants may differ only for shaders without loops, so the
// radius cannot change a number of steps.
TEST_F(StatisticalCost, isTheSameForEveryRadius) {
    const Work middle = workOf(hills(), values({{"radius", 1}, {"largest", 0.5f}}));
    ASSERT_FALSE(middle.dispatches.empty());
    for (const float radius : {0.05f, 0.78f, 4.0f}) {
        SCOPED_TRACE(radius);
        const Work other = workOf(hills(), values({{"radius", radius}, {"largest", 0.5f}}));
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
            // texels.comp loops over the pixels of a texel, Box::texelSide, extent_blocks.comp over a fixed number.
            if (a.pass == "statistical.texels" || a.pass == "statistical.extent blocks") EXPECT_EQ(a.constant(12), b.constant(12));
            else if (a.pass == "statistical.evaluate")  // loops over columns, lines and layers: only the box's width and height may differ
                for (uint32_t offset = 8; offset < 32; offset += 4) EXPECT_EQ(a.constant(offset), b.constant(offset)) << offset;
            else EXPECT_EQ(a.loops, 0u) << a.pass << " has loops, and constants that differ by radius";
        }
        EXPECT_GT(differ, 0u) << "the radius must change some constant";
    }
}

TEST_F(StatisticalCost, scalesWithTheTexelsOfTheTables) {
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
