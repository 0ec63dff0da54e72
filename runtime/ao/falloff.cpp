#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>

#include "ao/method.h"

namespace obscura::ao {
namespace {

constexpr const char* kNames[] = {"exponential", "linear", "quadratic", "wendland", "constant", "ramp"};
constexpr float kExponentialReach = 5.5451774f;  // ln 256: what is left rounds away in 8 bits

// Independent of the locale, unlike strtof.
bool parseLength(const char*& text, float& out) {
    if (*text != ':') return false;
    const auto [end, error] = std::from_chars(text + 1, text + std::strlen(text), out);
    if (error != std::errc()) return false;
    text = end;
    return std::isfinite(out);
}

}  // namespace

bool parseFalloff(const char* text, Falloff& out) {
    if (!text) return false;
    for (uint32_t i = 0; i < std::size(kNames); ++i) {
        const size_t length = std::strlen(kNames[i]);
        if (std::strncmp(text, kNames[i], length) != 0) continue;
        Falloff result{FalloffKind(i), 0.0f, 0.0f};
        const char* rest = text + length;
        if (!parseLength(rest, result.length) || result.length <= 0.0f) return false;
        if (result.kind == FalloffKind::ramp && (!parseLength(rest, result.end) || result.end <= result.length)) return false;
        if (*rest != '\0') return false;
        out = result;
        return true;
    }
    return false;
}

size_t formatFalloff(const Falloff& falloff, char* text, size_t size) {
    char whole[64];
    char* end = std::copy_n(kNames[size_t(falloff.kind)], std::strlen(kNames[size_t(falloff.kind)]), whole);
    const auto append = [&](float length) {
        *end++ = ':';
        end = std::to_chars(end, std::end(whole), length).ptr;
    };
    append(falloff.length);
    if (falloff.kind == FalloffKind::ramp) append(falloff.end);
    const size_t length = size_t(end - whole);
    if (size > 0) *std::copy_n(whole, std::min(length, size - 1), text) = '\0';
    return length;
}

List<const char*> falloffKinds() { return {kNames, std::size(kNames)}; }

float evaluate(const Falloff& falloff, float distance) {
    const float x = distance / falloff.length;
    const float y = std::fmax(1.0f - x, 0.0f);
    switch (falloff.kind) {
        case FalloffKind::exponential: return distance < reach(falloff) ? std::exp(-x) : 0.0f;
        case FalloffKind::linear: return y;
        case FalloffKind::quadratic: return std::fmax(1.0f - x * x, 0.0f);
        case FalloffKind::wendland: return y * y * y * y * (4.0f * x + 1.0f);
        case FalloffKind::constant: return distance <= falloff.length ? 1.0f : 0.0f;
        case FalloffKind::ramp: break;
    }
    return std::fmin(std::fmax((falloff.end - distance) / std::fmax(falloff.end - falloff.length, 1e-6f), 0.0f), 1.0f);
}

float reach(const Falloff& falloff) {
    if (falloff.kind == FalloffKind::exponential) return falloff.length * kExponentialReach;
    return falloff.kind == FalloffKind::ramp ? falloff.end : falloff.length;
}

shared::FalloffBlock falloffBlock(const Falloff& falloff) {
    const double length = falloff.length, end = falloff.end;
    shared::FalloffBlock block{1.0f, 0.0f, reach(falloff)};
    switch (falloff.kind) {
        case FalloffKind::exponential: block.slope = float(-1.4426950408889634 / length); break;
        case FalloffKind::linear:
        case FalloffKind::wendland: block.slope = float(-1.0 / length); break;
        case FalloffKind::quadratic: block.slope = float(-1.0 / (length * length)); break;
        case FalloffKind::constant: break;
        case FalloffKind::ramp:
            block.start = float(end / (end - length));
            block.slope = float(-1.0 / (end - length));
            break;
    }
    return block;
}

gpu::Constant falloffConstant(FalloffKind kind) { return {OBSCURA_FALLOFF_KIND, uint32_t(kind)}; }

}  // namespace obscura::ao
