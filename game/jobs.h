// What main() can be asked to do; each returns the exit code and throws app::Complaint or scene::Error.
#pragma once

#include "engine.h"
#include "options.h"

namespace obscura::game {

int playWindowed(const Options& options);
int runHeadless(const Options& options);
// Without a display or presentation: says why, flies through the scene and leaves pictures and a summary in out/.
int flyInstead(const Options& options, const std::string& why);
int listMethods(bool json);
int listScenes();
int listDevices();

// Runs each method for a while, then switches at every frame; prints the worst frame at a switch against the median.
void switchTest(const Options& options, Engine& engine, Stage& stage);

// Tells the number of validation messages when validation is on; kInvalidUse when there are any.
int closingWords(const Options& options, Engine& engine);

}  // namespace obscura::game
