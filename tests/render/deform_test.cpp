// The GPU deform pass against scene::deform on the CPU.
#include <algorithm>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "fixture.h"
#include "graph/executor.h"
#include "render/deform.h"

namespace obscura::test {
namespace {

class Deform : public GpuTest {};

std::vector<std::byte> contents(gpu::Device& device, VkBuffer source, uint64_t bytes) {
    gpu::Buffer back;
    EXPECT_EQ(
        gpu::Buffer::create(device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback, "readback", back), gpu::Status::ok);
    const VkBufferCopy region{0, 0, bytes};
    EXPECT_EQ(
        device.runNow([&](VkCommandBuffer cmd) { device.vk().CmdCopyBuffer(cmd, source, back.handle(), 1, &region); }), gpu::Status::ok);
    return {back.mapped(), back.mapped() + bytes};
}

void compareWithCpu(const std::shared_ptr<const scene::Model>& model) {
    gpu::ShaderLibrary shaders;
    shaders.add(render::shaders());
    render::Deform deform;
    ASSERT_EQ(render::Deform::create(device(), shaders, deform), gpu::Status::ok);
    render::ModelGpu gpuModel;
    ASSERT_EQ(render::ModelGpu::create(device(), model, gpuModel), gpu::Status::ok);
    scene::World world;
    world.add(instanceOf(model, {0.5f, 1, 2}));
    world.add(instanceOf(model, {-0.5f, 1, 2}));
    world.instances()[1].timeOffset = 0.21f;

    render::Actors actors;
    graph::Graph graph(device());
    graph::Executor executor(device());
    for (int frame = 0; frame < 3; ++frame) {
        const float time = 0.1f + 0.17f * float(frame);
        actors.update(world, time, false, [&](const scene::Model*) { return &gpuModel; });
        device().nextFrame();
        graph.begin();
        const render::Deform::Posed posed = deform.add(graph, actors);
        gpu::Status status = gpu::Status::ok;
        ASSERT_EQ(device().runNow([&](VkCommandBuffer cmd) { status = executor.execute(graph, cmd); }), gpu::Status::ok);
        ASSERT_EQ(status, gpu::Status::ok) << allLogged();
        const auto positions = contents(device(), posed.buffers.now, uint64_t(actors.posedCapacity()) * render::kPositionBytes);
        const auto frames = contents(device(), posed.buffers.frames, uint64_t(actors.posedCapacity()) * render::kFrameBytes);

        size_t index = 0;
        for (const render::Drawable& drawable : actors.drawables()) {
            ASSERT_NE(drawable.posed, render::kNotPosed);
            const scene::Instance& instance = world.instances()[index++];
            const scene::Pose pose = scene::evaluate(*model, 0, time + instance.timeOffset);
            std::vector<glm::vec3> expected, normals;
            scene::deform(*model, 0, *drawable.primitive->source, pose, expected, &normals);
            const bool skinned = !drawable.primitive->source->joints.empty();
            // Morphed only: the GPU leaves the node's matrix to the vertex shader.
            const glm::mat4 rest = skinned ? glm::mat4(1.0f) : pose.world[0];
            float worst = 0.0f, worstNormal = 0.0f;
            bool moved = false;
            for (size_t v = 0; v < expected.size(); ++v) {
                glm::vec3 p;
                std::memcpy(&p, positions.data() + (drawable.posed + v) * render::kPositionBytes, sizeof(p));
                worst = std::max(worst, glm::length(glm::vec3(rest * glm::vec4(p, 1.0f)) - expected[v]));
                uint64_t packed;
                std::memcpy(&packed, frames.data() + (drawable.posed + v) * render::kFrameBytes, sizeof(packed));
                const glm::vec3 n(glm::unpackSnorm4x16(packed));
                worstNormal = std::max(worstNormal, glm::length(glm::normalize(glm::mat3(rest) * n) - normals[v]));
                moved = moved || glm::length(p - drawable.primitive->source->positions[v]) > 0.05f;
                const scene::Bounds& box = drawable.bounds;
                const glm::vec3 world_ = glm::vec3(instance.placement * glm::vec4(expected[v], 1.0f));
                ASSERT_TRUE(
                    glm::all(glm::greaterThanEqual(world_, box.min - 1e-4f)) && glm::all(glm::lessThanEqual(world_, box.max + 1e-4f)))
                    << "bounds do not contain vertex " << v;
            }
            EXPECT_LT(worst, 1e-5f);
            EXPECT_LT(worstNormal, 3e-4f);  // snorm16
            EXPECT_TRUE(moved);
        }
        EXPECT_EQ(index, 2u);
    }
    deform.forget(gpuModel);
}

TEST_F(Deform, skinningMatchesTheCpu) { compareWithCpu(bendingBar()); }
TEST_F(Deform, morphingMatchesTheCpu) { compareWithCpu(wavingPatch()); }

TEST_F(Deform, unchangedPoseNeedsNoJob) {
    scene::World world;
    const auto model = bendingBar();
    render::ModelGpu gpuModel;
    ASSERT_EQ(render::ModelGpu::create(device(), model, gpuModel), gpu::Status::ok);
    world.add(instanceOf(model));
    render::Actors actors;
    const auto jobs = [&](float time) {
        actors.update(world, time, false, [&](const scene::Model*) { return &gpuModel; });
        return actors.jobs().size();
    };
    EXPECT_EQ(jobs(0.1f), 1u);
    EXPECT_EQ(jobs(0.1f), 1u);  // writes the second of the two buffers
    EXPECT_EQ(jobs(0.1f), 0u);
    EXPECT_EQ(jobs(0.2f), 1u);
}

TEST_F(Deform, rangesAreReused) {
    render::Ranges ranges;
    const uint32_t a = ranges.take(1000), b = ranges.take(500), c = ranges.take(2000);
    const uint32_t capacity = ranges.capacity();
    ranges.give(a, 1000);
    ranges.give(b, 500);
    EXPECT_EQ(ranges.take(1500), a);
    ranges.give(c, 2000);
    EXPECT_EQ(ranges.take(capacity - 1500), 1500u);
    EXPECT_EQ(ranges.capacity(), capacity);
    ranges.take(1);
    EXPECT_GT(ranges.capacity(), capacity);
}

}  // namespace
}  // namespace obscura::test
