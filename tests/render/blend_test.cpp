// Blended surfaces take the obscurance of the opaque surface close behind them.
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_precision.hpp>

#include "fixture.h"

namespace obscura::test {
namespace {

class Blended : public GpuTest {};

// A floor, a wall at z = -0.5 m, and a blended plate of 10 cm around `at` whose alpha is 1: its pixels show its own light alone.
scene::World cornerWith(const glm::vec3& at) {
    scene::Material plain;
    plain.baseColor = {0.5f, 0.5f, 0.5f, 1.0f};
    plain.metallic = 0.0f;
    scene::Material blended = plain;
    blended.alphaMode = scene::AlphaMode::blend;
    scene::World world;
    world.add(instanceOf(with(floorPlate(), plain)));
    scene::Instance wall = instanceOf(with(floorPlate(), plain));
    wall.placement = glm::rotate(glm::translate(glm::mat4(1.0f), {0.0f, 0.0f, -0.5f}), glm::radians(90.0f), {1.0f, 0.0f, 0.0f});
    world.add(wall);
    scene::Instance plate = instanceOf(with(floorPlate(), blended));
    plate.placement = glm::scale(glm::translate(glm::mat4(1.0f), at), glm::vec3(1.0f / 60.0f));
    world.add(plate);
    return world;
}

// Level of the plate's middle, 0 to 255.
float levelOfPlate(const glm::vec3& at, const char* method) {
    RenderFixture fixture;
    render::FrameOptions options = fixture.options();
    const ao::Values values(*ao::findMethod(method));
    options.method = &values;
    options.falloff = {ao::FalloffKind::quadratic, 1.0f};
    options.camera.target = at;
    options.camera.eye = at + glm::vec3(0.0f, 0.8f, 0.6f);
    options.sun.radiance = glm::vec3(0.0f);
    return float(fixture.render(cornerWith(at), options).color.at<glm::u8vec4>(160, 120).g);
}

TEST_F(Blended, areAsOccludedAsTheSurfaceCloseBehind) {
    const glm::vec3 corner(0.0f, 0.005f, -0.4f), free(0.0f, 1.0f, 0.6f);
    const float occluded = levelOfPlate(corner, "hbao"), open = levelOfPlate(corner, "none");
    EXPECT_GT(open, 30.0f);
    EXPECT_LT(occluded, 0.8f * open);
    EXPECT_EQ(levelOfPlate(free, "hbao"), levelOfPlate(free, "none"));
}

}  // namespace
}  // namespace obscura::test
