// Summed-area tables against sums made one after the other, at sizes that divide by nothing.
#include <algorithm>
#include <array>
#include <cstring>
#include <random>

#include "ao/summed_area.h"
#include "gpu/resources.h"
#include "gpu/test_device.h"
#include "gpu/test_shaders.h"

namespace obscura::test {
namespace {

using shared::uvec2;
using Texel = std::array<uint32_t, 4>;
using Layers = std::vector<ao::SummedArea::Layer>;

class SummedAreaTest : public GpuTest, public testing::WithParamInterface<uint32_t> {  // parts a line is cut into
protected:
    void SetUp() override {
        GpuTest::SetUp();
        m_shaders.add(ao::shaders());
        ASSERT_EQ(ao::SummedArea::create(m_device, m_shaders, m_sums, GetParam()), ao::Status::ok);
    }

    gpu::Buffer buffer(uint64_t bytes, const void* data = nullptr) {
        gpu::Buffer result;
        const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        EXPECT_EQ(gpu::Buffer::create(m_device, bytes, usage, data ? gpu::Memory::device : gpu::Memory::readback, "test", result), gpu::Status::ok);
        if (data) { EXPECT_EQ(gpu::upload(m_device, result, {static_cast<const std::byte*>(data), bytes}), gpu::Status::ok); }
        return result;
    }

    // The table of random texels, or nothing where it is not to the bit what it should be.
    void check(uvec2 size, const Layers& layers) {
        std::mt19937 random(size.x * 31 + size.y);
        std::vector<Texel> texels(size_t(size.x) * size.y);
        std::vector<uint32_t> codes(texels.size());
        for (Texel& texel : texels)
            for (uint32_t& channel : texel) channel = random();  // wraps around all the time
        for (uint32_t& code : codes) code = random() % 4;

        const gpu::Buffer from = buffer(texels.size() * 16, texels.data()), by = buffer(codes.size() * 4, codes.data());
        const uint64_t bytes = ao::SummedArea::bytes(size, std::max<size_t>(layers.size(), 1));
        const gpu::Buffer to = buffer(bytes);
        std::memset(to.mapped(), 0xcd, bytes);
        m_device.nextFrame();
        m_graph.begin();
        const graph::BufferId source = m_graph.import("texels", from, graph::Graph::Shared::constant), code = m_graph.import("codes", by, graph::Graph::Shared::constant);
        const graph::BufferId table = m_graph.import("table", to, graph::Graph::Shared::written);
        if (layers.empty()) m_sums.add(m_graph, "sums", source, table, size);
        else m_sums.add(m_graph, "sums", source, code, table, size, layers);
        gpu::Status status = gpu::Status::ok;
        ASSERT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { status = m_graph.execute(cmd); }), gpu::Status::ok);
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
                    ASSERT_EQ(got[(size_t(y) * (size.x + 1) + x) * wanted.size() + k], sum) << size.x << "x" << size.y << " at " << x << "," << y << " layer " << k;
                }
        }
    }

    struct Times { double table = 1e9, byShader = 1e9, byDriver = 1e9; };  // milliseconds, the best of some runs
    // Of a table without layers, and of copies of its bytes.
    Times times(uvec2 size) {
        TestShaders texts;
        texts.add("copy.comp", "#version 460\nlayout(local_size_x = 64) in;\nlayout(binding = 0, std430) readonly buffer From { uvec4 from[]; };\n"
            "layout(binding = 1, std430) writeonly buffer To { uvec4 to[]; };\nlayout(push_constant) uniform Constants { uint count; };\n"
            "void main() { for (uint i = gl_GlobalInvocationID.x; i < count; i += 64u * gl_NumWorkGroups.x) to[i] = from[i]; }\n");
        gpu::Program copy;
        EXPECT_EQ(gpu::Program::compute(m_device, texts.library, "copy.comp", {}, copy), gpu::Status::ok);
        Times best;
        const uint64_t bytes = ao::SummedArea::bytes(size, 1);
        const std::vector<std::byte> zeros(bytes);
        const gpu::Buffer from = buffer(bytes, zeros.data()), to = buffer(bytes, zeros.data()), other = buffer(bytes, zeros.data());
        const uint64_t before = m_device.frame();
        for (int i = 0; i < 24; ++i) {
            m_device.nextFrame();
            m_graph.begin();
            const auto import = [&](const gpu::Buffer& b) { return m_graph.import("test", b, graph::Graph::Shared::written); };
            const graph::BufferId table = import(to), target = import(other);
            m_sums.add(m_graph, "sums", import(from), table, size);
            m_graph.pass("shader", copy).read(table).write(target).constants(uint32_t(bytes / 16)).dispatch(64 * 1024);
            m_graph.pass("driver").use(table, graph::Access::transferRead).use(target, graph::Access::transferWrite).record([&](const graph::PassContext& c) {
                const VkBufferCopy region{0, 0, bytes};
                c.device.vk().CmdCopyBuffer(c.cmd, to.handle(), other.handle(), 1, &region);
            });
            EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { EXPECT_EQ(m_graph.execute(cmd), gpu::Status::ok); }), gpu::Status::ok);
            if (m_graph.timings().frame <= before) continue;  // of what was measured before
            double sums = 0.0;
            for (const graph::PassTime& pass : m_graph.timings().passes) {
                if (pass.name == "shader") best.byShader = std::min(best.byShader, pass.milliseconds);
                if (pass.name == "driver") best.byDriver = std::min(best.byDriver, pass.milliseconds);
                if (pass.name.starts_with("sums")) sums += pass.milliseconds;
            }
            best.table = std::min(best.table, sums);
        }
        m_device.waitIdle();
        return best;
    }

    gpu::Device& m_device = device();
    gpu::ShaderLibrary m_shaders;
    graph::Graph m_graph{m_device};
    ao::SummedArea m_sums;
};

INSTANTIATE_TEST_SUITE_P(Parts, SummedAreaTest, testing::Values(1, 5, 16));

TEST_P(SummedAreaTest, isTheSumOfWhatIsLeftAndAboveAtAnySize) {
    for (const uvec2 size : {uvec2{1, 1}, {7, 5}, {16, 16}, {17, 129}, {100, 63}, {513, 31}, {250, 251}}) check(size, {});
}
TEST_P(SummedAreaTest, ofOneRowAndOfOneColumn) {
    for (const uint32_t length : {1u, 2u, 15u, 1000u, 8192u}) {
        check({length, 1}, {});
        check({1, length}, {});
    }
}
TEST_P(SummedAreaTest, ofVeryLongLines) {
    check({8192, 19}, {});
    check({19, 8192}, {});
}
TEST_P(SummedAreaTest, layersSumTheirOwnTexels) {
    check({61, 47}, {{3, 3}, {3, 2}});
    check({61, 47}, {{1, 1}});
    check({33, 8}, {{3, 0}, {3, 1}, {3, 2}, {3, 3}});
}
using SummedAreaSpeed = SummedAreaTest;
INSTANTIATE_TEST_SUITE_P(Parts, SummedAreaSpeed, testing::Values(0));

TEST_P(SummedAreaSpeed, isThatOfAFewCopies) {
    for (const uvec2 size : {uvec2{640, 360}, uvec2{1152, 648}, uvec2{2304, 1296}}) {
        const Times t = times(size);
        printf("%ux%u: table %.2f ms, %.1f copies by a shader, %.1f by the driver\n", size.x, size.y, t.table, t.table / t.byShader, t.table / t.byDriver);
        EXPECT_LT(t.table, 6.0 * t.byShader) << "two passes that read and write once should be two copies, and clocks are rough";
    }
}

}  // namespace
}  // namespace obscura::test
