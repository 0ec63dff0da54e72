// The overlay's panels, between app::Overlay::beginFrame and add.
#pragma once

#include "session.h"

namespace obscura::game {

void drawPanels(Session& session);
void drawTimes(const Session& session);  // inside a window: bars, history, frame times
void drawKeys();

}  // namespace obscura::game
