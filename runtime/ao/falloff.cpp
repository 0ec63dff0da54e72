#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>

#include "ao/method.h"

namespace obscura::ao {
namespace {

constexpr const char* kNames[] = {"exponential", "linear", "quadratic", "wendland", "constant", "ramp"};
constexpr float kExponentialReach = 5.5451774f;  // ln 256: what is left rounds away in 8 bits

bool parseLength(const char*& text, float& out) {
    if (*text != ':') return false;
    char* end = nullptr;
    out = std::strtof(text + 1, &end);
    if (end == text + 1) return false;
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

// Coefficients in d: those in x = d / length, divided by powers of the length.
shared::FalloffBlock falloffBlock(const Falloff& falloff) {
    const double s = 1.0 / falloff.length;
    shared::FalloffBlock block{1, 0, 0, 0, 0, 0, 0, reach(falloff)};
    switch (falloff.kind) {
        case FalloffKind::exponential: block.decay = float(1.4426950408889634 * s); break;
        case FalloffKind::linear: block.c1 = float(-s); break;
        case FalloffKind::quadratic: block.c2 = float(-s * s); break;
        case FalloffKind::wendland:  // (1-x)^4 (4x+1) = 1 - 10 x^2 + 20 x^3 - 15 x^4 + 4 x^5
            block.c2 = float(-10.0 * s * s);
            block.c3 = float(20.0 * s * s * s);
            block.c4 = float(-15.0 * s * s * s * s);
            block.c5 = float(4.0 * s * s * s * s * s);
            break;
        case FalloffKind::constant: break;
        case FalloffKind::ramp:
            block.c0 = float(falloff.end / (double(falloff.end) - falloff.length));
            block.c1 = float(-1.0 / (double(falloff.end) - falloff.length));
            break;
    }
    return block;
}

}  // namespace obscura::ao
