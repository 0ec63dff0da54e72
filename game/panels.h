// The overlay's panels, between app::Overlay::beginFrame and add.
#pragma once

#include "session.h"

namespace obscura::game {

void drawPanels(Session& session);
void drawTimes(const Session& session);  // inside a window: bars, history, frame times
void drawMeasures(const Session& session);  // inside a window: noise, flicker, errors
void drawKeys();
void drawComparison(Session& session);   // inside a window: side B
void drawDivider(const Session& session);  // on the picture: the divider, what is on either side and what it costs

void drawParameters(ao::Values& values);  // inside a window: preset and every parameter of a method's table
void tip(const char* sentence);           // over the last item

}  // namespace obscura::game
