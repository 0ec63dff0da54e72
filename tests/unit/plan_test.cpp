// The render graph's plan, compared as text: the barriers of each hazard, slots, culling, memory.
#include <gtest/gtest.h>

#include "graph/plan.h"

namespace obscura::graph {
namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 kFragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;

// Builds a recording.
struct Sketch {
    Recording recording;

    uint32_t image(const char* name, uint32_t mips = 1, VkFormat format = VK_FORMAT_R32_SFLOAT) {
        return add({.name = name, .desc = {format, 64, 64, 1, mips, 0}});
    }
    uint32_t imported(const char* name, State state, bool output = false) {
        return add({.name = name,
            .origin = Origin::imported,
            .desc = {VK_FORMAT_R32_SFLOAT, 64, 64, 1, 1, 0},
            .initial = {state},
            .output = output});
    }
    uint32_t history(const char* name, const State& state, bool output) {
        const uint32_t index = imported(name, state, output);
        recording.resources[index].origin = Origin::history;
        return index;
    }
    // Imported.
    uint32_t buffer(const char* name, State state = {}) {
        return add({.name = name, .origin = Origin::imported, .isBuffer = true, .bytes = 64, .initial = {state}});
    }
    uint32_t scratch(const char* name, uint64_t bytes) { return add({.name = name, .isBuffer = true, .bytes = bytes}); }
    uint32_t upload(const char* name, uint64_t bytes) {
        return add({.name = name, .origin = Origin::upload, .isBuffer = true, .bytes = bytes});
    }
    uint32_t add(Resource resource) {
        recording.resources.push_back(std::move(resource));
        return uint32_t(recording.resources.size() - 1);
    }
    void pass(const char* name, std::vector<Use> uses, bool keep = false) { recording.passes.push_back({name, std::move(uses), keep}); }
    std::string text(const std::vector<Slot>& slots = {}) const { return plan(recording, slots).text(recording); }
};

Use write(uint32_t r, uint32_t mip = 0) { return {r, mip, 1, Access::storageWrite, kCompute}; }
Use read(uint32_t r, uint32_t mip = 0) { return {r, mip, 1, Access::storageRead, kCompute}; }
Use sample(uint32_t r, VkPipelineStageFlags2 stages = kCompute) { return {r, 0, 1, Access::sampled, stages}; }

TEST(Plan, readAfterWriteWaitsOnTheWriteOnce) {
    Sketch s;
    const uint32_t a = s.image("a");
    s.pass("make", {write(a)});
    s.pass("first", {read(a)}, true);
    s.pass("second", {read(a)}, true);
    EXPECT_EQ(s.text(),
        "make\n  a: -(-) > compute(write) undefined>general\n"
        "first\n  a: compute(write) > compute(read)\n"
        "second\n"
        "image 0: a\n");
}

TEST(Plan, readInAnotherStageNeedsItsOwnVisibility) {
    Sketch s;
    const uint32_t a = s.buffer("a");
    s.pass("make", {write(a)});
    s.pass("compute", {read(a)}, true);
    s.pass("fragment", {{a, 0, 1, Access::storageRead, kFragment}}, true);
    EXPECT_EQ(s.text(),
        "make\n"
        "compute\n  a: compute(write) > compute(read)\n"
        "fragment\n  a: compute(write) > fragment(read)\n");
}

TEST(Plan, layoutChangeIsAWriteVisibleToItsReader) {
    Sketch s;
    const uint32_t a = s.image("a");
    s.pass("draw", {{a, 0, 1, Access::color, 0, true}});
    s.pass("light", {sample(a)}, true);
    s.pass("again", {sample(a)}, true);
    s.pass("tone", {sample(a, kFragment)}, true);
    EXPECT_EQ(s.text(),
        "draw\n  a: -(-) > color(blend+draw) undefined>color\n"
        "light\n  a: color(blend+draw) > compute(sample) color>sampled\n"
        "again\n"
        "tone\n  a: compute(-) > fragment(sample)\n"
        "image 0: a\n");
}

TEST(Plan, writeAfterReadWaitsOnEveryReader) {
    Sketch s;
    const uint32_t a = s.buffer("a");
    s.pass("first", {read(a)}, true);
    s.pass("second", {{a, 0, 1, Access::storageRead, kFragment}}, true);
    s.pass("overwrite", {write(a)}, true);
    EXPECT_EQ(s.text(), "first\nsecond\noverwrite\n  a: compute+fragment(-) > compute(write)\n");
}

TEST(Plan, writeAfterWriteIsOrderedAndFlushed) {
    Sketch s;
    const uint32_t a = s.buffer("a");
    s.pass("first", {write(a)}, true);
    s.pass("second", {write(a)}, true);
    EXPECT_EQ(s.text(), "first\nsecond\n  a: compute(write) > compute(write)\n");
}

TEST(Plan, readAfterReadNeedsNoBarrier) {
    Sketch s;
    const uint32_t a = s.imported("a", {VK_IMAGE_LAYOUT_GENERAL});
    s.pass("first", {read(a)}, true);
    s.pass("second", {read(a)}, true);
    EXPECT_EQ(s.text(), "first\nsecond\n");
}

TEST(Plan, mipChainKeepsEachMipsState) {
    Sketch s;
    const uint32_t a = s.image("a", 3);
    s.pass("mip0", {write(a, 0)});
    s.pass("mip1", {read(a, 0), write(a, 1)});
    s.pass("mip2", {read(a, 1), write(a, 2)});
    s.pass("use", {{a, 0, 3, Access::sampled, kCompute}}, true);
    EXPECT_EQ(s.text(),
        "mip0\n  a[0]: -(-) > compute(write) undefined>general\n"
        "mip1\n  a[0]: compute(write) > compute(read)\n  a[1]: -(-) > compute(write) undefined>general\n"
        "mip2\n  a[1]: compute(write) > compute(read)\n  a[2]: -(-) > compute(write) undefined>general\n"
        "use\n  a[0-2]: compute(write) > compute(sample) general>sampled\n"
        "image 0: a\n");
}

TEST(Plan, transientsOfEqualDescriptionAndDisjointLifetimesShareAnImage) {
    Sketch s;
    const uint32_t a = s.image("a"), b = s.image("b"), c = s.image("c"), d = s.image("d", 1, VK_FORMAT_R8_UNORM);
    s.pass("a", {write(a)});
    s.pass("b", {read(a), write(b)});
    s.pass("c", {read(b), write(c)});
    s.pass("d", {read(c), write(d)}, true);
    EXPECT_EQ(s.text(),
        "a\n  a: -(-) > compute(write) undefined>general\n"
        "b\n  a: compute(write) > compute(read)\n  b: -(-) > compute(write) undefined>general\n"
        "c\n  b: compute(write) > compute(read)\n  c: compute(write) > compute(write) undefined>general\n"
        "d\n  c: compute(write) > compute(read)\n  d: -(-) > compute(write) undefined>general\n"
        "image 0: a c\nimage 1: b\nimage 2: d\n");
}

TEST(Plan, nextFrameWaitsForReadersOfThePrevious) {
    Sketch s;
    const uint32_t a = s.image("a");
    s.pass("make", {write(a)});
    s.pass("use", {sample(a, kFragment)}, true);
    const Plan first = plan(s.recording);
    EXPECT_EQ(s.text(first.slots),
        "make\n  a: fragment(-) > compute(write) undefined>general\n"
        "use\n  a: compute(write) > fragment(sample) general>sampled\n"
        "image 0: a\n");
}

TEST(Plan, historyKeepsItsStateBetweenFrames) {
    Sketch s;
    State left;
    left.layout = VK_IMAGE_LAYOUT_GENERAL;
    left.writeStages = kCompute;
    left.writeAccess = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    const uint32_t previous = s.history("history.previous", left, false);
    const uint32_t current = s.history("history", {VK_IMAGE_LAYOUT_GENERAL, kCompute, 0, kCompute, {}}, true);
    s.pass("blend", {sample(previous), write(current)});
    const Plan result = plan(s.recording);
    EXPECT_EQ(result.text(s.recording),
        "blend\n  history.previous: compute(write) > compute(sample) general>sampled\n"
        "  history: compute(-) > compute(write)\n");
    EXPECT_EQ(result.finalStates[current][0].writeStages, kCompute);
    EXPECT_EQ(result.finalStates[previous][0].layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

TEST(Plan, unreadPassesAreCulled) {
    Sketch s;
    const uint32_t a = s.image("a"), b = s.image("b");
    const uint32_t out = s.imported("out", {}, true);
    s.pass("used", {write(a)});
    s.pass("unused", {read(a), write(b)});
    s.pass("final", {read(a), write(out)});
    EXPECT_EQ(s.text(),
        "used\n  a: -(-) > compute(write) undefined>general\n"
        "final\n  a: compute(write) > compute(read)\n  out: -(-) > compute(write) undefined>general\n"
        "culled unused\nimage 0: a\n");
}

TEST(Plan, hostImagesReturnToTheirLayout) {
    Sketch s;
    State given{VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, 0, {}};
    const uint32_t a = s.imported("depth", given);
    s.recording.resources[a].finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
    s.pass("read", {sample(a)}, true);
    EXPECT_EQ(s.text(),
        "read\n  depth: all(anyWrite) > compute(sample) other>sampled\n"
        "end\n  depth: compute(-) > all(anyRead+anyWrite) sampled>other\n");
}

TEST(Plan, readingAnUnwrittenImageIsAProblem) {
    Sketch s;
    const uint32_t a = s.image("a");
    s.pass("use", {read(a)}, true);
    const Plan result = plan(s.recording);
    ASSERT_EQ(result.problems.size(), 1u);
    EXPECT_EQ(result.problems[0], "pass 'use' reads 'a' before anything wrote it");
}

TEST(Plan, transientBuffersOfEqualSizeAndDisjointLifetimesShareABuffer) {
    Sketch s;
    const uint32_t a = s.scratch("a", 256), b = s.scratch("b", 256), c = s.scratch("c", 256), d = s.scratch("d", 512);
    s.pass("a", {write(a)});
    s.pass("b", {read(a), write(b)});
    s.pass("c", {read(b), write(c)});
    s.pass("d", {read(c), write(d)}, true);
    EXPECT_EQ(s.text(),
        "a\n"
        "b\n  a: compute(write) > compute(read)\n"
        "c\n  b: compute(write) > compute(read)\n  c: compute(write) > compute(write)\n"
        "d\n  c: compute(write) > compute(read)\n"
        "buffer 0: a c\nbuffer 1: b\nbuffer 2: d\n");
}

TEST(Plan, slotsOfAnEarlierFrameAreReused) {
    Sketch s;
    const uint32_t a = s.image("a"), b = s.scratch("b", 256);
    s.pass("a", {write(a)});
    s.pass("b", {read(a), write(b)}, true);
    const Plan first = plan(s.recording);
    const Plan second = plan(s.recording, first.slots);
    EXPECT_EQ(second.slots.size(), 2u);
    EXPECT_EQ(second.slotOf, first.slotOf);
}

TEST(Plan, readingAnUnwrittenBufferIsAProblem) {
    Sketch s;
    const uint32_t a = s.scratch("a", 256);
    s.pass("use", {read(a)}, true);
    EXPECT_EQ(plan(s.recording).problems, std::vector<std::string>{"pass 'use' reads 'a' before anything wrote it"});
}

TEST(Plan, uploadsAreAlignedAndPackedIntoChunks) {
    Sketch s;
    const uint32_t a = s.upload("a", 4), b = s.upload("b", 300), large = s.upload("large", 1 << 20), c = s.upload("c", 256);
    const Plan result = plan(s.recording);
    EXPECT_EQ(result.chunks, (std::vector<uint64_t>{256 << 10, 1 << 20}));
    const auto at = [&](uint32_t i) { return std::pair(result.placements[i].chunk, result.placements[i].offset); };
    EXPECT_EQ(at(a), std::pair(0u, uint64_t(0)));
    EXPECT_EQ(at(b), std::pair(0u, uint64_t(256)));
    EXPECT_EQ(at(large), std::pair(1u, uint64_t(0)));
    EXPECT_EQ(at(c), std::pair(0u, uint64_t(768)));
    // Existing upload chunks are reused.
    EXPECT_EQ(plan(s.recording, {}, result.chunks).chunks, result.chunks);
}

TEST(Plan, memoryCountsPoolHistoriesAndUploadsOfEveryFrame) {
    Sketch s;
    const uint32_t a = s.image("a"), b = s.image("b"), c = s.image("c"), unused = s.image("unused"), table = s.scratch("table", 1000);
    const uint32_t previous = s.history("history.previous", {}, false), current = s.history("history", {}, true);
    const uint32_t block = s.upload("block", 16);
    s.pass("a", {write(a), read(block), write(table)});
    s.pass("b", {read(a), write(b), read(table)});
    s.pass("c", {read(b), write(c)});
    s.pass("culled", {read(c), write(unused)});
    s.pass("blend", {read(c), sample(previous), write(current)});
    const Plan result = plan(s.recording);
    EXPECT_TRUE(result.problems.empty());
    const MemoryOf memory{[](const gpu::ImageDesc& desc) { return uint64_t(desc.width) * desc.height * 4; },
        [](uint64_t size, VkBufferUsageFlags, gpu::Memory) { return size; }};
    const uint64_t image = 64 * 64 * 4;
    EXPECT_EQ(bytes(s.recording, result, 3, memory), 2 * image + 1000 + 2 * image + 3 * (256 << 10));  // c shares the slot of a
    EXPECT_EQ(result.text(s.recording).find("unused"), std::string::npos);
}

TEST(Plan, planIsDeterministic) {
    Sketch s;
    const uint32_t a = s.image("a"), b = s.image("b");
    s.pass("a", {write(a)});
    s.pass("b", {read(a), write(b)}, true);
    EXPECT_EQ(s.text(), s.text());
    EXPECT_NE(plan(s.recording).dot(s.recording).find('a'), std::string::npos);
}

}  // namespace
}  // namespace obscura::graph
