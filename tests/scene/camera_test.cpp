// Camera matrices, glTF cameras, and flythrough paths.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "gltf_builder.h"
#include "scene/camera.h"

namespace obscura::scene::test {
namespace {

namespace fs = std::filesystem;

glm::vec3 project(const glm::mat4& m, const glm::vec3& p) {
    const glm::vec4 clip = m * glm::vec4(p, 1.0f);
    return glm::vec3(clip) / clip.w;
}

TEST(Camera, ReversedInfiniteDepth) {
    Camera camera;
    camera.nearPlane = 0.1f;
    const glm::mat4 m = camera.projection({800, 600}, {800, 600});
    EXPECT_FLOAT_EQ(project(m, {0, 0, -0.1f}).z, 1.0f);
    EXPECT_FLOAT_EQ(project(m, {0, 0, -1.0f}).z, 0.1f);
    EXPECT_FLOAT_EQ(project(m, {0, 0, -1e6f}).z, 1e-7f);
}

TEST(Camera, FieldOfViewSpansTheVisiblePart) {
    Camera camera;
    camera.fovY = 1.0f;
    const float edge = std::tan(0.5f);  // height at distance 1
    glm::mat4 m = camera.projection({800, 600}, {800, 600});
    EXPECT_FLOAT_EQ(project(m, {0, edge, -1}).y, -1.0f) << "y points down";
    EXPECT_FLOAT_EQ(project(m, {edge * 800 / 600, 0, -1}).x, 1.0f) << "pixels are square";
    // A guard band of 100 pixels on each side.
    m = camera.projection({1000, 800}, {800, 600});
    EXPECT_FLOAT_EQ(project(m, {0, edge, -1}).y, -600.0f / 800.0f);
    EXPECT_FLOAT_EQ(project(m, {edge * 800 / 600, 0, -1}).x, 800.0f / 1000.0f);
}

TEST(Camera, Orthographic) {
    Camera camera;
    camera.orthoHalfHeight = 2.0f;
    camera.nearPlane = 0.1f;
    const glm::mat4 m = camera.projection({1000, 800}, {800, 600});
    EXPECT_FLOAT_EQ(project(m, {0, 2, -1}).y, -0.75f);
    EXPECT_FLOAT_EQ(project(m, {2.0f * 800 / 600, 0, -7}).x, 0.8f);
    EXPECT_FLOAT_EQ(project(m, {0, 0, -0.1f}).z, 1.0f);
    EXPECT_NEAR(project(m, {0, 0, -1000.0f}).z, 0.0f, 1e-6f);
}

TEST(Camera, ViewLooksDownMinusZ) {
    Camera camera;
    camera.eye = {1, 2, 3};
    camera.target = {1, 2, -5};
    EXPECT_NEAR(glm::length(glm::vec3(camera.view() * glm::vec4(1, 2, -5, 1)) - glm::vec3(0, 0, -8)), 0, 1e-5);
    camera.target = {1, -5, 3};  // along up: still a rotation
    const glm::mat4 down = camera.view();
    EXPECT_NEAR(glm::determinant(glm::mat3(down)), 1.0f, 1e-5);
    EXPECT_NEAR((down * glm::vec4(1, -5, 3, 1)).z, -7.0f, 1e-5);
}

// Where a float's step is 4 m, or 0.1 m.
TEST(Camera, ViewFromAfarKeepsItsDirection) {
    Camera camera;
    camera.eye = {1, 33554432, 3};
    camera.target = {0, 0, 0};
    const glm::mat4 down = camera.view();
    EXPECT_NEAR(glm::determinant(glm::mat3(down)), 1.0f, 1e-5);
    camera.eye = {1e6f, 1e6f, 1e6f};
    camera.target = camera.eye + glm::vec3(3, 1, -2);
    const glm::vec3 ahead = glm::mat3(camera.view()) * glm::normalize(glm::vec3(3, 1, -2));
    EXPECT_NEAR(glm::length(ahead - glm::vec3(0, 0, -1)), 0.0f, 1e-6f);
}

TEST(Camera, FrameSeesTheBounds) {
    Bounds box;
    box.add({-1, 0, -2});
    box.add({3, 4, 5});
    const Camera camera = frame(box);
    const glm::mat4 m = camera.projection({600, 600}, {600, 600}) * camera.view();
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 p = project(m, {i & 1 ? -1 : 3, i & 2 ? 0 : 4, i & 4 ? -2 : 5});
        EXPECT_LT(std::abs(p.x), 1.0f);
        EXPECT_LT(std::abs(p.y), 1.0f);
        EXPECT_TRUE(p.z > 0 && p.z < 1);
    }
}

TEST(Camera, LensesArePlacedByNodes) {
    GltfBuilder b;
    b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0.5}, {"zfar", 10}}}}};
    b.json["nodes"] = {{{"camera", 1}}, {{"camera", 0}, {"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}}};
    b.json["scenes"] = Json::array({{{"nodes", {0, 1}}}});
    const auto model = b.load();
    ASSERT_EQ(lensCount(*model), 2);
    const Pose rest = evaluate(*model, -1, 0);
    EXPECT_EQ(lensCamera({model}, rest, 0).orthoHalfHeight, 3.0f);
    const Camera second = lensCamera({model}, rest, 1);
    EXPECT_EQ(second.eye, glm::vec3(1, 2, 3));
    EXPECT_EQ(second.target, glm::vec3(1, 2, 2));
    EXPECT_EQ(second.fovY, 0.5f);
    EXPECT_EQ(second.nearPlane, 0.25f);
}

// Lengths of a lens are scaled with the scene. Nodes' scales do not count.
TEST(Camera, LensesAreScaledByThePlacement) {
    GltfBuilder b;
    b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 250}, {"zfar", 8000}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 2000}, {"ymag", 3000}, {"znear", 0}, {"zfar", 10000}}}}};
    b.json["nodes"] = {{{"camera", 0}, {"translation", {1000, 2000, 3000}}}, {{"scale", {7, 7, 7}}, {"children", {2}}}, {{"camera", 1}}};
    b.json["scenes"] = Json::array({{{"nodes", {0, 1}}}});
    const auto model = b.load();
    glm::mat4 placement(0.001f);
    placement[3][3] = 1.0f;
    const Pose rest = evaluate(*model, kRestPose, 0);
    const Camera perspective = lensCamera({.model = model, .placement = placement}, rest, 0);
    EXPECT_NEAR(glm::length(perspective.eye - glm::vec3(1, 2, 3)), 0.0f, 1e-6f);
    EXPECT_FLOAT_EQ(perspective.nearPlane, 0.25f);
    EXPECT_FLOAT_EQ(perspective.farPlane, 8.0f);
    const Camera flat = lensCamera({.model = model, .placement = placement}, rest, 1);
    EXPECT_FLOAT_EQ(flat.orthoHalfHeight, 3.0f);
    EXPECT_EQ(flat.nearPlane, 0.0f);
    EXPECT_FLOAT_EQ(flat.farPlane, 10.0f);
    const glm::mat4 m = flat.projection({600, 600}, {600, 600});
    EXPECT_FLOAT_EQ(project(m, {0, 0, 0}).z, 1.0f);
    EXPECT_NEAR(project(m, {0, 0, -10}).z, 0.0f, 1e-6f);
}

TEST(Camera, FiniteFarPlane) {
    Camera camera;
    camera.nearPlane = 0.5f;
    camera.farPlane = 200.0f;
    const glm::mat4 m = camera.projection({800, 600}, {800, 600});
    EXPECT_FLOAT_EQ(project(m, {0, 0, -0.5f}).z, 1.0f);
    EXPECT_NEAR(project(m, {0, 0, -200.0f}).z, 0.0f, 1e-7f);
    EXPECT_LT(project(m, {0, 0, -201.0f}).z, 0.0f);
}

class CameraFile : public testing::Test {
protected:
    void SetUp() override { m_file = fs::temp_directory_path() / ("obscura_path_" + std::to_string(getpid()) + ".json"); }
    void TearDown() override { fs::remove(m_file); }
    void write(const std::string& text) const { std::ofstream(m_file) << text; }
    template <class Load>
    std::string errorOf(const std::string& text, const Load& load) const {
        write(text);
        try {
            load(m_file);
            return {};
        } catch (const Error& error) {
            return error.what();
        }
    }
    std::string pathError(const std::string& text) const { return errorOf(text, loadCameraPath); }
    fs::path m_file;
};

TEST_F(CameraFile, Camera) {
    write(R"({"eye":[1,2,3],"target":[0,0,0],"verticalFovDegrees":90,"near":0.5})");
    const Camera camera = loadCamera(m_file);
    EXPECT_EQ(camera.eye, glm::vec3(1, 2, 3));
    EXPECT_FLOAT_EQ(camera.fovY, 1.5707963f);
    EXPECT_EQ(camera.nearPlane, 0.5f);
    EXPECT_TRUE(contains(errorOf(R"({"eye":[1,2,3],"target":[0,0,0],"fov":90})", loadCamera), "unknown field \"fov\""));
    EXPECT_TRUE(contains(errorOf(R"({"eye":[1,2],"target":[0,0,0]})", loadCamera), "/eye: must have 3 numbers"));
    EXPECT_TRUE(contains(errorOf("{", loadCamera), m_file.string()));
    // So far that a float's squares overflow.
    EXPECT_TRUE(contains(errorOf(R"({"eye":[1e30,2,3],"target":[0,0,0]})", loadCamera), "/eye/0: 1e+30 is out of range"));
}

constexpr const char* kPath = R"({"name":"round","scene":"toasters","duration":8,"loop":true,
  "keys":[{"time":0,"eye":[0,1,4],"target":[0,1,0],"verticalFovDegrees":60},
          {"time":1,"eye":[4,1.5,0.3],"target":[0.2,1,0],"verticalFovDegrees":50},
          {"time":4,"eye":[0,2,-4],"target":[0,1,0.1],"verticalFovDegrees":70},
          {"time":5.5,"eye":[-4,1,0],"target":[0,0.7,0]}],
  "events":[{"time":2,"method":"hbao"}]})";

TEST_F(CameraFile, PathPassesThroughItsKeys) {
    write(kPath);
    const CameraPath path = loadCameraPath(m_file);
    for (const auto& key : path.keys) {
        EXPECT_NEAR(glm::length(path.at(key.time).eye - key.eye), 0, 1e-4);
        EXPECT_NEAR(glm::length(path.at(key.time + 8).target - key.target), 0, 1e-4) << "one loop later";
        EXPECT_NEAR(path.at(key.time).fovY, key.fovY, 1e-4);
    }
}

TEST_F(CameraFile, PathIsContinuousInPositionAndVelocity) {
    write(kPath);
    for (const bool loop : {true, false}) {
        CameraPath path = loadCameraPath(m_file);
        path.loop = loop;
        constexpr double kStep = 1.0 / 256;
        const double end = loop ? 16.0 : 5.5;
        glm::vec3 last = path.at(0).eye, velocity(0);
        for (double t = kStep; t < end; t += kStep) {
            const glm::vec3 eye = path.at(float(t)).eye;
            const glm::vec3 now = (eye - last) / float(kStep);
            EXPECT_LT(glm::length(eye - last), 0.15f) << t;
            EXPECT_TRUE(t == kStep || glm::length(now - velocity) < 0.15f) << "at " << t << ": " << glm::length(now - velocity);
            velocity = now;
            last = eye;
        }
    }
}

TEST_F(CameraFile, RestingCameraStays) {
    write(R"({"loop":false,"keys":[{"time":0,"eye":[0,0,0],"target":[0,0,-1]},{"time":1,"eye":[3,0,0],"target":[3,0,-1]},
              {"time":2,"eye":[3,0,0],"target":[3,0,-1]},{"time":3,"eye":[6,0,0],"target":[6,0,-1]}]})");
    const CameraPath path = loadCameraPath(m_file);
    for (float t = 1; t <= 2; t += 0.05f) EXPECT_NEAR(path.at(t).eye.x, 3.0f, 0.01f) << t;
    for (float t = 0; t < 3; t += 0.05f) EXPECT_LE(path.at(t).eye.x, path.at(t + 0.05f).eye.x + 1e-4f) << "moves backwards at " << t;
}

TEST_F(CameraFile, SaveAndLoadAgree) {
    write(kPath);
    const CameraPath path = loadCameraPath(m_file);
    path.save(m_file);
    const CameraPath again = loadCameraPath(m_file);
    EXPECT_EQ(again.name, path.name);
    EXPECT_EQ(again.scene, path.scene);
    EXPECT_EQ(again.duration, path.duration);
    EXPECT_EQ(again.loop, path.loop);
    EXPECT_EQ(again.events, path.events);
    ASSERT_EQ(again.keys.size(), path.keys.size());
    for (size_t i = 0; i < path.keys.size(); ++i) {
        EXPECT_EQ(again.keys[i].time, path.keys[i].time);
        EXPECT_EQ(again.keys[i].eye, path.keys[i].eye);
        EXPECT_EQ(again.keys[i].target, path.keys[i].target);
        EXPECT_EQ(again.keys[i].fovY, path.keys[i].fovY);
    }
    EXPECT_FALSE(fs::exists(m_file.string() + ".tmp"));
    try {
        path.save("/nowhere/at/all.json");
        FAIL();
    } catch (const Error& error) {
        EXPECT_TRUE(contains(error.what(), "/nowhere/at/all.json")) << error.what();
    }
}

TEST_F(CameraFile, PathErrorsNameTheField) {
    EXPECT_TRUE(contains(pathError(R"({"keys":[]})"), "/keys: must have at least one key"));
    EXPECT_TRUE(contains(pathError(R"({"speed":1,"keys":[]})"), "unknown field \"speed\""));
    EXPECT_TRUE(contains(pathError(R"({"keys":[{"time":0,"eye":[0,0,0],"target":[0,0,1],"roll":3}]})"), "/keys/0: unknown field \"roll\""));
    EXPECT_TRUE(contains(pathError(R"({"keys":[{"time":1,"eye":[0,0,0],"target":[0,0,1]},{"time":1,"eye":[1,0,0],"target":[0,0,1]}]})"),
        "/keys/1/time: 1 s does not come after"));
    EXPECT_TRUE(contains(
        pathError(
            R"({"duration":1,"loop":false,"keys":[{"time":0,"eye":[0,0,0],"target":[0,0,1]},{"time":2,"eye":[1,0,0],"target":[0,0,1]}]})"),
        "/duration: is 1 s, but the keys span 2 s"));
    EXPECT_TRUE(contains(pathError(R"({"keys":[{"time":0,"eye":[0,0,0],"target":[0,0,1]},{"time":2,"eye":[1,0,0],"target":[0,0,1]}]})"),
        "a loop's last key"));
    EXPECT_TRUE(contains(pathError("[]"), "must be an object"));
    EXPECT_TRUE(
        contains(pathError(R"({"keys":[{"time":0,"eye":[0,0,0],"target":[0,1e30,1]}]})"), "/keys/0/target/1: 1e+30 is out of range"));
}

}  // namespace
}  // namespace obscura::scene::test
