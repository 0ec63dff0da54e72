#pragma once

#include "app/window.h"
#include "session.h"

namespace obscura::game {

// Turns what was pressed since the last poll into actions.
void handleKeys(const app::Window& window, Session& session);

}  // namespace obscura::game
