#include "input.h"

#include <algorithm>

namespace obscura::game {

void handleKeys(const app::Window& window, Session& session) {
    for (const int button : window.gamepad().pressed)
        for (const ButtonBinding& binding : buttonBindings())
            if (binding.button == button) session.act(binding.action, 0);
    for (const app::Window::Press& press : window.pressed()) {
        const auto bindings = keyBindings();
        const auto binding = std::find_if(bindings.begin(), bindings.end(), [&](const KeyBinding& b) { return b.key == press.key; });
        if (binding != bindings.end() && (!press.repeat || binding->repeats)) session.act(binding->action, press.key);
    }
}

}  // namespace obscura::game
