// Settings as the text that command lines and reports use.
#pragma once

#include <string>

#include "obscura/ao.h"

namespace obscura::ao {

// "quadratic:2", as parseFalloff() reads it.
inline std::string falloffText(const Falloff& falloff) {
    char text[64];
    return {text, formatFalloff(falloff, text, sizeof(text))};
}

}  // namespace obscura::ao
