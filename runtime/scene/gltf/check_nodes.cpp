// Validation of a glTF file's JSON, 3 of 3: cameras, nodes, skins, scenes and animations.
#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/gltf/stages.h"
#include "scene/json_at.h"

namespace obscura::scene::gltf {
namespace {

size_t countOf(const JsonAt& root, const char* key) { return root.has(key) ? root.at(key).size() : 0; }

size_t targetsOf(const JsonAt& root, size_t mesh) {
    const JsonAt primitives = root.at("meshes").at(mesh).at("primitives");
    if (primitives.size() == 0 || !primitives.at(size_t(0)).has("targets")) return 0;
    return primitives.at(size_t(0)).at("targets").size();
}

void checkCameras(const JsonAt& root) {
    for (size_t i = 0; i < countOf(root, "cameras"); ++i) {
        const JsonAt at = root.at("cameras").at(i);
        const std::string type = at.at("type").text();
        constexpr double kTiny = 1e-30;
        if (type == "perspective") {
            const JsonAt lens = at.at("perspective").expectObject();
            lens.at("yfov").number(1e-6);
            const double near = lens.at("znear").number(kTiny);
            if (const auto far = lens.find("zfar"); far && !(float(far->number(kTiny)) > float(near)))
                far->fail("must be greater than znear");
            if (const auto aspect = lens.find("aspectRatio")) aspect->number(kTiny);
        } else if (type == "orthographic") {
            const JsonAt lens = at.at("orthographic").expectObject();
            for (const char* key : {"xmag", "ymag"})
                if (lens.at(key).number() == 0) lens.at(key).fail("must not be zero");
            if (!(float(lens.at("zfar").number(kTiny)) > float(lens.at("znear").number(0))))
                lens.at("zfar").fail("must be greater than znear");
        } else {
            at.at("type").fail(fmt::format("\"{}\" is unknown; use perspective or orthographic", type));
        }
    }
}

void checkNodes(const JsonAt& root) {
    const size_t count = countOf(root, "nodes");
    std::vector<size_t> parent(count, count);
    for (size_t i = 0; i < count; ++i) {
        const JsonAt at = root.at("nodes").at(i);
        if (const auto camera = at.find("camera")) camera->index(countOf(root, "cameras"), "camera");
        if (const auto mesh = at.find("mesh")) mesh->index(countOf(root, "meshes"), "mesh");
        if (const auto skin = at.find("skin")) {
            skin->index(countOf(root, "skins"), "skin");
            if (!at.has("mesh")) skin->fail("a node with a skin must have a mesh");
        }
        if (const auto matrix = at.find("matrix")) {
            matrix->expectNumbers(16);
            for (const char* key : {"translation", "rotation", "scale"})
                if (at.has(key)) at.at(key).fail("a node has either a matrix or translation, rotation and scale");
        }
        if (const auto translation = at.find("translation")) translation->expectNumbers(3);
        if (const auto scale = at.find("scale")) scale->expectNumbers(3);
        if (const auto rotation = at.find("rotation")) {
            rotation->expectNumbers(4);
            double length = 0;
            for (size_t k = 0; k < 4; ++k) length += std::pow(rotation->at(k).number(), 2);
            if (!(length > 1e-12)) rotation->fail("is a quaternion of length zero");
        }
        if (const auto weights = at.find("weights")) {
            if (!at.has("mesh")) weights->fail("a node with morph weights must have a mesh");
            weights->expectNumbers(targetsOf(root, at.at("mesh").index(countOf(root, "meshes"), "mesh")));
        }
        for (size_t k = 0; at.has("children") && k < at.at("children").expectArray().size(); ++k) {
            const JsonAt link = at.at("children").at(k);
            const size_t child = link.index(count, "node");
            if (parent[child] != count) link.fail(fmt::format("node {} already is a child of node {}", child, parent[child]));
            parent[child] = i;
        }
    }
    // Every node has at most one parent, so a node is on a cycle exactly if following its parents never reaches a root.
    std::vector<uint8_t> state(count, 0);  // 1: on the current path, 2: leads to a root
    for (size_t i = 0; i < count; ++i) {
        size_t node = i;
        while (node != count && state[node] == 0) {
            state[node] = 1;
            node = parent[node];
        }
        if (node != count && state[node] == 1) root.at("nodes").at(node).fail("is its own ancestor; nodes must form trees");
        for (node = i; node != count && state[node] == 1; node = parent[node]) state[node] = 2;
    }
    const auto scenes = root.find("scenes");
    for (size_t i = 0; scenes && i < scenes->size(); ++i) {
        std::set<size_t> seen;
        const auto nodes = scenes->at(i).find("nodes");
        for (size_t k = 0; nodes && k < nodes->expectArray().size(); ++k) {
            const JsonAt link = nodes->at(k);
            const size_t node = link.index(count, "node");
            if (parent[node] != count) link.fail(fmt::format("node {} is not a root: it is a child of node {}", node, parent[node]));
            if (!seen.insert(node).second) link.fail(fmt::format("node {} is listed twice", node));
        }
    }
    if (const auto scene = root.find("scene")) scene->index(countOf(root, "scenes"), "scene");
}

void checkSkins(const JsonAt& root) {
    for (size_t i = 0; i < countOf(root, "skins"); ++i) {
        const JsonAt at = root.at("skins").at(i);
        const JsonAt joints = at.at("joints").expectArray();
        if (joints.size() == 0 || joints.size() > 65535) joints.fail("must have 1 to 65535 joints");
        std::set<size_t> seen;
        for (size_t k = 0; k < joints.size(); ++k) {
            const size_t joint = joints.at(k).index(countOf(root, "nodes"), "node");
            if (!seen.insert(joint).second) joints.at(k).fail(fmt::format("node {} is listed twice", joint));
        }
        if (const auto skeleton = at.find("skeleton")) skeleton->index(countOf(root, "nodes"), "node");
        if (const auto matrices = at.find("inverseBindMatrices")) {
            const size_t index = matrices->index(countOf(root, "accessors"), "accessor");
            const JsonAt accessor = root.at("accessors").at(index);
            if (accessor.at("type").text() != "MAT4" || accessor.at("componentType").whole() != 5126)
                matrices->fail(fmt::format("accessor {} must have type MAT4 and component type 5126 (float)", index));
            if (accessor.at("count").whole() < joints.size())
                matrices->fail(
                    fmt::format("accessor {} has {} matrices for {} joints", index, accessor.at("count").whole(), joints.size()));
        }
    }
}

void checkSampler(const JsonAt& root, const JsonAt& at) {
    const auto accessor = [&](const char* key) {
        const size_t index = at.at(key).index(countOf(root, "accessors"), "accessor");
        return root.at("accessors").at(index);
    };
    const JsonAt input = accessor("input");
    if (input.at("type").text() != "SCALAR" || input.at("componentType").whole() != 5126)
        at.at("input").fail("must be an accessor of type SCALAR and component type 5126 (float)");
    accessor("output");
    if (const auto name = at.find("interpolation"))
        if (name->text() != "LINEAR" && name->text() != "STEP" && name->text() != "CUBICSPLINE")
            name->fail(fmt::format("\"{}\" is unknown; use LINEAR, STEP or CUBICSPLINE", name->text()));
}

void checkChannel(const JsonAt& root, const JsonAt& animation, const JsonAt& at, std::set<std::pair<size_t, std::string>>& seen) {
    const JsonAt sampler = animation.at("samplers").at(at.at("sampler").index(countOf(animation, "samplers"), "sampler"));
    const JsonAt target = at.at("target").expectObject();
    const std::string path = target.at("path").text();
    const auto link = target.find("node");
    if (path != "translation" && path != "rotation" && path != "scale" && path != "weights") {
        // Pointers of KHR_animation_pointer come without a node and are ignored.
        if (link || path != "pointer")
            target.at("path").fail(fmt::format("\"{}\" is unknown; use translation, rotation, scale or weights", path));
        return;
    }
    if (!link) return;
    const size_t node = link->index(countOf(root, "nodes"), "node");
    const JsonAt targetNode = root.at("nodes").at(node);
    if (!seen.insert({node, path}).second) target.fail(fmt::format("{} of node {} is already animated by another channel", path, node));
    size_t perKey = 1;
    const JsonAt output = root.at("accessors").at(sampler.at("output").index(countOf(root, "accessors"), "accessor"));
    const std::string type = output.at("type").text();
    const uint64_t component = output.at("componentType").whole();
    const bool normalized = output.has("normalized") && output.at("normalized").truth();
    if (path == "weights") {
        if (!targetNode.has("mesh") || targetsOf(root, targetNode.at("mesh").index(countOf(root, "meshes"), "mesh")) == 0)
            target.fail(fmt::format("node {} has no morph targets to animate", node));
        perKey = targetsOf(root, targetNode.at("mesh").index(countOf(root, "meshes"), "mesh"));
    } else if (targetNode.has("matrix")) {
        target.fail(fmt::format("node {} has a matrix; only translation, rotation and scale can be animated", node));
    }
    const char* expected = path == "weights" ? "SCALAR" : path == "rotation" ? "VEC4" : "VEC3";
    if (type != expected) sampler.at("output").fail(fmt::format("{} needs an accessor of {}, not {}", path, expected, type));
    const bool integers = component != 5126;
    if (integers && (component == 5125 || !normalized)) sampler.at("output").fail("must be floats or normalized integers");
    const bool cubic = sampler.has("interpolation") && sampler.at("interpolation").text() == "CUBICSPLINE";
    const uint64_t keys = root.at("accessors").at(sampler.at("input").index(countOf(root, "accessors"), "accessor")).at("count").whole();
    const uint64_t values = keys * perKey * (cubic ? 3 : 1);
    if (const uint64_t has = output.at("count").whole(); has != values)
        sampler.at("output").fail(fmt::format("has {} values, {} keys of {} need {}", has, keys, path, values));
}

void checkAnimations(const JsonAt& root) {
    for (size_t i = 0; i < countOf(root, "animations"); ++i) {
        const JsonAt at = root.at("animations").at(i);
        const JsonAt samplers = at.at("samplers").expectArray();
        for (size_t k = 0; k < samplers.size(); ++k) checkSampler(root, samplers.at(k).expectObject());
        const JsonAt channels = at.at("channels").expectArray();
        std::set<std::pair<size_t, std::string>> seen;
        for (size_t k = 0; k < channels.size(); ++k) checkChannel(root, at, channels.at(k).expectObject(), seen);
    }
}

}  // namespace

void checkScenes(Context& context, const nlohmann::json& json) {
    const JsonAt root(context.file, json);
    checkCameras(root);
    checkNodes(root);
    checkSkins(root);
    checkAnimations(root);
}

}  // namespace obscura::scene::gltf
