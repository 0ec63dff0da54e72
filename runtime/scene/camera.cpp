// Cameras: matrices, framing, glTF lenses, camera files.
#include "scene/camera.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/json_file.h"

namespace obscura::scene {

glm::mat4 Camera::view() const {
    glm::vec3 forward = target - eye;
    forward = glm::length(forward) > 1e-12f ? glm::normalize(forward) : glm::vec3(0.0f, 0.0f, -1.0f);
    // A view direction parallel to `up` needs another up vector.
    glm::vec3 above = up;
    if (!(glm::length(glm::cross(forward, above)) > 1e-6f * glm::length(above)))
        above = std::abs(forward.z) < 0.9f ? glm::vec3(0.0f, 0.0f, -1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
    // Turned first, since eye + forward has no direction where a float's step is a metre.
    glm::mat4 view = glm::lookAt(glm::vec3(0.0f), forward, above);
    view[3] = glm::vec4(-(glm::mat3(view) * eye), 1.0f);
    return view;
}

glm::mat4 Camera::projection(glm::vec2 size, glm::vec2 visible) const {
    glm::mat4 m(0.0f);
    if (orthoHalfHeight > 0.0f) {
        // Pixels are square and the guard band lies around the visible part, so one number scales both axes.
        const float pixelsPerMetre = visible.y / (2.0f * orthoHalfHeight);
        // 500 m at the default near distance of 0.05 m: 24 bits of linear depth resolve 0.03 mm.
        const float far = farPlane > 0.0f ? farPlane : 1e4f * std::max(nearPlane, 1e-4f);
        m[0][0] = 2.0f * pixelsPerMetre / size.x;
        m[1][1] = -2.0f * pixelsPerMetre / size.y;
        m[2][2] = 1.0f / (far - nearPlane);
        m[3][2] = far / (far - nearPlane);
        m[3][3] = 1.0f;
        return m;
    }
    const float focalPixels = 0.5f * visible.y / std::tan(0.5f * fovY);
    m[0][0] = 2.0f * focalPixels / size.x;
    m[1][1] = -2.0f * focalPixels / size.y;
    m[2][3] = -1.0f;
    m[3][2] = nearPlane;
    if (farPlane > 0.0f) {
        m[2][2] = nearPlane / (farPlane - nearPlane);
        m[3][2] = farPlane * m[2][2];
    }
    return m;
}

Camera frame(const Bounds& bounds) {
    Camera camera;
    if (bounds.empty) return camera;
    const float radius = std::max(bounds.radius(), 1e-3f);
    const glm::vec3 direction = glm::normalize(glm::vec3(0.8f, 0.45f, 1.0f));
    camera.target = bounds.centre();
    camera.eye = camera.target + direction * (1.05f * radius / std::sin(0.5f * camera.fovY));
    camera.nearPlane = std::clamp(0.01f * radius, 1e-4f, 0.05f);
    return camera;
}

int lensCount(const Model& model) {
    return int(std::count_if(model.order.begin(), model.order.end(), [&](int n) { return model.nodes[size_t(n)].camera >= 0; }));
}

Camera lensCamera(const Instance& instance, const Pose& pose, int index) {
    Camera camera;
    const Model& model = *instance.model;
    for (const int node : model.order) {
        if (model.nodes[size_t(node)].camera < 0 || index-- != 0) continue;
        const Lens& lens = model.lenses[size_t(model.nodes[size_t(node)].camera)];
        const glm::mat4 matrix = instance.placement * pose.world[size_t(node)];
        camera.eye = glm::vec3(matrix[3]);
        // The node's scale does not affect the view [glTF 2.0, 3.10].
        const glm::vec3 forward = -glm::vec3(matrix[2]), up = glm::vec3(matrix[1]);
        camera.target = camera.eye + (glm::length(forward) > 0.0f ? glm::normalize(forward) : glm::vec3(0.0f, 0.0f, -1.0f));
        camera.up = glm::length(up) > 0.0f ? glm::normalize(up) : glm::vec3(0.0f, 1.0f, 0.0f);
        const float unit = glm::length(glm::vec3(instance.placement[1]));  // metres a unit of the file
        camera.nearPlane = unit * lens.nearPlane;
        camera.farPlane = unit * lens.farPlane;
        if (lens.perspective) camera.fovY = lens.fovY;
        else camera.orthoHalfHeight = unit * lens.halfHeight;
        break;
    }
    return camera;
}

Camera loadCamera(const std::filesystem::path& file) {
    const JsonFile json(file);
    const JsonAt root = json.root();
    root.only({"eye", "target", "up", "verticalFovDegrees", "near"});
    Camera camera;
    camera.eye = vector3(root.at("eye"));
    camera.target = vector3(root.at("target"));
    if (const auto up = root.find("up")) camera.up = vector3(*up);
    if (const auto fov = root.find("verticalFovDegrees")) camera.fovY = fieldOfView(*fov);
    if (const auto near = root.find("near")) camera.nearPlane = float(near->number(1e-5, 1e6));
    if (camera.eye == camera.target) root.at("target").fail("must differ from eye");
    if (camera.up == glm::vec3(0.0f)) root.at("up").fail("must not be the zero vector");
    return camera;
}

}  // namespace obscura::scene
