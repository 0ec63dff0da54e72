#include "keys.h"

#include <array>

#include <fmt/format.h>

#include "app/window.h"

namespace obscura::game {

namespace {

constexpr KeyBinding kBindings[] = {
    {GLFW_KEY_1, Action::method, "1..9", "select one of the first nine methods"},
    {GLFW_KEY_2, Action::method, nullptr, nullptr},
    {GLFW_KEY_3, Action::method, nullptr, nullptr},
    {GLFW_KEY_4, Action::method, nullptr, nullptr},
    {GLFW_KEY_5, Action::method, nullptr, nullptr},
    {GLFW_KEY_6, Action::method, nullptr, nullptr},
    {GLFW_KEY_7, Action::method, nullptr, nullptr},
    {GLFW_KEY_8, Action::method, nullptr, nullptr},
    {GLFW_KEY_9, Action::method, nullptr, nullptr},
    {GLFW_KEY_LEFT_BRACKET, Action::previousMethod, "[", "previous method"},
    {GLFW_KEY_RIGHT_BRACKET, Action::nextMethod, "]", "next method"},
    {GLFW_KEY_P, Action::nextPreset, "P", "next preset of the method"},
    {GLFW_KEY_O, Action::visibilityOnly, "O", "show visibility only, on and off"},
    {GLFW_KEY_V, Action::nextView, "V", "next view: normals, depth, motion, ..."},
    {GLFW_KEY_C, Action::compare, "C", "compare: method A left of a divider, B right of it; drag the divider"},
    {GLFW_KEY_B, Action::nextOther, "B", "next method for side B"},
    {GLFW_KEY_X, Action::swapSides, "X", "swap A and B"},
    {GLFW_KEY_N, Action::copySide, "N", "copy A's method and settings to B"},
    {GLFW_KEY_J, Action::dividerLeft, "J", "divider to the left", true},
    {GLFW_KEY_K, Action::dividerRight, "K", "divider to the right", true},
    {GLFW_KEY_M, Action::measure, "M", "measure noise and flicker, and errors where a reference is cached, on and off"},
    {GLFW_KEY_SPACE, Action::pause, "Space", "pause and resume"},
    {GLFW_KEY_COMMA, Action::stepBack, ",", "pause, one frame back", true},
    {GLFW_KEY_PERIOD, Action::stepForward, ".", "pause, one frame forward", true},
    {GLFW_KEY_MINUS, Action::slower, "-", "slower time"},
    {GLFW_KEY_EQUAL, Action::faster, "=", "faster time"},
    {GLFW_KEY_F, Action::toggleWalk, "F", "fly or walk"},
    {GLFW_KEY_G, Action::captureMouse, "G", "look around with the mouse alone, on and off (Esc: off)"},
    {GLFW_KEY_L, Action::toggleFlythrough, "L", "follow the scene's flythrough, on and off"},
    {GLFW_KEY_R, Action::record, "R", "record the camera path, on and off: a file for Y, --path and obscura-flythrough"},
    {GLFW_KEY_Y, Action::replay, "Y", "replay the last recorded path (or that of --path), on and off"},
    {GLFW_KEY_HOME, Action::resetCamera, "Home", "camera back to its start position"},
    {GLFW_KEY_T, Action::dropToy, "T", "drop a walking toaster where the camera looks", true},
    {GLFW_KEY_H, Action::grabToy, "H", "pick up the dropped toaster ahead; again: throw it"},
    {GLFW_KEY_BACKSPACE, Action::removeToy, "Backspace", "remove the last dropped toaster", true},
    {GLFW_KEY_DELETE, Action::clearToys, "Delete", "remove all dropped toasters"},
    {GLFW_KEY_TAB, Action::toggleOverlay, "Tab", "show panels, on and off"},
    {GLFW_KEY_F1, Action::toggleKeys, "F1", "this list of keys"},
    {GLFW_KEY_F2, Action::screenshot, "F2", "screenshot without panels, as PNG"},
    {GLFW_KEY_F3, Action::copyCommand, "F3", "copy the command that starts the game with this frame"},
    {GLFW_KEY_F11, Action::fullScreen, "F11", "full screen"},
    {GLFW_KEY_ESCAPE, Action::quit, "Esc", "quit"},
};

constexpr HeldKeys kHeld[] = {
    {"W A S D", "move"},
    {"Q E", "down and up (flying)"},
    {"Shift", "four times as fast"},
    {"right mouse button", "look around"},
    {"arrows", "look around"},
    {"gamepad", "left stick: move; right stick: look around; triggers: down and up"},
};

constexpr ButtonBinding kButtons[] = {
    {GLFW_GAMEPAD_BUTTON_LEFT_BUMPER, Action::previousMethod, "left bumper", "previous method"},
    {GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER, Action::nextMethod, "right bumper", "next method"},
    {GLFW_GAMEPAD_BUTTON_A, Action::dropToy, "A", "drop a walking toaster"},
    {GLFW_GAMEPAD_BUTTON_RIGHT_THUMB, Action::grabToy, "right stick", "pick up a toaster; throw it"},
    {GLFW_GAMEPAD_BUTTON_B, Action::visibilityOnly, "B", "show visibility only"},
    {GLFW_GAMEPAD_BUTTON_X, Action::nextPreset, "X", "next preset"},
    {GLFW_GAMEPAD_BUTTON_Y, Action::toggleWalk, "Y", "fly or walk"},
    {GLFW_GAMEPAD_BUTTON_START, Action::pause, "start", "pause and resume"},
    {GLFW_GAMEPAD_BUTTON_BACK, Action::toggleOverlay, "back", "show panels"},
};

}  // namespace

std::span<const KeyBinding> keyBindings() { return kBindings; }
std::span<const ButtonBinding> buttonBindings() { return kButtons; }
std::span<const HeldKeys> heldKeys() { return kHeld; }

std::string keyPage(bool withTitle) {
    std::string page = withTitle ? "Keys:\n" : "";
    for (const HeldKeys& held : kHeld) page += fmt::format("  {:<20} {}\n", held.name, held.effect);
    for (const KeyBinding& binding : kBindings)
        if (binding.name) page += fmt::format("  {:<20} {}\n", binding.name, binding.effect);
    page += withTitle ? "Gamepad:\n" : "\n";
    for (const ButtonBinding& binding : kButtons) page += fmt::format("  {:<20} {}\n", binding.name, binding.effect);
    return page;
}

}  // namespace obscura::game
