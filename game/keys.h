// The key bindings: one table for the game, for F1 and for --help.
#pragma once

#include <span>
#include <string>

namespace obscura::game {

enum class Action {
    quit,
    toggleOverlay,
    toggleKeys,
    screenshot,
    fullScreen,
    visibilityOnly,
    nextView,
    method,
    previousMethod,
    nextMethod,
    nextPreset,
    pause,
    stepBack,
    stepForward,
    faster,
    slower,
    toggleWalk,
    toggleFlythrough,
    resetCamera,
    dropToy,
    removeToy,
    clearToys,
    grabToy,
    compare,
    nextOther,
    swapSides,
    copySide,
    dividerLeft,
    dividerRight,
    record,
    replay,
    measure,
    copyCommand,
    captureMouse,
};

struct KeyBinding {
    int key;  // GLFW key code
    Action action;
    const char* name;  // of the key, as shown; null: listed with the binding before
    const char* effect;
    bool repeats = false;  // while held
};
std::span<const KeyBinding> keyBindings();

struct ButtonBinding {
    int button;  // GLFW code of a gamepad's button
    Action action;
    const char *name, *effect;
};
std::span<const ButtonBinding> buttonBindings();

// Keys and sticks that move the camera while held.
struct HeldKeys {
    const char* name;
    const char* effect;
};
std::span<const HeldKeys> heldKeys();

// All tables as text, two columns.
std::string keyPage(bool withTitle);

}  // namespace obscura::game
