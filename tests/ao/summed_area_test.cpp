// Summed-area tables against sequential sums on the CPU, at odd and prime sizes.
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <random>

#include "ao/summed_area.h"
#include "gpu/resources.h"
#include "gpu/test_device.h"
#include "gpu/test_shaders.h"
#include "gpu/vulkan_counter.h"
#include "graph/executor.h"

namespace obscura::test {
namespace {

using shared::uvec2;
using Texel = std::array<uint32_t, 4>;
using Layers = std::vector<ao::SummedArea::Layer>;

class SummedAreaTest : public GpuTest, public testing::WithParamInterface<uint32_t> {  // chunks that a line is split into
protected:
    void SetUp() override {
        GpuTest::SetUp();
        m_shaders.add(ao::shaders());
        ASSERT_EQ(ao::SummedArea::create(m_device, m_shaders, m_sums, GetParam()), ao::Status::ok);
    }

    gpu::Buffer buffer(uint64_t bytes, const void* data = nullptr) {
        gpu::Buffer result;
        const VkBufferUsageFlags usage =
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        EXPECT_EQ(gpu::Buffer::create(m_device, bytes, usage, data ? gpu::Memory::device : gpu::Memory::readback, "test", result),
            gpu::Status::ok);
        if (data) {
            EXPECT_EQ(gpu::upload(m_device, result, {static_cast<const std::byte*>(data), bytes}), gpu::Status::ok);
        }
        return result;
    }

    // Compares the table of random texels bit by bit with sums on the CPU.
    void check(uvec2 size, const Layers& layers) {
        std::mt19937 random(size.x * 31 + size.y);
        std::vector<Texel> texels(size_t(size.x) * size.y);
        std::vector<uint32_t> codes(texels.size());
        for (Texel& texel : texels)
            for (uint32_t& channel : texel) channel = random();  // sums overflow often, which must be harmless
        for (uint32_t& code : codes) code = random() % 4;

        const gpu::Buffer from = buffer(texels.size() * 16, texels.data()), by = buffer(codes.size() * 4, codes.data());
        const uint64_t bytes = ao::SummedArea::bytes(size, std::max<size_t>(layers.size(), 1));
        const gpu::Buffer to = buffer(bytes);
        std::memset(to.mapped(), 0xcd, bytes);
        m_device.nextFrame();
        m_graph.begin();
        const graph::BufferId source = m_graph.import("texels", from, graph::Graph::Shared::constant),
                              code = m_graph.import("codes", by, graph::Graph::Shared::constant);
        const graph::BufferId table = m_graph.import("table", to, graph::Graph::Shared::written);
        if (layers.empty()) m_sums.add(m_graph, "sums", source, table, size);
        else m_sums.add(m_graph, "sums", source, code, table, size, layers);
        gpu::Status status = gpu::Status::ok;
        ASSERT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { status = m_executor.execute(m_graph, cmd); }), gpu::Status::ok);
        ASSERT_EQ(status, gpu::Status::ok);

        const Layers wanted = layers.empty() ? Layers{{0, 0}} : layers;
        const auto* got = reinterpret_cast<const Texel*>(to.mapped());
        std::vector<Texel> above((size_t(size.x) + 1) * wanted.size());  // column sums so far
        for (uint32_t y = 0; y <= size.y; ++y) {
            std::vector<Texel> row(wanted.size());
            for (uint32_t x = 0; x <= size.x; ++x)
                for (size_t k = 0; k < wanted.size(); ++k) {
                    Texel& sum = above[x * wanted.size() + k];
                    if (x > 0 && y > 0) {
                        const size_t i = size_t(y - 1) * size.x + x - 1;
                        if ((codes[i] & wanted[k].mask) == wanted[k].value)
                            for (int c = 0; c < 4; ++c) row[k][c] += texels[i][c];
                        for (int c = 0; c < 4; ++c) sum[c] += row[k][c];
                    }
                    ASSERT_EQ(got[(size_t(y) * (size.x + 1) + x) * wanted.size() + k], sum)
                        << size.x << "x" << size.y << " at " << x << "," << y << " layer " << k;
                }
        }
    }

    gpu::Device& m_device = device();
    gpu::ShaderLibrary m_shaders;
    graph::Graph m_graph{m_device};
    graph::Executor m_executor{m_device};
    ao::SummedArea m_sums;
};

INSTANTIATE_TEST_SUITE_P(Parts, SummedAreaTest, testing::Values(1, 5, 16));

TEST_P(SummedAreaTest, entryIsTheSumLeftAndAboveAtAnySize) {
    for (const uvec2 size : {uvec2{1, 1}, {7, 5}, {16, 16}, {17, 129}, {100, 63}, {513, 31}, {250, 251}}) check(size, {});
}
TEST_P(SummedAreaTest, oneRowOrColumnIsSummed) {
    for (const uint32_t length : {1u, 2u, 15u, 1000u, 8192u}) {
        check({length, 1}, {});
        check({1, length}, {});
    }
}
TEST_P(SummedAreaTest, longLinesAreSummed) {
    check({8192, 19}, {});
    check({19, 8192}, {});
}
TEST_P(SummedAreaTest, layersAreIndependent) {
    check({61, 47}, {{3, 3}, {3, 2}});
    check({61, 47}, {{1, 1}});
    check({33, 8}, {{3, 0}, {3, 1}, {3, 2}, {3, 3}});
}

// The work of a table, counted: two dispatches, each of which reads its input once and writes its output once, like a copy of the table.
// For times see passes "statistical.root rows" and "... columns" of obscura-bench --method statistical.
TEST_P(SummedAreaTest, twoDispatchesPassOverTheTable) {
    VulkanCounter counter(m_device);
    const uint32_t lines = 8;  // a workgroup's, of sum_rows.comp and sum_columns.comp
    for (const uvec2 size : {uvec2{640, 360}, uvec2{1152, 648}, uvec2{100, 63}}) {
        counter.clear();
        check(size, {});
        ASSERT_EQ(counter.dispatches.size(), 2u);
        const Dispatch &rows = counter.dispatches[0], &columns = counter.dispatches[1];
        EXPECT_EQ(rows.pass, "sums rows");
        EXPECT_EQ(columns.pass, "sums columns");
        EXPECT_EQ(rows.groups, (std::array<uint32_t, 3>{(size.y + lines - 1) / lines, 1, 1}));
        EXPECT_EQ(columns.groups, (std::array<uint32_t, 3>{(size.x + 1 + lines - 1) / lines, 1, 1}));
    }
}

// Loads and stores of an invocation in shared/scan.glsl, which both passes run, counted in the shader.
TEST_P(SummedAreaTest, lineIsReadAtMostTwiceAndWrittenOnce) {
    TestShaders shaders;
    shaders.add("count.comp", R"(#version 460
#extension GL_GOOGLE_include_directive : require
const uint kScanLines = 8u, kScanMost = 16u;
layout(local_size_x = 8, local_size_y = 16) in;
layout(set = 0, binding = 0, std430) buffer Counts { uint loads, stores; };
layout(push_constant) uniform Constants { uint lines, count; };
uvec4 scanLoad(uint line, uint i) { atomicAdd(loads, 1u); return uvec4(i); }
void scanStore(uint line, uint i, uvec4 sum) { atomicAdd(stores, 1u); }
#include "shared/scan.glsl"
void main() { scanLines(gl_GlobalInvocationID.x, count, gl_GlobalInvocationID.x < lines); }
)",
        std::filesystem::path(OBSCURA_SOURCE_DIR) / "shaders");
    gpu::Program program;
    ASSERT_EQ(gpu::Program::compute(m_device, shaders.library, "count.comp", {{0, GetParam()}}, program), gpu::Status::ok);
    for (const uvec2 size : {uvec2{640, 360}, uvec2{17, 9}, uvec2{1, 1}}) {
        const gpu::Buffer counts = buffer(8);
        std::memset(counts.mapped(), 0, 8);
        m_device.nextFrame();
        m_graph.begin();
        const graph::BufferId target = m_graph.import("counts", counts, graph::Graph::Shared::written);
        m_graph.pass("count", program).write(target).constants(uvec2{size.y, size.x}).dispatch(size.y);
        gpu::Status status = gpu::Status::ok;
        ASSERT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { status = m_executor.execute(m_graph, cmd); }), gpu::Status::ok);
        ASSERT_EQ(status, gpu::Status::ok);
        uint32_t loads[2];  // and stores
        std::memcpy(loads, counts.mapped(), 8);
        EXPECT_EQ(loads[0], (GetParam() > 1 ? 2 : 1) * size.x * size.y);
        EXPECT_EQ(loads[1], size.x * size.y);
    }
}

}  // namespace
}  // namespace obscura::test
