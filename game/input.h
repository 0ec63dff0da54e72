// Keyboard input of the windowed game.
#pragma once

#include "app/window.h"
#include "session.h"

namespace obscura::game {

// Runs the actions of the keys pressed since the last poll.
void handleKeys(const app::Window& window, Session& session);

}  // namespace obscura::game
