// Captured frames: round trip, depth and normal conventions, one-line errors for invalid input.
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include "scratch.h"
#include "truth/captured_frame.h"

namespace {

using namespace obscura;
using namespace obscura::truth;
using test::expectError;
using test::TemporaryFolder;

// A tilted plane with a strip of sky, camera in the world.
CapturedFrame sample() {
    scene::Camera camera;
    camera.eye = {1.0f, 2.0f, 3.0f};
    camera.target = {-2.0f, 0.5f, -1.0f};
    camera.fovY = 0.9f;
    camera.nearPlane = 0.1f;
    CapturedFrame frame = emptyFrame({32, 18}, {4, 2}, 0.9f, 0.1f, camera);
    const glm::vec3 n = glm::normalize(glm::vec3(0.2f, 0.9f, 0.4f));
    const shared::View view = frame.view();
    for (uint32_t y = 4; y < frame.size.y; ++y)
        for (uint32_t x = 0; x < frame.size.x; ++x) {
            const glm::vec3 ray(
                (float(x) + 0.5f) * view.unproject.x + view.unproject.z, (float(y) + 0.5f) * view.unproject.y + view.unproject.w, -1.0f);
            const float depth = -1.5f / glm::dot(n, ray);
            if (!(depth > 0.0f && depth < 100.0f)) continue;
            frame.depth[frame.index(x, y)] = depth;
            frame.normals[frame.index(x, y)] = n;
        }
    return frame;
}

void replaceIn(const std::filesystem::path& file, const std::string& from, const std::string& to) {
    std::string text = test::readText(file);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    test::writeText(file, text.replace(at, from.size(), to));
}

TEST(Capture, roundTrips) {
    const TemporaryFolder scratch;
    const CapturedFrame frame = sample();
    writeCapture(scratch / "view", frame);
    EXPECT_EQ(scratch.files().size(), 2u);
    for (const char* name : {"view", "view.json", "view.capture.exr"}) {
        const CapturedFrame back = readCapture(scratch / name);
        EXPECT_EQ(back.size, frame.size);
        EXPECT_EQ(back.guard, frame.guard);
        EXPECT_EQ(back.visible(), glm::uvec2(32, 18));
        EXPECT_EQ(back.depth, frame.depth);
        EXPECT_NEAR(back.verticalFov, frame.verticalFov, 1e-6f);
        ASSERT_TRUE(back.camera);
        EXPECT_EQ(back.camera->target, frame.camera->target);
        for (size_t i = 0; i < back.normals.size(); ++i) EXPECT_LT(glm::length(back.normals[i] - frame.normals[i]), 1e-6f);
    }
}

TEST(Capture, positionsLieOnThePlane) {
    const CapturedFrame frame = sample();
    const glm::vec3 n = glm::normalize(glm::vec3(0.2f, 0.9f, 0.4f));
    for (uint32_t y = 0; y < frame.size.y; ++y)
        for (uint32_t x = 0; x < frame.size.x; ++x)
            if (!frame.isSky(frame.index(x, y))) {
                EXPECT_NEAR(glm::dot(n, frame.eyePosition(x, y)), -1.5f, 1e-4f);
            }
}

TEST(Capture, deviceDepthAndWorldNormalsGiveTheSameFrame) {
    const TemporaryFolder scratch;
    const CapturedFrame frame = sample();
    writeCapture(scratch / "view", frame);
    // A conventional projection: depth 0 near, 1 at 50 m, y up.
    const float zNear = 0.1f, zFar = 200.0f;
    glm::mat4 projection = frame.projection;
    projection[1][1] = -projection[1][1];
    projection[2][2] = -zFar / (zFar - zNear);
    projection[3][2] = -zFar * zNear / (zFar - zNear);
    std::string numbers;
    for (int i = 0; i < 16; ++i) numbers += fmt::format("{}{}", i ? "," : "", glm::value_ptr(projection)[i]);
    replaceIn(scratch / "view.json", "\"near\"", "\"depth\":\"device\",\"normals\":\"world\",\"projection\":[" + numbers + "],\"near\"");
    // Its y points up, so rows are stored bottom to top.
    Picture picture = readExr(scratch / "view.capture.exr");
    const glm::mat3 worldFromEye(frame.worldFromEye());
    for (uint32_t y = 0; y < frame.size.y; ++y)
        for (uint32_t x = 0; x < frame.size.x; ++x) {
            const size_t from = frame.index(x, frame.size.y - 1 - y), to = frame.index(x, y);
            const float z = frame.depth[from];
            const glm::vec3 n = worldFromEye * frame.normals[from];
            for (auto& channel : picture.channels)
                channel.values[to] = channel.name == "Z" ? (frame.isSky(from) ? 1.0f : (-projection[2][2] * z + projection[3][2]) / z)
                                                         : n[channel.name[2] - 'X'];
        }
    writeExr(scratch / "view.capture.exr", picture);
    const CapturedFrame back = readCapture(scratch / "view");
    for (uint32_t y = 0; y < frame.size.y; ++y)
        for (uint32_t x = 0; x < frame.size.x; ++x) {
            const size_t a = frame.index(x, frame.size.y - 1 - y), b = back.index(x, y);
            ASSERT_EQ(back.isSky(b), frame.isSky(a));
            if (back.isSky(b)) continue;
            EXPECT_NEAR(back.depth[b], frame.depth[a], 2e-4f * frame.depth[a]);
            EXPECT_LT(glm::length(back.normals[b] - frame.normals[a]), 1e-5f);
            EXPECT_LT(glm::length(back.eyePosition(x, y) - frame.eyePosition(x, frame.size.y - 1 - y)), 1e-3f * frame.depth[a]);
        }
}

TEST(Capture, missingNormalsCanBeReconstructed) {
    const TemporaryFolder scratch;
    CapturedFrame frame = sample();
    const std::vector<glm::vec3> normals = frame.normals;
    frame.normals.clear();
    writeCapture(scratch / "view", frame);
    CapturedFrame back = readCapture(scratch / "view");
    EXPECT_FALSE(back.hasNormals());
    back.reconstructNormals();
    for (uint32_t y = 6; y < frame.size.y - 1; ++y)
        for (uint32_t x = 1; x < frame.size.x - 1; ++x)
            if (!back.isSky(back.index(x, y)) && !back.isSky(back.index(x, y - 2))) {
                EXPECT_GT(glm::dot(back.normals[back.index(x, y)], normals[back.index(x, y)]), 0.999f);
            }
}

TEST(Capture, everyMissingFieldIsNamed) {
    for (const char* field : {"verticalFovDegrees", "visible", "guardBand", "near", "target"}) {
        const TemporaryFolder scratch;
        writeCapture(scratch / "view", sample());
        replaceIn(scratch / "view.json", fmt::format("\"{}\"", field), "\"other\"");
        expectError([&] { readCapture(scratch / "view"); }, fmt::format("\"{}\" is missing", field));
    }
}

TEST(Capture, invalidValuesAreNamedWithTheirPixel) {
    const TemporaryFolder scratch;
    const auto expectBad = [&](const char* channel, float value, const std::string& part) {
        writeCapture(scratch / "view", sample());
        Picture picture = readExr(scratch / "view.capture.exr");
        for (auto& c : picture.channels)
            if (c.name == channel) c.values[size_t(20) * picture.width + 7] = value;
        writeExr(scratch / "view.capture.exr", picture);
        expectError([&] { readCapture(scratch / "view"); }, part);
    };
    expectBad("Z", std::nanf(""), "Z is nan at pixel (7, 20)");
    expectBad("Z", std::numeric_limits<float>::infinity(), "Z is inf at pixel (7, 20)");
    expectBad("Z", -2.0f, "Z is -2 at pixel (7, 20)");
    expectBad("N.Y", 9.0f, "at pixel (7, 20); normals are unit vectors");
    expectBad("N.Y", std::nanf(""), "N has length nan at pixel (7, 20)");
}

TEST(Capture, invalidFilesGiveActionableErrors) {
    const TemporaryFolder scratch;
    expectError([&] { readCapture(scratch / "none"); }, "none.json: is missing");
    writeCapture(scratch / "view", sample());
    replaceIn(scratch / "view.json", "32,", "33,");
    expectError([&] { readCapture(scratch / "view"); }, "is 40 x 22 pixels, but visible + 2 * guardBand in view.json makes 41 x 22");

    writeCapture(scratch / "view", sample());
    Picture picture = readExr(scratch / "view.capture.exr", {"N.X", "N.Y", "N.Z"});
    writeExr(scratch / "view.capture.exr", picture);
    expectError([&] { readCapture(scratch / "view"); }, "channel Z is missing");
    writeCapture(scratch / "view", sample());
    picture = readExr(scratch / "view.capture.exr", {"Z", "N.X", "N.Y"});
    writeExr(scratch / "view.capture.exr", picture);
    expectError([&] { readCapture(scratch / "view"); }, "channel N.Z is missing");

    writeCapture(scratch / "view", sample());
    const std::string bytes = test::readText(scratch / "view.capture.exr");
    test::writeText(scratch / "view.capture.exr", bytes.substr(0, bytes.size() - 40));
    expectError([&] { readCapture(scratch / "view"); }, "is truncated");

    writeCapture(scratch / "view", sample());
    replaceIn(scratch / "view.json", "\"near\"", "\"depth\":\"reversed\",\"near\"");
    expectError([&] { readCapture(scratch / "view"); }, "must be \"linear\" or \"device\", not \"reversed\"");
}

TEST(Capture, invalidFramesAreNotWritten) {
    const TemporaryFolder scratch;
    CapturedFrame frame = sample();
    frame.depth[5] = std::nanf("");
    expectError([&] { writeCapture(scratch / "view", frame); }, "Z is nan");
    EXPECT_EQ(scratch.files().size(), 0u);
}

}  // namespace
