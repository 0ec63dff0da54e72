// The keys, once: what the game does with them, what F1 shows and what --help prints.
#pragma once

#include <span>
#include <string>

namespace obscura::game {

enum class Action {
    quit, toggleOverlay, toggleKeys, screenshot, fullScreen, visibilityOnly, nextView, method, previousMethod, nextMethod,
    nextPreset, pause, stepBack, stepForward, faster, slower, toggleWalk, toggleFlythrough, resetCamera, dropToy, removeToy,
    clearToys, compare, nextOther, swapSides, copySide, dividerLeft, dividerRight,
    record, replay, measure,
};

struct KeyBinding {
    int key;             // GLFW key code
    Action action;
    const char* name;    // of the key, as shown; null: listed with the binding before
    const char* effect;
    bool repeats = false;  // while held
};
std::span<const KeyBinding> keyBindings();

// Held keys that move the camera; shown beside the others.
struct HeldKeys {
    const char* name;
    const char* effect;
};
std::span<const HeldKeys> heldKeys();

// All of it as text, two columns.
std::string keyPage(bool withTitle);

}  // namespace obscura::game
