// gpu::Program: compute and graphics pipelines, specialization, hot reload, error lines.
#include <bit>
#include <cstring>

#include "gpu/program.h"
#include "gpu/resources.h"
#include "gpu/test_device.h"
#include "gpu/test_shaders.h"

using namespace obscura;
using namespace obscura::gpu;

namespace {

class ProgramTest : public test::GpuTest {};

std::string scaleShader(const std::string& expression) {
    return "#version 460\n"
           "layout(local_size_x = 64) in;\n"
           "layout(constant_id = 3) const float kScale = 1.0;\n"
           "layout(std430, binding = 0) readonly buffer In { float values[]; } source;\n"
           "layout(std430, binding = 1) writeonly buffer Out { float values[]; } target;\n"
           "layout(push_constant) uniform Push { uint count; float offset; };\n"
           "void main() {\n"
           "    uint i = gl_GlobalInvocationID.x;\n"
           "    if (i < count) target.values[i] = " +
           expression +
           ";\n"
           "}\n";
}

// Runs a program with the interface above on the input 0, 1, 2, ...
std::vector<float> run(const Program& program, float offset = 0.0f) {
    constexpr uint32_t kCount = 100;
    Device& device = test::device();
    const Api& vk = device.vk();
    Buffer in, out;
    EXPECT_EQ(Buffer::create(device, kCount * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::upload, "in", in), Status::ok);
    EXPECT_EQ(Buffer::create(device, kCount * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::readback, "out", out), Status::ok);
    for (uint32_t i = 0; i < kCount; ++i) reinterpret_cast<float*>(in.mapped())[i] = float(i);

    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    EXPECT_EQ(vk.CreateDescriptorPool(device.handle(), &poolInfo, nullptr, &pool), VK_SUCCESS);
    const VkDescriptorSetLayout layout = program.setLayout(0);
    VkDescriptorSetAllocateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool, 1, &layout};
    VkDescriptorSet set = VK_NULL_HANDLE;
    EXPECT_EQ(vk.AllocateDescriptorSets(device.handle(), &setInfo, &set), VK_SUCCESS);
    const VkDescriptorBufferInfo buffers[2] = {{in.handle(), 0, VK_WHOLE_SIZE}, {out.handle(), 0, VK_WHOLE_SIZE}};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set;
    write.descriptorCount = 2;  // continues into binding 1
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = buffers;
    vk.UpdateDescriptorSets(device.handle(), 1, &write, 0, nullptr);

    EXPECT_EQ(device.runNow([&](VkCommandBuffer cmd) {
        vk.CmdBindPipeline(cmd, program.bindPoint(), program.pipeline());
        vk.CmdBindDescriptorSets(cmd, program.bindPoint(), program.layout(), 0, 1, &set, 0, nullptr);
        const struct {
            uint32_t count;
            float offset;
        } push{kCount, offset};
        vk.CmdPushConstants(cmd, program.layout(), program.stages(), 0, sizeof(push), &push);
        vk.CmdDispatch(cmd, (kCount + program.workgroup()[0] - 1) / program.workgroup()[0], 1, 1);
        const VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
        VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        info.memoryBarrierCount = 1;
        info.pMemoryBarriers = &memory;
        vk.CmdPipelineBarrier2(cmd, &info);
    }),
        Status::ok);
    device.release(VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool);
    const float* values = reinterpret_cast<const float*>(out.mapped());
    return {values, values + kCount};
}

TEST_F(ProgramTest, ComputesWithSpecializationAndPushConstants) {
    test::TestShaders shaders;
    shaders.add("scale.comp", scaleShader("source.values[i] * kScale + offset"));
    Program program;
    ASSERT_EQ(Program::compute(test::device(), shaders.library, "scale.comp", {{3, std::bit_cast<uint32_t>(2.5f)}, {99, 1}}, program),
        Status::ok);
    EXPECT_EQ(program.workgroup(), (std::array<uint32_t, 3>{64, 1, 1}));
    EXPECT_EQ(program.pushConstantBytes(), 8u);
    EXPECT_EQ(program.stages(), VkShaderStageFlags(VK_SHADER_STAGE_COMPUTE_BIT));
    ASSERT_EQ(program.bindings().size(), 2u);
    EXPECT_TRUE(program.bindings()[0].reads && !program.bindings()[0].writes);
    EXPECT_TRUE(!program.bindings()[1].reads && program.bindings()[1].writes);
    const std::vector<float> result = run(program, 1.0f);
    for (size_t i = 0; i < result.size(); ++i) ASSERT_EQ(result[i], float(i) * 2.5f + 1.0f);
}

TEST_F(ProgramTest, HotReloadIgnoresBrokenShaders) {
    test::TestShaders shaders;
    shaders.write("part.glsl", "float change(float x) { return x + 1.0; }\n");
    const std::string text = scaleShader("change(source.values[i])");
    shaders.add("scale.comp", "#version 460\n#include \"part.glsl\"\n" + text.substr(text.find('\n') + 1));
    shaders.library.watch(shaders.root(), compileShader);
    Program program;
    ASSERT_EQ(Program::compute(test::device(), shaders.library, "scale.comp", {}, program), Status::ok);
    EXPECT_EQ(run(program)[10], 11.0f);
    EXPECT_FALSE(shaders.library.poll()) << "nothing was edited";
    const VkPipeline first = program.pipeline();
    program.refresh();
    EXPECT_EQ(program.pipeline(), first);

    shaders.write("part.glsl", "float change(float x) { return x + 2.0; }\n");
    EXPECT_TRUE(shaders.library.poll()) << "an edited include";
    program.refresh();
    EXPECT_NE(program.pipeline(), first);
    EXPECT_EQ(run(program)[10], 12.0f);

    shaders.write("part.glsl", "float change(float x) { return y; }\n");
    EXPECT_FALSE(shaders.library.poll());
    ASSERT_EQ(shaders.library.errors().size(), 1u);
    EXPECT_NE(shaders.library.errors()[0].find("shaders/part.glsl:1: 'y'"), std::string::npos) << shaders.library.errors()[0];
    EXPECT_FALSE(shaders.library.poll()) << "one attempt per edit";
    program.refresh();
    EXPECT_EQ(run(program)[10], 12.0f);

    shaders.write("part.glsl", "float change(float x) { return x * 3.0; }\n");
    EXPECT_TRUE(shaders.library.poll());
    EXPECT_TRUE(shaders.library.errors().empty());
    program.refresh();
    EXPECT_EQ(run(program)[10], 30.0f);
}

TEST_F(ProgramTest, FailedPipelineCreationKeepsTheLastPipeline) {
    test::TestShaders shaders;
    shaders.add("scale.comp", scaleShader("source.values[i]"));
    shaders.library.watch(shaders.root(), compileShader);
    Program program;
    ASSERT_EQ(Program::compute(test::device(), shaders.library, "scale.comp", {}, program), Status::ok);
    const VkPipeline first = program.pipeline();
    std::string tooMuch = scaleShader("source.values[i]");
    tooMuch.replace(tooMuch.find("float offset;"), 13, "float offset; vec4 more[9];");
    shaders.write("scale.comp", tooMuch);
    EXPECT_TRUE(shaders.library.poll());
    program.refresh();
    EXPECT_EQ(program.pipeline(), first);
    EXPECT_EQ(program.pushConstantBytes(), 8u);
    EXPECT_TRUE(test::loggedContains("program 'scale.comp': 160 bytes of push constants")) << test::allLogged();
    const size_t lines = test::logged().size();
    program.refresh();
    EXPECT_EQ(test::logged().size(), lines) << "logged once";
    EXPECT_EQ(run(program)[10], 10.0f);
}

TEST_F(ProgramTest, MissingOrInvalidShadersAreNamed) {
    test::TestShaders shaders;
    shaders.add("scale.comp", scaleShader("0.0"));
    Program program;
    EXPECT_EQ(Program::compute(test::device(), shaders.library, "none.comp", {}, program), Status::shaderError);
    EXPECT_TRUE(test::loggedContains("'none.comp'"));
    EXPECT_EQ(Program::graphics(test::device(), shaders.library, "scale.comp", "", {}, {}, program), Status::invalid);
    EXPECT_FALSE(program);
}

constexpr const char* kTriangle =
    "#version 460\n"
    "layout(binding = 0) uniform Tint { vec4 tint; } scene;\n"
    "layout(location = 0) out vec4 colour;\n"
    "layout(push_constant) uniform Push { vec4 depth; } push;\n"
    "void main() {\n"
    "    gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, push.depth.x, 1.0);\n"
    "    colour = scene.tint;\n"
    "}\n";
constexpr const char* kFill =
    "#version 460\n"
    "layout(binding = 0) uniform Tint { vec4 tint; } scene;\n"
    "layout(set = 2, binding = 1) uniform sampler2D material;\n"
    "layout(location = 0) in vec4 colour;\n"
    "layout(location = 0) out vec4 result;\n"
    "layout(constant_id = 0) const bool kMaterial = true;\n"
    "void main() {\n"
    "    if (gl_FragCoord.x < 4.0) discard;\n"
    "    result = kMaterial ? colour * scene.tint * texture(material, vec2(0.5)) : vec4(0.25, 0.5, 1.0, 1.0);\n"
    "}\n";

TEST_F(ProgramTest, GraphicsMergesItsStages) {
    test::TestShaders shaders;
    shaders.add("triangle.vert", kTriangle);
    shaders.add("fill.frag", kFill);
    GraphicsState state;
    state.colorFormats = {VK_FORMAT_R8G8B8A8_UNORM};
    state.depthFormat = VK_FORMAT_D32_SFLOAT;
    state.depthTest = state.depthWrite = true;
    Program program;
    ASSERT_EQ(Program::graphics(test::device(), shaders.library, "triangle.vert", "fill.frag", state, {{0, 0}}, program), Status::ok);
    ASSERT_EQ(program.bindings().size(), 2u);
    const VkShaderStageFlags both = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    EXPECT_EQ(program.stages(), both);
    EXPECT_EQ(program.stagesOf(program.bindings()[0]), both);
    EXPECT_EQ(program.stagesOf(program.bindings()[1]), VkShaderStageFlags(VK_SHADER_STAGE_FRAGMENT_BIT));
    EXPECT_NE(program.setLayout(1), VK_NULL_HANDLE) << "a gap in the set numbers is an empty layout";
    EXPECT_NE(program.setLayout(2), VK_NULL_HANDLE);
    EXPECT_EQ(program.setLayout(3), VK_NULL_HANDLE);
    EXPECT_EQ(program.pushConstantBytes(), 16u);

    shaders.add("other.frag",
        "#version 460\nlayout(binding = 0) uniform sampler2D map;\nlayout(location = 0) out vec4 c;\nvoid main() { c = texture(map, "
        "vec2(0)); }\n");
    EXPECT_EQ(Program::graphics(test::device(), shaders.library, "triangle.vert", "other.frag", state, {}, program), Status::invalid);
    EXPECT_TRUE(test::loggedContains("disagree on what set 0 binding 0 is")) << test::allLogged();
    ASSERT_EQ(Program::graphics(test::device(), shaders.library, "triangle.vert", "", {{}, VK_FORMAT_D32_SFLOAT, true, true}, {}, program),
        Status::ok)
        << "depth only";
}

TEST_F(ProgramTest, DrawsWithDynamicRendering) {
    Device& device = test::device();
    const Api& vk = device.vk();
    test::TestShaders shaders;
    shaders.add("triangle.vert",
        "#version 460\nvoid main() { gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.5, 1.0); "
        "}\n");
    shaders.add("fill.frag",
        "#version 460\nlayout(location = 0) out vec4 result;\nvoid main() { if (gl_FragCoord.x < 4.0) discard; result = vec4(0.0, 1.0, "
        "0.0, 1.0); }\n");
    GraphicsState state;
    state.colorFormats = {VK_FORMAT_R8G8B8A8_UNORM};
    Program program;
    ASSERT_EQ(Program::graphics(device, shaders.library, "triangle.vert", "fill.frag", state, {}, program), Status::ok);
    Image target;
    ASSERT_EQ(Image::create(device,
                  {VK_FORMAT_R8G8B8A8_UNORM, 8, 8, 1, 1,
                      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                  "target", target),
        Status::ok);
    ASSERT_EQ(upload(device, target, std::vector<std::byte>(8 * 8 * 4), VK_IMAGE_LAYOUT_GENERAL), Status::ok);
    ASSERT_EQ(device.runNow([&](VkCommandBuffer cmd) {
        VkRenderingAttachmentInfo colour{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        colour.imageView = target.view();
        colour.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
        colour.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
        colour.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        beginRendering(device, cmd, {8, 8}, {&colour, 1}, nullptr);
        program.bind(cmd, VK_NULL_HANDLE);
        vk.CmdDraw(cmd, 3, 1, 0, 0);
        vk.CmdEndRendering(cmd);
    }),
        Status::ok);
    std::vector<std::byte> texels;
    ASSERT_EQ(download(device, target.handle(), target.desc(), VK_IMAGE_LAYOUT_GENERAL, texels), Status::ok);
    for (size_t i = 0; i < 64; ++i) {
        uint32_t texel;
        std::memcpy(&texel, texels.data() + i * 4, 4);
        ASSERT_EQ(texel, i % 8 < 4 ? 0u : 0xff00ff00u) << i;
    }
}

}  // namespace
