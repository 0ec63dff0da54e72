// Fixtures of statistical: its results, its tables read back from the GPU, and its window sums at every visible pixel.
#pragma once

#include <bit>

#include "ao/method_test.h"
#include "ao/methods/statistical/tables.h"
#include "ao/prepare.h"
#include "gpu/test_shaders.h"
#include "graph/executor.h"

namespace obscura::test {

enum Layering { kOne, kTwo, kFour, kEight, kUniform16, kUniform64 };  // choices of the parameter `layers`
enum TableSize { kFull, kHalf, kQuarter };                            // choices of the parameter `tables`
enum Estimator { kTables, kPoints, kLines };

class StatisticalTest : public MethodTest {
protected:
    StatisticalTest() : MethodTest("statistical") {}
    using MethodTest::run;
    Picture run(const Room& room, const ao::Values& values) { return run(room, values, "quadratic:1"); }
};

using Texel = std::array<uint32_t, 4>;

class TablesTest : public GpuTest {
protected:
    // The tables of a frame, read back to the CPU.
    struct Tables {
        shared::uvec2 size;
        float nearest = 0.0f, furthest = 0.0f, coordinate = 0.0f;  // extent of the frame
        float units = 0.0f;                                        // fixed-point units per metre
        std::vector<Texel> texels;
        std::vector<uint32_t> codes;
        std::vector<Texel> root, levels[3];
        std::vector<std::array<float, 4>> windows;  // for each visible pixel: mean position in its window relative to its own, count
    };

    void SetUp() override {
        GpuTest::SetUp();
        m_shaders.add(ao::shaders());
        ASSERT_EQ(ao::Prepare::create(m_device, m_shaders, m_prepare), ao::Status::ok);
        ASSERT_EQ(ao::StatisticalTables::create(m_device, m_shaders, m_tables), ao::Status::ok);
        program("read.comp",
            "layout(local_size_x = 64) in;\n"
            "layout(binding = 0, std430) readonly buffer From { uint from[]; };\nlayout(binding = 1, std430) writeonly buffer To { uint "
            "to[]; };\n"
            "layout(push_constant) uniform Constants { uint count; };\n"
            "void main() { for (uint i = gl_GlobalInvocationID.x; i < count; i += 64u * gl_NumWorkGroups.x) to[i] = from[i]; }\n",
            {}, m_read);
        program("windows.comp", R"(#extension GL_EXT_control_flow_attributes : require
#include "ao/statistical/fixed_point.h"
#include "ao/statistical/window.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, std140) uniform ViewBlock { View viewBlock; };
layout(binding = 1, r32f) uniform readonly image2D depth;
layout(binding = 2, std430) readonly buffer ExtentBlock { Extent extent; };
layout(binding = 3, std430) readonly buffer Root { uvec4 root[]; };
layout(binding = 4, std430) writeonly buffer Out { vec4 windows[]; };
layout(binding = 5, std430) writeonly buffer Units { float units; };
layout(push_constant) uniform Constants { Box boxBlock; uvec2 size; };
WINDOW_SUMS(sumRoot, root, 1u)
void main() {
    View view = viewBlock;
    Box box = boxBlock;
    uvec2 p = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(p, view.visible))) return;
    vec2 pixel = vec2(p + view.guard) + 0.5;
    float z = imageLoad(depth, ivec2(p + view.guard)).x, reach = halfWindow(view, box, z) / float(box.texelSide);
    vec2 centre = pixel / float(box.texelSide);
    Column c = columnAt(centre, vec2(reach), size, 0u);
    vec4 sum = vec4(sumRoot(0u, c, size, vec3(1, 0, 0)).height.x, sumRoot(0u, c, size, vec3(0, 1, 0)).height.x,
        sumRoot(0u, c, size, vec3(0, 0, 1)).height.x, sumRoot(0u, c, size, vec3(0)).count.x);
    float perMetre = unitsPerMetre(view, box, extent);
    units = perMetre;
    windows[p.y * view.visible.x + p.x] = vec4(sum.xyz / perMetre / sum.w - eyePosition(view, pixel, z), sum.w);
})",
            {{0, 1}}, m_windows);
    }

    // Compiles a shader that may include the project's shaders.
    void program(const std::string& name, const std::string& text, std::initializer_list<gpu::Constant> constants, gpu::Program& out) {
        m_testShaders.add(name, "#version 460\n#extension GL_GOOGLE_include_directive : require\n" + text,
            std::filesystem::path(OBSCURA_SOURCE_DIR) / "shaders");
        ASSERT_EQ(gpu::Program::compute(m_device, m_testShaders.library, name, constants, out), gpu::Status::ok);
    }

    gpu::Buffer back(uint64_t bytes) {
        gpu::Buffer result;
        EXPECT_EQ(gpu::Buffer::create(m_device, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::readback, "back", result),
            gpu::Status::ok);
        return result;
    }

    Tables tables(const Room& room, const shared::Box& box, uint32_t levels = 2) { return tables(room, room.frame(), box, levels); }
    Tables tables(const Room& room, const ao::Frame& frame, const shared::Box& box, uint32_t levels) {
        const gpu::Image depth = room.image(m_device, false), normals = room.image(m_device, true);
        m_device.nextFrame();
        m_graph.begin();
        const auto import = [&](const char* name, const gpu::Image& image) {
            graph::External external{image.handle(), image.view(), image.desc()};
            external.layout = external.layoutAfter = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
            return m_graph.import(name, external);
        };
        ao::Sources sources;
        sources.depth = import("depth", depth);
        sources.normals = import("normals", normals);
        shared::View view;
        const char* reason = "";
        EXPECT_EQ(ao::viewOf(frame, view, reason), ao::Status::ok) << reason;
        const ao::Inputs inputs = m_prepare.add(m_graph, frame, view, sources, {});
        const ao::StatisticalTables::Tables made = m_tables.add(m_graph, inputs, box, levels);

        const auto read = [&](graph::BufferId from, uint64_t bytes) {
            gpu::Buffer to = back(bytes);
            const uint32_t count = uint32_t(bytes / 4);
            m_graph.pass("read", m_read)
                .read(from)
                .write(m_graph.import("back", to, graph::Graph::Shared::written))
                .constants(count)
                .dispatch(64 * 256);
            return to;
        };
        const uint64_t texels = uint64_t(made.size.x) * made.size.y, pixels = uint64_t(view.visible.x) * view.visible.y;
        const gpu::Buffer extent = read(made.extent, 16), texel = read(made.texels, texels * 16),
                          root = read(made.root, ao::SummedArea::bytes(made.size, 1));
        gpu::Buffer code, level[3], windows = back(pixels * 16), units = back(4);
        if (levels > 0) code = read(made.codes, texels * 4);
        for (uint32_t k = 0; k < levels; ++k) level[k] = read(made.levels[k], ao::SummedArea::bytes(made.size, 1u << k));
        const struct {
            shared::Box box;
            shared::uvec2 size;
        } constants{made.box, made.size};
        m_graph.pass("windows", m_windows)
            .read(inputs.viewBlock)
            .read(inputs.depth)
            .read(made.extent)
            .read(made.root)
            .write(m_graph.import("windows", windows, graph::Graph::Shared::written))
            .write(m_graph.import("units", units, graph::Graph::Shared::written))
            .constants(constants)
            .dispatch(view.visible.x, view.visible.y);
        gpu::Status status = gpu::Status::ok;
        EXPECT_EQ(m_device.runNow([&](VkCommandBuffer cmd) { status = m_executor.execute(m_graph, cmd); }), gpu::Status::ok);
        EXPECT_EQ(status, gpu::Status::ok);

        const auto copy = [](const gpu::Buffer& from, auto& to) {
            if (!from) return;
            to.resize(from.bytes() / sizeof(to[0]));
            std::memcpy(to.data(), from.mapped(), from.bytes());
        };
        Tables result;
        result.size = made.size;
        std::vector<uint32_t> bits;
        copy(extent, bits);
        result.nearest = std::bit_cast<float>(~bits[0]);
        result.furthest = std::bit_cast<float>(bits[1]);
        result.coordinate = std::bit_cast<float>(bits[2]);
        std::memcpy(&result.units, units.mapped(), 4);
        copy(texel, result.texels);
        copy(code, result.codes);
        copy(root, result.root);
        for (uint32_t k = 0; k < levels; ++k) copy(level[k], result.levels[k]);
        copy(windows, result.windows);
        return result;
    }

    gpu::Device& m_device = device();
    gpu::ShaderLibrary m_shaders;
    TestShaders m_testShaders;
    graph::Graph m_graph{m_device};
    graph::Executor m_executor{m_device};
    ao::Prepare m_prepare;
    ao::StatisticalTables m_tables;
    gpu::Program m_read, m_windows;
};

}  // namespace obscura::test
