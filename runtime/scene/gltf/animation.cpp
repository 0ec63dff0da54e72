// glTF animations to channels of keys, values as floats.
#include <algorithm>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf/stages.h"

namespace obscura::scene::gltf {
namespace {

void checkTimes(const Context& context, const std::vector<float>& times, const std::string& pointer) {
    for (size_t i = 0; i < times.size(); ++i) {
        if (times[i] < 0.0f) context.fail(pointer, fmt::format("key {} is at the negative time {}", i, times[i]));
        if (i > 0 && times[i] <= times[i - 1])
            context.fail(pointer, fmt::format("key {} at {} s does not come after key {} at {} s", i, times[i], i - 1, times[i - 1]));
    }
}

AnimatedPath pathOf(const std::string& name) {
    if (name == "translation") return AnimatedPath::translation;
    if (name == "rotation") return AnimatedPath::rotation;
    if (name == "scale") return AnimatedPath::scale;
    return AnimatedPath::weights;
}

Interpolation interpolationOf(const std::string& name) {
    if (name == "STEP") return Interpolation::step;
    if (name == "CUBICSPLINE") return Interpolation::cubicSpline;
    return Interpolation::linear;
}

// Subtracts from the positions of the keys, not from their tangents.
void shift(Channel& channel, const glm::dvec3& by) {
    const size_t group = channel.interpolation == Interpolation::cubicSpline ? 9 : 3, first = group == 9 ? 3 : 0;
    for (size_t key = 0; key + group <= channel.values.size(); key += group)
        for (int axis = 0; axis < 3; ++axis) {
            float& value = channel.values[key + first + size_t(axis)];
            value = float(double(value) - by[axis]);
        }
}

}  // namespace

void addAnimations(Context& context, const Asset& asset, Model& model) {
    for (size_t a = 0; a < asset.gltf->animations.size(); ++a) {
        const tinygltf::Animation& from = asset.gltf->animations[a];
        Animation animation;
        animation.name = from.name;
        for (size_t c = 0; c < from.channels.size(); ++c) {
            const auto& source = from.channels[c];
            if (source.target_path == "pointer" || source.target_node < 0) {
                context.warn(fmt::format("/animations/{}/channels/{}", a, c), "has no target node; it is ignored");
                continue;
            }
            const auto& sampler = from.samplers[size_t(source.sampler)];
            const std::string pointer = fmt::format("/animations/{}/samplers/{}", a, source.sampler);
            Channel channel;
            channel.node = source.target_node;
            channel.path = pathOf(source.target_path);
            channel.interpolation = interpolationOf(sampler.interpolation);
            channel.times = readFloats(context, asset, sampler.input);
            checkTimes(context, channel.times, pointer + "/input");
            channel.values = readFloats(context, asset, sampler.output);
            const size_t perKey = channel.values.size() / channel.times.size();
            channel.components = int(channel.interpolation == Interpolation::cubicSpline ? perKey / 3 : perKey);
            if (channel.path == AnimatedPath::translation && !context.shifts.empty()) shift(channel, context.shifts[size_t(channel.node)]);
            animation.duration = std::max(animation.duration, channel.times.back());
            animation.channels.push_back(std::move(channel));
        }
        model.animations.push_back(std::move(animation));
    }
}

}  // namespace obscura::scene::gltf
