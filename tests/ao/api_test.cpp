// The host API: valid input of each kind, and the errors for invalid input.
#include "ao/host_context.h"
#include "gpu/vulkan_counter.h"

namespace obscura::ao {
namespace {

TEST_F(ApiTest, everyMethodGivesVisibility) {
    for (const MethodInfo* info : methods()) {
        ASSERT_EQ(setMethod(m_context, info->id, {}), Status::ok);
        const Output output = once(frame());
        ASSERT_EQ(output.status, Status::ok) << info->id;
        const std::vector<float> visibility = pixels(output);
        double sum = 0.0;
        for (const float v : visibility) sum += v;
        EXPECT_GT(sum / double(visibility.size()), 0.5);
        EXPECT_LT(sum / double(visibility.size()), std::string(info->id) == "none" ? 1.01 : 0.97) << info->id;
    }
    EXPECT_GT(memoryUse(m_context), 0u);
}

// Without the request there is no second image, and visibility is the same to the bit; a method without bent normals says which have them.
TEST_F(ApiTest, bentNormalsAreASecondImage) {
    size_t given = 0;
    for (const MethodInfo* info : methods()) {
        MethodSettings settings;
        ASSERT_EQ(setMethod(m_context, info->id, settings), Status::ok);
        const Output without = once(frame());
        EXPECT_EQ(without.bentNormals, VkImage(VK_NULL_HANDLE));
        const std::vector<float> visibility = pixels(without);
        settings.bentNormals = true;
        lines().clear();
        EXPECT_EQ(setMethod(m_context, info->id, settings), info->bentNormals ? Status::ok : Status::invalid) << info->id;
        EXPECT_EQ(said("MethodSettings::bentNormals: " + std::string(info->id) + " has none; "), !info->bentNormals);
        EXPECT_EQ(said("gtao"), !info->bentNormals) << "the line names the methods that have them";
        const Output output = once(frame());
        ASSERT_EQ(output.status, Status::ok);
        EXPECT_EQ(pixels(output), visibility) << info->id;
        EXPECT_EQ(output.bentNormals != VkImage(VK_NULL_HANDLE), info->bentNormals) << info->id;
        if (!info->bentNormals) continue;
        ++given;
        EXPECT_NE(output.bentNormalsView, VkImageView(VK_NULL_HANDLE));
        std::vector<std::byte> bytes;
        const gpu::ImageDesc desc{VK_FORMAT_R8G8B8A8_SNORM, m_room.visibleWidth(), m_room.visibleHeight()};
        ASSERT_EQ(gpu::download(m_device, output.bentNormals, desc, output.layout, bytes), gpu::Status::ok);
        ASSERT_EQ(bytes.size(), 4 * visibility.size());
        for (size_t i = 0; i < visibility.size(); ++i) {
            const auto* texel = reinterpret_cast<const int8_t*>(&bytes[4 * i]);
            ASSERT_NEAR(texel[3] / 127.0f, visibility[i], 0.6f / 127.0f);
            const int length2 = texel[0] * texel[0] + texel[1] * texel[1] + texel[2] * texel[2];
            ASSERT_TRUE(length2 == 0 || std::abs(length2 - 127 * 127) < 3 * 127) << info->id << " pixel " << i;
        }
        for (int i = 0; i < 8; ++i) ASSERT_EQ(once(frame()).status, Status::ok);
        const uint64_t held = memoryUse(m_context);
        for (int i = 0; i < 8; ++i) ASSERT_EQ(once(frame()).status, Status::ok);
        EXPECT_LE(memoryUse(m_context), held) << "nothing is allocated after the first frames";
    }
    EXPECT_GE(given, 1u);
}

TEST_F(ApiTest, noAllocationAfterTheFirstFrames) {
    for (int i = 0; i < 4; ++i) once(frame());
    const uint64_t before = memoryUse(m_context);
    for (int i = 0; i < 20; ++i) ASSERT_EQ(once(frame()).status, Status::ok);
    EXPECT_EQ(memoryUse(m_context), before);
    EXPECT_GT(timings(m_context).size(), 2u);
}

// Motion in UV, NDC or pixels reprojects a moving image alike; a camera cut discards the history.
TEST_F(ApiTest, motionScaleConvertsToPixelsAndCutDiscardsHistory) {
    const auto motionImage = [&](float x, float y) {
        gpu::Image image;
        EXPECT_EQ(
            gpu::Image::create(m_device,
                {VK_FORMAT_R32G32_SFLOAT, m_room.width, m_room.height, 1, 1, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                "motion", image),
            gpu::Status::ok);
        std::vector<float> texels;
        for (uint32_t i = 0; i < m_room.width * m_room.height; ++i) texels.insert(texels.end(), {x, y});
        EXPECT_EQ(
            gpu::upload(m_device, image, std::as_bytes(std::span(texels)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL), gpu::Status::ok);
        return image;
    };
    const Setting history{"temporal", 0.9f};
    MethodSettings settings;
    settings.settings = {&history, 1};
    ASSERT_EQ(setMethod(m_context, "hbao", settings), Status::ok);
    const auto twoFrames = [&](const gpu::Image& motion, float scaleX, float scaleY, bool cutLast) {
        Frame f = frame();
        f.motion = {motion.handle(), motion.view(), VK_FORMAT_R32G32_SFLOAT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        f.motionScale[0] = scaleX;
        f.motionScale[1] = scaleY;
        f.cut = true;
        EXPECT_EQ(once(f).status, Status::ok);
        f.cut = cutLast;
        f.index = 1;
        return pixels(once(f));
    };
    const gpu::Image inPixels = motionImage(3.0f, -2.0f);
    const gpu::Image inNdc = motionImage(-6.0f / float(m_room.width), -4.0f / float(m_room.height));  // y up, from last frame to this
    const std::vector<float> followed = twoFrames(inPixels, 1, 1, false);
    EXPECT_EQ(twoFrames(inNdc, -0.5f * float(m_room.width), 0.5f * float(m_room.height), false), followed);
    EXPECT_NE(twoFrames(inPixels, 0.25f, 0.25f, false), followed);
    EXPECT_NE(twoFrames(inPixels, 1, 1, true), followed);
    Frame f = frame();
    f.motion.image = m_depth.handle();
    EXPECT_EQ(once(f).status, Status::invalid);
    EXPECT_TRUE(said("Frame::motion"));
    m_device.waitIdle();
}

// A resolve preset equals the settings that it lists; settings of the host override it.
TEST_F(ApiTest, resolvePresetEqualsItsSettings) {
    const auto picture = [&](const char* resolve, std::initializer_list<Setting> list) {
        MethodSettings settings;
        settings.resolve = resolve;
        settings.settings = {list.begin(), list.size()};
        EXPECT_EQ(setMethod(m_context, "hbao", settings), Status::ok);
        return pixels(once(frame()));
    };
    const std::vector<float> blurred = picture(nullptr, {}), raw = picture("raw", {});
    EXPECT_NE(raw, blurred);
    EXPECT_EQ(raw, picture(nullptr, {{"denoise", 0.0f}}));
    EXPECT_EQ(picture("spatial", {}), blurred);
    EXPECT_EQ(picture("raw", {{"denoise", 1.0f}}), blurred);
    MethodSettings wrong;
    wrong.resolve = "calm";
    EXPECT_EQ(setMethod(m_context, "hbao", wrong), Status::invalid);
    EXPECT_TRUE(said("there is no resolve preset 'calm'; there are raw, spatial, temporal"));
    m_device.waitIdle();
}

// Occluders in the host's volume outside the image darken it. Without a volume the method runs without them and logs one line.
TEST_F(ApiTest, volumeAddsOffScreenOccluders) {
    const std::vector<float> alone = pixels(once(frame()));
    const Setting hidden{"offscreen", 2.0f};
    MethodSettings settings;
    settings.settings = {&hidden, 1};
    ASSERT_EQ(setMethod(m_context, "hbao", settings), Status::ok);
    const std::vector<float> both = pixels(once(frame()));
    ASSERT_EQ(both.size(), alone.size());
    size_t darker = 0;
    for (size_t i = 0; i < both.size(); ++i) {
        EXPECT_LE(both[i], alone[i] + 1e-3f);
        darker += both[i] < alone[i] - 0.02f;
    }
    EXPECT_GT(darker, 20u);  // where the wall continues beyond the edge of the image
    Frame f = frame();
    f.volume = {};
    const Output output = once(f);
    EXPECT_EQ(output.status, Status::ok);
    EXPECT_TRUE(said("has no volume"));
    EXPECT_EQ(pixels(output).size(), alone.size());
    m_device.waitIdle();
}

// Pipelines of the off-screen pass are created once the settings turn it on, for both structures of the volume.
TEST_F(ApiTest, setMethodCreatesAllPipelines) {
    test::VulkanCounter counter(m_device);
    const auto made = [&] { return counter.created["CreateComputePipelines"]; };
    DeviceDesc d = desc();
    d.getInstanceProcAddr = &test::VulkanCounter::instanceProc;
    Context* context = nullptr;
    ASSERT_EQ(create(d, &context), Status::ok);
    const Setting hidden{"offscreen", 2.0f};
    MethodSettings settings;
    for (const List<Setting>& list : {List<Setting>{}, List<Setting>{&hidden, 1}}) {
        settings.settings = list;
        const uint64_t before = made();
        ASSERT_EQ(setMethod(context, "hbao", settings), Status::ok);
        EXPECT_EQ(made() > before, list.size() > 0);
        const uint64_t after = made();
        EXPECT_EQ(
            m_device.runNow([&](VkCommandBuffer cmd) { EXPECT_EQ(record(context, cmd, frame()).status, Status::ok); }), gpu::Status::ok);
        EXPECT_EQ(made(), after);
    }
    m_device.waitIdle();
    destroy(context);
}

TEST_F(ApiTest, resizedFrameEqualsFreshContext) {
    ASSERT_EQ(once(frame()).status, Status::ok);
    m_device.waitIdle();
    m_room.width = 97;
    m_room.height = 61;
    m_room.build();
    m_depth = m_room.image(m_device, false);
    m_normals = m_room.image(m_device, true);
    const Output output = once(frame());
    ASSERT_EQ(output.status, Status::ok);
    EXPECT_EQ(pixels(output).size(), size_t(81 * 45));
}

TEST_F(ApiTest, invalidInputGivesStatusAndLogLineNamingTheField) {
    Context* none = nullptr;
    DeviceDesc d = desc();
    d.device = VK_NULL_HANDLE;
    EXPECT_EQ(create(d, &none), Status::invalid);
    EXPECT_EQ(none, nullptr);
    EXPECT_TRUE(said("DeviceDesc::device"));
    EXPECT_EQ(setMethod(m_context, "nothing", {}), Status::invalid);
    EXPECT_TRUE(said("there is no method 'nothing'; there are none, hbao"));
    MethodSettings settings;
    settings.preset = "no such";
    EXPECT_EQ(setMethod(m_context, "hbao", settings), Status::invalid);
    EXPECT_TRUE(said("hbao has no preset 'no such'; it has default"));
    const Setting wrong{"width", 1.0f};
    settings.preset = "default";
    settings.settings = {&wrong, 1};
    EXPECT_EQ(setMethod(m_context, "hbao", settings), Status::invalid);
    EXPECT_TRUE(said("hbao has no parameter 'width'"));
    settings.settings = {};
    settings.falloff.length = -1.0f;
    EXPECT_EQ(setMethod(m_context, "hbao", settings), Status::invalid);

    Frame f = frame();
    f.depth.view = VK_NULL_HANDLE;
    EXPECT_EQ(once(f).status, Status::invalid);
    EXPECT_TRUE(said("Frame::depth"));
    f = frame();
    f.normals.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    EXPECT_EQ(once(f).status, Status::invalid);
    EXPECT_TRUE(said("Frame::normals"));
    f = frame();
    f.guard = {80, 80};
    EXPECT_EQ(once(f).status, Status::invalid);
    EXPECT_TRUE(said("Frame::guard"));
    f = frame();
    f.volume.cells = 100;
    EXPECT_EQ(once(f).status, Status::invalid);
    EXPECT_TRUE(said("Frame::volume.cells"));
    f = frame();
    f.volume.cellFromEye[5] = std::nanf("");
    EXPECT_EQ(once(f).status, Status::invalid);
    EXPECT_TRUE(said("Frame::volume.cellFromEye"));
    f = frame();
    std::fill(std::begin(f.projection), std::end(f.projection), 0.0f);
    EXPECT_EQ(once(f).status, Status::invalid);
    EXPECT_EQ(once(frame()).status, Status::ok);  // the context still works
    EXPECT_EQ(record(nullptr, VK_NULL_HANDLE, f).status, Status::invalid);
    destroy(nullptr);
}

}  // namespace
}  // namespace obscura::ao
