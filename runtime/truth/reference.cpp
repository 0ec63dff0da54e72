// Shared by both references: falloffs as functions, summaries of errors.
#include "truth/reference.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "ao/settings_text.h"

namespace obscura::truth {
namespace {

// ln 65536: the rest of an exponential falloff is smaller than any error that a reference resolves.
constexpr float kExponentialReach = 11.0903549f;

}  // namespace

RayFalloff rayFalloff(const ao::Falloff& falloff) {
    RayFalloff result;
    result.name = ao::falloffText(falloff);
    result.hard = falloff.kind == ao::FalloffKind::constant;
    if (falloff.kind == ao::FalloffKind::exponential) {
        result.reach = kExponentialReach * falloff.length;
        result.rho = [length = falloff.length](float d) { return std::exp(-d / length); };
    } else {
        result.reach = ao::reach(falloff);
        result.rho = [falloff](float d) { return ao::evaluate(falloff, d); };
    }
    return result;
}

RayFalloff rayFalloff(const std::string& text) {
    ao::Falloff falloff;
    if (!ao::parseFalloff(text.c_str(), falloff))
        throw scene::Error(fmt::format(
            "falloff \"{}\": write exponential:L, linear:R, quadratic:R, wendland:R, constant:R or ramp:A:B, lengths in metres", text));
    return rayFalloff(falloff);
}

float Reference::meanError(size_t channel) const {
    double sum = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < rays.pixels(); ++i)
        if (rays.values[i] > 0.0f) {
            sum += channels[channel].error.values[i];
            ++count;
        }
    return count ? float(sum / double(count)) : 0.0f;
}

float Reference::maxError(size_t channel) const {
    const auto& values = channels[channel].error.values;
    return values.empty() ? 0.0f : *std::max_element(values.begin(), values.end());
}

size_t Reference::overTarget(float targetError) const {
    size_t count = 0;
    for (size_t i = 0; i < rays.pixels(); ++i)
        count += std::any_of(channels.begin(), channels.end(), [&](const Channel& c) { return c.error.values[i] > targetError; });
    return count;
}

}  // namespace obscura::truth
