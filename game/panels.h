// The overlay's panels, between app::Overlay::beginFrame and add.
#pragma once

#include "session.h"

namespace obscura::game {

void drawPanels(Session& session);
void drawTimes(const Session& session);     // inside a window: bars, history, frame times
void drawMeasures(const Session& session);  // inside a window: noise, flicker, errors
void drawKeys();
void drawComparison(Session& session);     // inside a window: side B
void drawDivider(const Session& session);  // over the picture: divider, and setting and GPU time of each side

void drawParameters(ao::Values& values);  // inside a window: preset, resolve and all parameters of a method
void tip(const char* sentence);           // tooltip of the last item

}  // namespace obscura::game
