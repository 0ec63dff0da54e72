// The render graph on a device: results across every kind of hazard, errors, histories, memory, timestamps.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>

#include "gpu/record.h"
#include "gpu/test_device.h"
#include "gpu/test_shaders.h"
#include "gpu/vulkan_counter.h"
#include "graph/executor.h"

namespace obscura::graph {
namespace {

using gpu::Status;

const char* const kHead =
    "#version 460\nlayout(local_size_x = 8, local_size_y = 8) in;\nlayout(push_constant) uniform Push { float value; uint loops; };\n";

// Programs of a test: fill (writes a value), add (out = in + value), addTextured (the same through a sampler), work (loops over a buffer).
struct Kit {
    test::TestShaders shaders;
    gpu::Program fill, add, addTextured, work, triangle;

    Kit() {
        const std::string head = kHead;
        shaders.add("fill.comp", head +
                                     "layout(binding = 0, r32f) uniform writeonly image2D target;\n"
                                     "void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), vec4(value)); }\n");
        shaders.add("add.comp",
            head +
                "layout(binding = 0, r32f) uniform readonly image2D source;\nlayout(binding = 1, r32f) uniform writeonly image2D target;\n"
                "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy); imageStore(target, p, imageLoad(source, p) + value); }\n");
        shaders.add("textured.comp",
            head +
                "layout(binding = 0) uniform sampler2D source;\nlayout(binding = 1, r32f) uniform writeonly image2D target;\n"
                "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy); imageStore(target, p, texelFetch(source, p, 0) + value); }\n");
        shaders.add("work.comp", head +
                                     "layout(binding = 0, std430) writeonly buffer Target { float target[]; };\n"
                                     "void main() { float x = value; for (uint i = 0u; i < loops; ++i) x = sin(x * 1.7 + float(i)); "
                                     "target[gl_GlobalInvocationID.y * 256u + gl_GlobalInvocationID.x] = x; }\n");
        shaders.add("full.vert",
            "#version 460\nvoid main() { gl_Position = vec4(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1, 0, 1); }\n");
        shaders.add("flat.frag",
            "#version 460\nlayout(push_constant) uniform Push { float value; uint loops; };\nlayout(location = 0) out float color;\nvoid "
            "main() { color = value; }\n");
        gpu::Device& device = test::device();
        EXPECT_EQ(gpu::Program::compute(device, shaders.library, "fill.comp", {}, fill), Status::ok);
        EXPECT_EQ(gpu::Program::compute(device, shaders.library, "add.comp", {}, add), Status::ok);
        EXPECT_EQ(gpu::Program::compute(device, shaders.library, "textured.comp", {}, addTextured), Status::ok);
        EXPECT_EQ(gpu::Program::compute(device, shaders.library, "work.comp", {}, work), Status::ok);
        gpu::GraphicsState state;
        state.colorFormats = {VK_FORMAT_R32_SFLOAT};
        EXPECT_EQ(gpu::Program::graphics(device, shaders.library, "full.vert", "flat.frag", state, {}, triangle), Status::ok);
    }
};

struct Push {
    float value;
    uint32_t loops;
};

class GraphTest : public test::GpuTest {
protected:
    gpu::Device& m_device = test::device();
    Kit m_kit;
    Graph m_graph{m_device};
    Executor m_executor{m_device};

    void begin() {
        m_device.nextFrame();
        m_graph.begin();
    }
    Status submit() {
        Status status = Status::ok;
        const Status ran = m_device.runNow([&](VkCommandBuffer cmd) { status = m_executor.execute(m_graph, cmd); });
        return status == Status::ok ? ran : status;
    }
    ImageId image(const char* name, uint32_t width = 16, uint32_t mips = 1) {
        return m_graph.image(name, {VK_FORMAT_R32_SFLOAT, width, width, 1, mips});
    }

    // Adds a copy of one texel into a buffer; value() reads it after submit().
    void probe(ImageId id, uint32_t mip = 0) {
        auto& buffer = m_probes.emplace_back();
        ASSERT_EQ(gpu::Buffer::create(m_device, 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback, "probe", buffer), Status::ok);
        const BufferId target = m_graph.import("probe", buffer, Graph::Shared::written);
        m_graph.pass("probe")
            .use(id, Access::transferRead)
            .use(target, Access::transferWrite)
            .record([id, mip, handle = buffer.handle()](const PassContext& c) {
                const VkBufferImageCopy region{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1}, {}, {1, 1, 1}};
                c.device.vk().CmdCopyImageToBuffer(c.cmd, c.image(id), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, handle, 1, &region);
            });
    }
    float value(size_t probe) const {
        float result = 0.0f;
        std::memcpy(&result, m_probes[probe].mapped(), 4);
        return result;
    }

private:
    std::deque<gpu::Buffer> m_probes;
};

TEST_F(GraphTest, hazardsBetweenComputeTexturesAndRenderTargetsAreSynchronized) {
    begin();
    const ImageId a = image("a"), b = image("b"), c = image("c"), d = image("d");
    m_graph.pass("fill", m_kit.fill).write(a).constants(Push{1.0f, 0}).dispatch(16, 16);
    m_graph.pass("add", m_kit.add).read(a).write(b).constants(Push{2.0f, 0}).dispatch(16, 16);
    m_graph.pass("textured", m_kit.addTextured).read(b).write(c).constants(Push{4.0f, 0}).dispatch(16, 16);
    m_graph.pass("draw", m_kit.triangle).color(d, VkClearColorValue{{9.0f}}).constants(Push{0.5f, 0}).record([](const PassContext& c) {
        c.device.vk().CmdDraw(c.cmd, 3, 1, 0, 0);
    });
    const ImageId e = image("e");
    m_graph.pass("after draw", m_kit.add).read(d).write(e).constants(Push{8.0f, 0}).dispatch(16, 16);
    probe(c);
    probe(e);
    ASSERT_EQ(submit(), Status::ok);
    EXPECT_FLOAT_EQ(value(0), 7.0f);
    EXPECT_FLOAT_EQ(value(1), 8.5f);
}

TEST_F(GraphTest, mipsAreSynchronizedSeparately) {
    begin();
    const ImageId a = image("a", 16, 3);
    m_graph.pass("mip0", m_kit.fill).writeMip(a, 0).constants(Push{1.0f, 0}).dispatch(16, 16);
    m_graph.pass("mip1", m_kit.add).readMip(a, 0).writeMip(a, 1).constants(Push{1.0f, 0}).dispatch(8, 8);
    m_graph.pass("mip2", m_kit.add).readMip(a, 1).writeMip(a, 2).constants(Push{1.0f, 0}).dispatch(4, 4);
    probe(a, 2);
    ASSERT_EQ(submit(), Status::ok);
    EXPECT_FLOAT_EQ(value(0), 3.0f);
}

TEST_F(GraphTest, sharedImageIsNotOverwrittenBeforeItsReader) {
    begin();
    ImageId last = image("0");
    m_graph.pass("0", m_kit.fill).write(last).constants(Push{0.0f, 0}).dispatch(16, 16);
    for (int i = 1; i <= 6; ++i) {
        const ImageId next = image(std::to_string(i).c_str());
        m_graph.pass(std::to_string(i), m_kit.add).read(last).write(next).constants(Push{1.0f, 0}).dispatch(16, 16);
        last = next;
    }
    probe(last);
    ASSERT_EQ(submit(), Status::ok);
    EXPECT_FLOAT_EQ(value(0), 6.0f);
    // The last image also has transfer usage, so it is not shared.
    EXPECT_NE(m_executor.plan().text(m_graph.recording()).find("image 0: 0 2 4\nimage 1: 1 3 5\nimage 2: 6\n"), std::string::npos)
        << m_executor.plan().text(m_graph.recording());
}

TEST_F(GraphTest, historyPersistsAndIsZeroAfterInvalidation) {
    History history;
    const auto step = [&] {
        begin();
        const Graph::HistoryPair pair = m_graph.history("count", {VK_FORMAT_R32_SFLOAT, 16, 16}, history);
        m_graph.pass("count", m_kit.add).read(pair.previous).write(pair.current).constants(Push{1.0f, 0}).dispatch(16, 16);
        probe(pair.current);
        EXPECT_EQ(submit(), Status::ok);
        return pair.valid;
    };
    EXPECT_FALSE(step());
    EXPECT_TRUE(step());
    EXPECT_TRUE(step());
    EXPECT_FLOAT_EQ(value(2), 3.0f);
    history.invalidate();
    EXPECT_FALSE(step());
    EXPECT_FLOAT_EQ(value(3), 1.0f);
}

// A frame may be declared only to ask for its memory, and discarded.
TEST_F(GraphTest, declaringPredictsMemoryWithoutSideEffects) {
    History history;
    bool recorded = false;
    const auto declare = [&] {
        const ImageId a = image("a", 64), b = image("b", 32);
        const BufferId scratch = m_graph.buffer("scratch", 256 * 256 * 4);
        m_graph.pass("work", m_kit.work).write(scratch).constants(Push{0.3f, 1}).keep().dispatch(256, 256);
        m_graph.pass("fill", m_kit.fill).write(a).constants(Push{1.0f, 0}).dispatch(64, 64);
        const Graph::HistoryPair pair = m_graph.history("count", {VK_FORMAT_R32_SFLOAT, 16, 16}, history);
        m_graph.pass("count", m_kit.add).read(pair.previous).write(pair.current).constants(Push{1.0f, 0}).dispatch(16, 16);
        m_graph.pass("add", m_kit.add).read(a).write(b).constants(Push{1.0f, 0}).dispatch(32, 32);
        m_graph.output(b);
        m_graph.upload("block", 1.0f);
        m_graph.onRecorded([&] { recorded = true; });
    };
    m_device.waitIdle();  // frees what earlier tests released
    const uint64_t before = m_device.memoryUse();
    begin();
    declare();
    const uint64_t predicted = m_executor.bytes(m_graph);
    EXPECT_GT(predicted, 0u);
    EXPECT_EQ(m_device.memoryUse(), before);
    EXPECT_FALSE(history.valid());
    EXPECT_FALSE(recorded);
    for (uint32_t frame = 0; frame < m_device.framesInFlight() + 1; ++frame) {
        begin();
        declare();
        EXPECT_EQ(m_executor.bytes(m_graph), predicted);
        ASSERT_EQ(submit(), Status::ok);
    }
    EXPECT_TRUE(history.valid());
    EXPECT_TRUE(recorded);
    EXPECT_EQ(m_device.memoryUse() - before, predicted);
}

TEST_F(GraphTest, failedFrameLeavesHistoriesUnchanged) {
    enum Fault { none, contradiction, allocation };  // found while resolving the passes; while making their images
    History history;
    bool recorded = false;
    const auto step = [&](Fault fault, uint32_t size) {
        begin();
        const Graph::HistoryPair pair = m_graph.history("count", {VK_FORMAT_R32_SFLOAT, size, size}, history);
        m_graph.pass("count", m_kit.add).read(pair.previous).write(pair.current).constants(Push{1.0f, 0}).dispatch(size, size);
        recorded = false;
        m_graph.onRecorded([&] { recorded = true; });
        if (fault == contradiction) m_graph.pass("broken", m_kit.add).read(pair.current).keep().dispatch(16, 16);
        if (fault == allocation)
            m_graph.pass("too large", m_kit.fill)
                .write(image("too large", m_device.caps().maxImageSize + 1))
                .constants(Push{})
                .keep()
                .dispatch(16, 16);
        if (fault == none) probe(pair.current);
        EXPECT_EQ(submit() == Status::ok, fault == none);
        EXPECT_EQ(recorded, fault == none);
        return pair.valid;
    };
    step(none, 16);
    step(none, 16);
    for (const Fault fault : {contradiction, allocation}) {
        EXPECT_TRUE(step(fault, 16));
        step(fault, 64);  // nor do images of another size replace the old ones
    }
    EXPECT_TRUE(step(none, 16));
    EXPECT_FLOAT_EQ(value(2), 3.0f);
}

TEST_F(GraphTest, misuseLogsOneLineThatNamesThePass) {
    begin();
    const ImageId a = image("a");
    m_graph.pass("lonely", m_kit.add).read(a).constants(Push{}).dispatch(16, 16);
    EXPECT_EQ(submit(), Status::invalid);
    EXPECT_TRUE(test::loggedContains("pass 'lonely'") && test::loggedContains("target")) << test::allLogged();
    begin();
    const ImageId b = image("b"), c = image("c");
    m_graph.pass("early", m_kit.add).read(b).write(c).constants(Push{}).dispatch(16, 16);
    m_graph.output(c);
    EXPECT_EQ(submit(), Status::invalid);
    EXPECT_TRUE(test::loggedContains("pass 'early' reads 'b' before anything wrote it")) << test::allLogged();
    begin();
    const ImageId d = image("d");
    m_graph.pass("short", m_kit.fill).write(d).dispatch(16, 16);
    EXPECT_EQ(submit(), Status::invalid);
    EXPECT_TRUE(test::loggedContains("wants 8 bytes of constants")) << test::allLogged();
}

// One timestamp before the first pass and one after every pass. On a software rasterizer each is followed by a full barrier: without it the
// time of a compute pass after a render pass reads as nearly zero. The test sets the ticks, which wrap around, and checks the times.
TEST_F(GraphTest, timestampFollowsEveryPassAndGivesItsTime) {
    if (!m_device.caps().timestamps) GTEST_SKIP() << "this device has no timestamps";
    const gpu::Caps& caps = m_device.caps();
    gpu::Buffer buffer;
    ASSERT_EQ(
        gpu::Buffer::create(m_device, 256 * 256 * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Memory::device, "work", buffer), Status::ok);
    test::VulkanCounter counter(m_device);
    counter.ticks = [&](std::span<uint64_t> ticks) {
        for (size_t i = 0; i < ticks.size(); ++i) ticks[i] = (caps.timestampMask - 4500 + 1000 * i * i) & caps.timestampMask;
    };
    uint64_t first = 0;
    for (uint32_t frame = 0; frame <= m_device.framesInFlight(); ++frame) {
        begin();
        if (frame == 0) first = m_device.frame();
        counter.clear();
        const ImageId drawn = image("drawn", 256), unread = image("unread");
        const BufferId target = m_graph.import("one", buffer, Graph::Shared::constant);
        m_graph.pass("draw", m_kit.triangle).color(drawn, VkClearColorValue{}).constants(Push{1.0f, 0}).record([](const PassContext& c) {
            c.device.vk().CmdDraw(c.cmd, 3, 1, 0, 0);
        });
        m_graph.pass("one", m_kit.work).write(target).constants(Push{0.3f, 1}).keep().dispatch(256, 256);
        m_graph.pass("culled", m_kit.fill).write(unread).constants(Push{1.0f, 0}).dispatch(16, 16);
        probe(drawn);
        ASSERT_EQ(submit(), Status::ok);
    }
    std::vector<std::string> wanted{"timestamp"};
    if (caps.software) wanted.push_back("full barrier");
    for (const auto& [pass, work] : {std::pair("draw", "draw"), std::pair("one", "dispatch"), std::pair("probe", "")}) {
        wanted.push_back(std::string("pass ") + pass);
        if (*work) wanted.push_back(work);  // copies are not counted
        wanted.insert(wanted.end(), {"end", "timestamp"});
        if (caps.software) wanted.push_back("full barrier");
    }
    std::erase(counter.events, "barrier");
    EXPECT_EQ(counter.events, wanted);

    const Timings& timings = m_executor.timings();
    EXPECT_EQ(timings.frame, first);
    std::vector<std::string> names;
    for (const gpu::PassTime& pass : timings.passes) names.push_back(pass.name);
    ASSERT_EQ(names, (std::vector<std::string>{"draw", "one", "probe"}));
    const double thousandTicks = 1000.0 * caps.timestampPeriod * 1e-6;  // ms
    for (size_t i = 0; i < timings.passes.size(); ++i)
        EXPECT_NEAR(timings.passes[i].milliseconds, double(2 * i + 1) * thousandTicks, 1e-9) << i;
    EXPECT_NEAR(timings.milliseconds, 9.0 * thousandTicks, 1e-9);

    m_executor.setTiming(false);
    begin();
    counter.clear();
    m_graph.pass("one", m_kit.work)
        .write(m_graph.import("one", buffer, Graph::Shared::constant))
        .constants(Push{0.3f, 1})
        .keep()
        .dispatch(256, 256);
    ASSERT_EQ(submit(), Status::ok);
    std::erase(counter.events, "barrier");
    EXPECT_EQ(counter.events, (std::vector<std::string>{"pass one", "dispatch", "end"}));
}

// A host may record a frame and discard the command buffer. Its queries are then never reset, so reading them would be an error.
TEST_F(GraphTest, timestampsOfUnsubmittedFramesAreNotRead) {
    if (!m_device.caps().timestamps) GTEST_SKIP() << "this device has no timestamps";
    test::VulkanCounter counter(m_device);
    // Frames without passes run first: they must not count as submissions of later frames.
    for (uint32_t frame = 0; frame < m_device.framesInFlight(); ++frame) {
        begin();
        ASSERT_EQ(submit(), Status::ok);
    }
    const auto declare = [&] {
        begin();
        const ImageId a = image("a");
        m_graph.pass("fill", m_kit.fill).write(a).constants(Push{1.0f, 0}).dispatch(16, 16);
        m_graph.output(a);
    };
    for (uint32_t frame = 0; frame < 2 * m_device.framesInFlight() + 1; ++frame) {
        declare();
        test::recordAndDrop(m_device, [&](VkCommandBuffer cmd) { EXPECT_EQ(m_executor.execute(m_graph, cmd), Status::ok); });
    }
    EXPECT_EQ(counter.queryReads, 0u);
    for (uint32_t frame = 0; frame < m_device.framesInFlight() + 1; ++frame) {
        declare();
        ASSERT_EQ(submit(), Status::ok);
    }
    EXPECT_GT(counter.queryReads, 0u);
}

TEST_F(GraphTest, poolReleasesUnusedResources) {
    begin();
    const ImageId a = image("a", 512);
    m_graph.pass("fill", m_kit.fill).write(a).constants(Push{}).dispatch(512, 512);
    m_graph.output(a);
    ASSERT_EQ(submit(), Status::ok);
    const uint64_t before = m_executor.poolBytes();
    EXPECT_GE(before, 512u * 512u * 4u);
    for (int i = 0; i < 40; ++i) {
        begin();
        const ImageId b = image("b", 16);
        m_graph.pass("fill", m_kit.fill).write(b).constants(Push{}).dispatch(16, 16);
        m_graph.output(b);
        ASSERT_EQ(submit(), Status::ok);
    }
    EXPECT_LT(m_executor.poolBytes(), 100u << 10);
}

}  // namespace
}  // namespace obscura::graph
