// Fixed push constants; extrapolated costs agree with those of unrolled code.
#include <array>
#include <cstring>

#include "ao/gtao/constants.h"
#include "ao/hbao/constants.h"
#include "ao/layered/constants.h"
#include "ao/method.h"
#include "gpu/test_device.h"
#include "gpu/test_shaders.h"
#include "gpu_cost/cost.h"
#include "gpu_cost/fixed_constants.h"
#include "graph/executor.h"

namespace obscura::gpu_cost {
namespace {

// Every kind of member, and a loop. The first result depends on integers alone, the second on floats alone.
constexpr const char* kShader = R"(#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) writeonly buffer Sums { float counted, weighed; };
struct Inner { vec2 a; uint count; };
layout(push_constant) uniform Block { Inner inner; vec4 rows[2]; ivec2 pair; int last; } c;
void main() {
    float s = float(c.last) + float(c.pair.y);
    for (uint i = 0u; i < c.inner.count; ++i) s += float(i * i);
    counted = s;
    weighed = c.inner.a.x + 2.0 * c.inner.a.y + c.rows[1].z;
}
)";
struct Values {
    float a[2];
    uint32_t count, unused;
    float rows[2][4];
    int32_t pair[2], last;
};

TEST(FixedConstants, fixIntegersAndLeaveFloats) {
    std::string error;
    gpu::DeviceOptions options;
    options.name = test::device().caps().deviceName;
    const std::unique_ptr<gpu::Device> device = gpu::Device::create(options, error);  // without validation: see fixed_constants.h
    ASSERT_TRUE(device) << error;
    const Values values{{1.5f, -2}, 5, 0, {{1, 2, 3, 4}, {5, 6, 7, 8}}, {9, 10}, -3},
        others{{0.25f, 1}, 99, 0, {{}, {0, 0, 3, 0}}, {98, 97}, 96};
    test::TestShaders shaders;
    shaders.add("sum.comp", kShader);
    gpu::Shader fixed = *shaders.library.find("sum.comp");
    fixed.spirv = withFixedConstants(fixed.spirv, std::as_bytes(std::span(&values, 1)), true);
    const std::string reflection = describe(fixed);
    const gpu::EmbeddedShader embedded{"fixed.comp", fixed.spirv, reflection.c_str()};
    shaders.library.add({&embedded, 1});
    graph::Executor executor(*device);
    const auto run = [&](const char* name, const Values& pushed) {
        gpu::Program program;
        EXPECT_EQ(gpu::Program::compute(*device, shaders.library, name, {}, program), gpu::Status::ok);
        gpu::Buffer sums;
        EXPECT_EQ(
            gpu::Buffer::create(*device, 8, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::readback, "sums", sums), gpu::Status::ok);
        graph::Graph graph(*device);
        device->nextFrame();
        graph.begin();
        graph.pass("sum", program).write(graph.import("sums", sums, graph::Graph::Shared::written)).constants(pushed).dispatch(1);
        EXPECT_EQ(device->runNow([&](VkCommandBuffer cmd) { EXPECT_EQ(executor.execute(graph, cmd), gpu::Status::ok); }), gpu::Status::ok);
        std::array<float, 2> result;
        std::memcpy(result.data(), sums.mapped(), 8);
        return result;
    };
    const float counted = -3 + 10 + 0 + 1 + 4 + 9 + 16, weighed = 0.25f + 2 + 3;
    EXPECT_EQ(run("sum.comp", values)[0], counted);
    EXPECT_NE(run("sum.comp", others)[0], counted);
    EXPECT_EQ(run("fixed.comp", others)[0], counted) << "integers are those of the fixed constants";
    EXPECT_EQ(run("fixed.comp", others)[1], weighed) << "floats are those that were pushed";
}

TEST(Cost, extrapolatedCyclesAgreeWithUnrolledOnes) {
    std::string error;
    const Chip& chip = *findChip("navi21");
    const std::unique_ptr<gpu::Device> compiler = compilerOf(chip, error);
    if (!compiler) GTEST_SKIP() << error;
    gpu::ShaderLibrary shaders;
    shaders.add(ao::shaders());
    ao::Falloff falloff;
    ASSERT_TRUE(ao::parseFalloff("quadratic:2", falloff));
    const shared::FalloffBlock rho = ao::falloffBlock(falloff);
    const gpu::Constant quadratic = ao::falloffConstant(falloff.kind);
    const auto costOf = [&](const char* shader, std::vector<gpu::Constant> specialization, const auto& constants, uint32_t mostSamples) {
        const auto bytes = std::as_bytes(std::span(&constants, 1));
        CostModel model(*compiler, chip, shaders, mostSamples);
        return model.costOf({64, 1, {{"pass", shader, std::move(specialization), {bytes.begin(), bytes.end()}, 64, 0}}});
    };
    const auto check = [&](const char* shader, const std::vector<gpu::Constant>& specialization, const auto& constants) {
        const MethodCost unrolled = costOf(shader, specialization, constants, 100000),
                         fitted = costOf(shader, specialization, constants, 4);
        ASSERT_FALSE(unrolled.passes[0].fitted || unrolled.passes[0].loops) << shader;
        ASSERT_TRUE(fitted.passes[0].fitted) << shader;
        EXPECT_NEAR(fitted.cycles, unrolled.cycles, 0.02 * unrolled.cycles) << shader;
        EXPECT_NEAR(fitted.fetches, unrolled.fetches, 0.02 * unrolled.fetches + 1) << shader;
        std::printf("  %s: %.0f cycles unrolled, %.0f extrapolated\n", shader, unrolled.cycles, fitted.cycles);
    };
    check("ao/gtao/horizons.comp", {{0, 0}, quadratic}, shared::GtaoHorizons{rho, 9, 3, 3.3f, 2.2f, 0.03f, 0});
    check("ao/layered/segments.comp", {quadratic}, shared::LayeredSegments{{64, 1}, rho, 2, 6, 4096, 1, 1, 0.25f, 0});
    check("ao/hbao/horizons.comp", {quadratic}, shared::HbaoHorizons{rho, 16, 8, 0.17f, 4096, 0, 0, 0, 1});
}

}  // namespace
}  // namespace obscura::gpu_cost
