// obscura-evaluate from the command line: errors, images, tables. Invalid input prints one line, exits with 2 and writes nothing.
#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "command.h"

namespace obscura::evaluate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::vector<float>& valuesOf(truth::Picture& picture, std::string_view name) {
    return std::find_if(picture.channels.begin(), picture.channels.end(), [&](const auto& channel) {
        return channel.name == name;
    })->values;
}
std::vector<float>& depthOf(truth::Picture& picture) { return valuesOf(picture, "Z"); }

class OnAFrame : public testing::Test {
protected:
    void SetUp() override { truth::writeCapture(m_scratch / "corner", cornerFrame()); }
    fs::path exr() const { return m_scratch / "corner.capture.exr"; }
    fs::path camera() const { return m_scratch / "corner.json"; }

    // An invalid frame is refused with one line that contains `expected`, and no file is written.
    void expectRefused(const std::string& expected, const std::string& more = "") {
        const size_t before = m_scratch.files().size();
        const Ended ended = runTool(
            shellCommand("--capture {} --camera {} --json {} --out {} ", exr(), camera(), m_scratch / "e.json", m_scratch / "out") + more);
        EXPECT_EQ(ended.code, 2) << ended.error;
        EXPECT_EQ(ended.errorLines(), 1u) << ended.error;
        EXPECT_NE(ended.error.find(expected), std::string::npos) << ended.error;
        EXPECT_EQ(ended.out, "");
        EXPECT_EQ(m_scratch.files().size(), before);
    }
    void rewrite(const std::function<void(truth::Picture&)>& change) {
        truth::Picture picture = truth::readExr(exr());
        change(picture);
        truth::writeExr(exr(), picture);
    }
    json camera_() const { return json::parse(textOf(camera())); }
    TemporaryFolder m_scratch;
};

TEST_F(OnAFrame, writesErrorsImagesAndTables) {
    const Ended ended = runTool(shellCommand(
        "--capture {} --camera {} --method hbao --preset all --falloff quadratic:2,exponential:1 --rays 64 --frames 2 --json {} --out {}",
        exr(), camera(), m_scratch / "e.json", m_scratch / "out"));
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json rows = json::parse(textOf(m_scratch / "e.json"));
    ASSERT_GE(rows.size(), 4u);
    for (const json& row : rows) {
        for (const char* key : {"method", "preset", "falloff", "reference", "eA", "e5", "bias", "rmse", "p99", "ssim", "milliseconds"})
            EXPECT_TRUE(row.contains(key)) << key;
        EXPECT_LT(row["eA"], 0.1) << row["preset"];
        EXPECT_GT(row["ssim"], 0.5);
        EXPECT_TRUE(row["milliseconds"]["passes"].contains("hbao.horizons"));
        EXPECT_GE(row["milliseconds"]["all"], row["milliseconds"]["passes"]["hbao.horizons"]);
    }
    for (const char* name :
        {"corner.capture.hbao.default.quadratic_2.visibility.exr", "corner.capture.hbao.default.quadratic_2.visibility.png",
            "corner.capture.hbao.default.exponential_1.error.screen.png", "corner.capture.reference.exr", "metrics.json", "metrics.md"})
        EXPECT_TRUE(fs::exists(m_scratch / "out" / name)) << name;

    // The references it wrote can be read back and give the same errors.
    const Ended again = runTool(shellCommand("--capture {} --camera {} --frames 1 --reference {} --channel screen.quadratic_2 --json {}",
        exr(), camera(), m_scratch / "out/corner.capture.reference.exr", m_scratch / "again.json"));
    ASSERT_EQ(again.code, 0) << again.error;
    const json row = json::parse(textOf(m_scratch / "again.json"))[0];
    EXPECT_NEAR(row["eA"].get<double>(), rows[0]["eA"].get<double>(), 1e-4);
}

TEST_F(OnAFrame, everyThirdPixelMatchesTheFullReference) {
    const auto evaluate = [&](const std::string& more) {
        const Ended ended = runTool(shellCommand("--capture {} --camera {} --rays 64 --target-error 0 --frames 1 --json {} ", exr(),
                                        camera(), m_scratch / "e.json") +
                                    more);
        EXPECT_EQ(ended.code, 0) << ended.error;
        json row = json::parse(textOf(m_scratch / "e.json"))[0];
        for (const char* key : {"reference", "milliseconds", "referenceRays", "referenceError"}) row.erase(key);
        row["printed"] = ended.out;
        return row;
    };
    const json whole = evaluate(shellCommand("--out {}", m_scratch / "out"));
    const truth::Picture reference = truth::readExr(m_scratch / "out/corner.capture.reference.exr");
    json sparse = evaluate(shellCommand("--every 3 --out {}", m_scratch / "few"));
    json same =
        evaluate(shellCommand("--every 3 --reference {} --channel screen.quadratic_2", m_scratch / "out/corner.capture.reference.exr"));

    EXPECT_NE(sparse["printed"].get<std::string>().find("every 3 x 3 px"), std::string::npos) << sparse["printed"];
    EXPECT_NE(sparse["printed"].get<std::string>().find(" - "), std::string::npos) << sparse["printed"];
    sparse.erase("printed");
    same.erase("printed");
    for (const char* key : {"ssim", "flip", "flipWeightedMedian"}) {
        EXPECT_TRUE(whole.contains(key)) << key;
        EXPECT_FALSE(sparse.contains(key)) << key;
        EXPECT_FALSE(sparse["regions"]["halo"].contains(key)) << key;
    }
    EXPECT_EQ(sparse, same);
    EXPECT_EQ(sparse["every"], 3);
    EXPECT_NEAR(sparse["pixels"].get<double>(), whole["pixels"].get<double>() / 9.0, 40.0);
    EXPECT_NE(sparse["eA"], whole["eA"]);

    // The sparse reference has only the traced pixels.
    const truth::Picture few = truth::readExr(m_scratch / "few/corner.capture.reference.exr");
    ASSERT_EQ(few.width, (reference.width + 2) / 3);
    ASSERT_EQ(few.height, (reference.height + 2) / 3);
    const truth::Plane all = reference.plane("screen.quadratic_2"), some = few.plane("screen.quadratic_2");
    for (uint32_t y = 0; y < some.height; ++y)
        for (uint32_t x = 0; x < some.width; ++x) ASSERT_EQ(some.at(x, y), all.at(3 * x, 3 * y)) << x << ", " << y;
}

TEST_F(OnAFrame, deviceDepthAndWorldNormalsGiveTheSameError) {
    // The same frame with a camera in the world, reversed device depth and world normals.
    json camera = camera_();
    camera["eye"] = {1, 2, 3};
    camera["target"] = {4, 2, 3};  // looks along +x
    camera["depth"] = "device";
    camera["normals"] = "world";
    truth::Picture picture = truth::readExr(exr());
    const float near = cornerFrame().near;
    for (float& z : depthOf(picture)) z = near / z;
    const std::vector<float> eyeZ = valuesOf(picture, "N.Z"), eyeX = valuesOf(picture, "N.X");
    for (size_t i = 0; i < eyeZ.size(); ++i) {
        valuesOf(picture, "N.X")[i] = -eyeZ[i];  // the camera's -z is the world's +x
        valuesOf(picture, "N.Z")[i] = eyeX[i];
    }
    truth::writeExr(m_scratch / "dump.exr", picture);
    std::ofstream(m_scratch / "pose.json") << camera.dump();
    const auto errorOf = [&](const fs::path& image, const fs::path& pose) {
        const Ended ended =
            runTool(shellCommand("--capture {} --camera {} --rays 64 --frames 1 --json {}", image, pose, m_scratch / "e.json"));
        EXPECT_EQ(ended.code, 0) << ended.error;
        return json::parse(textOf(m_scratch / "e.json"))[0]["eA"].get<double>();
    };
    const double plain = errorOf(exr(), this->camera());
    EXPECT_NEAR(errorOf(m_scratch / "dump.exr", m_scratch / "pose.json"), plain, 0.002);
}

TEST_F(OnAFrame, missingNormalsAreReconstructed) {
    rewrite([](truth::Picture& picture) { std::erase_if(picture.channels, [](const auto& c) { return c.name != "Z"; }); });
    const Ended ended = runTool(shellCommand("--capture {} --camera {} --rays 64 --frames 1", exr(), camera()));
    EXPECT_EQ(ended.code, 0) << ended.error;
    EXPECT_NE(ended.out.find("reconstructed"), std::string::npos) << ended.out;
}

TEST_F(OnAFrame, truncatedFileIsRefused) {
    fs::resize_file(exr(), fs::file_size(exr()) / 2);
    expectRefused("corner.capture.exr");
}
TEST_F(OnAFrame, otherFileTypeIsRefused) {
    std::ofstream(exr(), std::ios::trunc) << "not an image";
    expectRefused("corner.capture.exr");
}
TEST_F(OnAFrame, missingDepthIsRefused) {
    rewrite([](truth::Picture& picture) { std::erase_if(picture.channels, [](const auto& c) { return c.name == "Z"; }); });
    expectRefused("Z is missing");
}
TEST_F(OnAFrame, incompleteNormalsAreRefused) {
    rewrite([](truth::Picture& picture) { std::erase_if(picture.channels, [](const auto& c) { return c.name == "N.Y"; }); });
    expectRefused("N.Y is missing");
}
TEST_F(OnAFrame, otherSizeIsRefused) {
    json camera = camera_();
    camera["visible"] = {60, 36};
    std::ofstream(this->camera()) << camera.dump();
    expectRefused("corner.json makes 72 x 44");
}
TEST_F(OnAFrame, nanDepthIsRefused) {
    rewrite([](truth::Picture& picture) { depthOf(picture)[5] = std::numeric_limits<float>::quiet_NaN(); });
    expectRefused("pixel (5, 0)");
}
TEST_F(OnAFrame, infiniteDepthIsRefused) {
    rewrite([](truth::Picture& picture) { depthOf(picture)[7] = std::numeric_limits<float>::infinity(); });
    expectRefused("pixel (7, 0)");
}
TEST_F(OnAFrame, missingFieldOfViewIsRefused) {
    json camera = camera_();
    camera.erase("verticalFovDegrees");
    std::ofstream(this->camera()) << camera.dump();
    expectRefused("verticalFovDegrees");
}
TEST_F(OnAFrame, invalidCameraJsonIsRefused) {
    std::ofstream(camera(), std::ios::trunc) << "{ \"visible\": [64,";
    expectRefused("corner.json");
}
TEST_F(OnAFrame, referenceOfOtherSizeIsRefused) {
    truth::Picture picture;
    picture.add("world.quadratic_2", truth::Plane(8, 8));
    truth::writeExr(m_scratch / "r.exr", picture);
    expectRefused("8 x 8", shellCommand("--reference {}", m_scratch / "r.exr"));
}
TEST_F(OnAFrame, missingReferenceChannelIsRefused) {
    truth::Picture picture;
    picture.add("world.quadratic_2", truth::Plane(64, 36));
    truth::writeExr(m_scratch / "r.exr", picture);
    expectRefused("world.quadratic_2", shellCommand("--reference {} --falloff linear:1", m_scratch / "r.exr"));
}
TEST_F(OnAFrame, unwritableFolderIsRefused) {
    std::ofstream(m_scratch / "file") << "x";
    const Ended ended = runTool(shellCommand("--capture {} --camera {} --json {}", exr(), camera(), m_scratch / "file" / "e.json"));
    EXPECT_EQ(ended.code, 2);
    EXPECT_EQ(ended.errorLines(), 1u) << ended.error;
}

TEST(OnAScene, capturedFrameGivesTheSameErrors) {
    const TemporaryFolder scratch;
    const std::string reference = (scratch / "out/toasters.own.reference.exr").string();
    const Ended scene = runTool(shellCommand("--scene toasters --size 96x54 --rays 64 --frames 1 --json {} --out {} --capture-out {}",
        scratch / "a.json", scratch / "out", scratch / "frame"));
    ASSERT_EQ(scene.code, 0) << scene.error;
    const Ended capture = runTool(shellCommand("--capture {} --camera {} --frames 1 --reference {} --json {}",
        scratch / "frame.capture.exr", scratch / "frame.json", reference, scratch / "b.json"));
    ASSERT_EQ(capture.code, 0) << capture.error;
    const json a = json::parse(textOf(scratch / "a.json"))[0], b = json::parse(textOf(scratch / "b.json"))[0];
    EXPECT_NEAR(a["eA"].get<double>(), b["eA"].get<double>(), 2e-4);
    EXPECT_EQ(a["pixels"], b["pixels"]);
}

TEST(OnAScene, measuresBentNormals) {
    const TemporaryFolder scratch;
    const std::string folder = (scratch / "out").string(), file = (scratch / "a.json").string();
    const Ended ended = runTool(shellCommand(
        "--scene toasters --size 96x54 --rays 64 --frames 1 --method layered,ssao --bent-normals --json {} --out {}", file, folder));
    ASSERT_EQ(ended.code, 0) << ended.error;
    EXPECT_NE(ended.out.find("the reference itself"), std::string::npos) << ended.out;
    const json rows = json::parse(textOf(file));
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_FALSE(rows[1].contains("bentNormals")) << "ssao has none";
    const json bent = rows[0].at("bentNormals"), least = bent.at("reference");
    EXPECT_EQ(bent["pixels"], rows[0]["pixels"]);
    EXPECT_GT(bent["degrees"], 0.5);
    EXPECT_LT(bent["degrees"], 0.7 * bent["normalDegrees"].get<double>());
    EXPECT_LT(bent["irradianceErrorBent"], bent["irradianceError"]);
    EXPECT_LT(least["irradianceErrorBent"], least["irradianceError"]);
    EXPECT_LT(least["irradianceErrorBent"], bent["irradianceErrorBent"]);
    EXPECT_TRUE(fs::exists(scratch / "out/toasters.own.layered.default.quadratic_2.bent.png"));
    EXPECT_FALSE(fs::exists(scratch / "out/toasters.own.ssao.default.quadratic_2.bent.png"));
    for (const char* arguments :
        {"--scene toasters --method ssao --bent-normals", "--scene toasters --method gtao --reference screen --bent-normals"}) {
        const Ended refused = runTool(arguments);
        EXPECT_EQ(refused.code, 2) << arguments;
        EXPECT_EQ(refused.errorLines(), 1u) << refused.error;
        EXPECT_NE(refused.error.find("--bent-normals: "), std::string::npos) << refused.error;
    }
}

TEST(OnAScene, passesOfSomeFramesOnlyAreTimed) {
    // Depth layers are drawn by two techniques in turn until one is measured to be cheaper.
    const TemporaryFolder scratch;
    const std::string file = (scratch / "a.json").string();
    const Ended ended =
        runTool(shellCommand("--scene toasters --size 96x54 --rays 32 --warm-up 0 --frames 1 --rounds 8 --method layered --preset ultra"
                             " --reference screen --json {}",
            file));
    ASSERT_EQ(ended.code, 0) << ended.error;
    const json passes = json::parse(textOf(file))[0]["milliseconds"]["passes"];
    EXPECT_TRUE(passes.contains("layers.second hit")) << passes;
    for (const auto& [name, time] : passes.items()) EXPECT_TRUE(time.is_number() && time.get<double>() >= 0.0) << name << ": " << time;
}

TEST(OnAScene, unknownNamesPrintOneLine) {
    for (const char* arguments :
        {"--scene toaster", "--scene no/such.glb", "--scene toasters --camera scene:99", "--scene toasters --camera path:no.json@1",
            "--scene toasters --camera no.json", "--scene toasters --reference no.exr", "--check-baseline no.json"}) {
        const Ended ended = runTool(arguments);
        EXPECT_EQ(ended.code, 2) << arguments << ": " << ended.error;
        EXPECT_EQ(ended.errorLines(), 1u) << arguments << ": " << ended.error;
    }
}

TEST(OnAScene, gateFailsWhenACellWorsens) {
    const TemporaryFolder scratch;
    const std::string file = (scratch / "b.json").string();
    std::ofstream(file)
        << R"({"size":[64,36],"guard":0.1,"rays":32,"seed":1,"relative":0.03,"absolute":0.0005,"scenes":["toasters"],"cameras":["own"],)"
           R"("falloffs":["quadratic:2"],"references":["world"],"cells":[]})";
    EXPECT_EQ(runTool(shellCommand("--renew-baseline {} --method none", file)).code, 0);
    EXPECT_EQ(runTool(shellCommand("--check-baseline {} --method none", file)).code, 0);
    json baseline = json::parse(textOf(file));
    ASSERT_EQ(baseline["cells"].size(), 1u);
    baseline["cells"][0]["eA"] = baseline["cells"][0]["eA"].get<double>() * 0.96;
    std::ofstream(file) << baseline.dump();
    const Ended worse = runTool(shellCommand("--check-baseline {} --method none", file));
    EXPECT_EQ(worse.code, 1);
    EXPECT_NE(worse.out.find("--renew-baseline"), std::string::npos) << worse.out;
}

}  // namespace
}  // namespace obscura::evaluate
