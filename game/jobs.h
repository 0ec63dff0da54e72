// The jobs of main(). Each returns the exit code and throws app::Complaint or scene::Error.
#pragma once

#include "engine.h"
#include "options.h"

namespace obscura::game {

int playWindowed(const Options& options);
int runHeadless(const Options& options);
// Fallback without display or presentation: prints `why`, renders the flythrough headless, writes pictures and summary to out/.
int runWithoutWindow(const Options& options, const std::string& why);
int listMethods(bool json);
int listScenes();
int listScene(const std::string& scene);
int listDevices();

// Runs each method for a number of frames, then switches methods at every frame; prints the longest frame at a switch and the median.
void switchTest(const Options& options, Engine& engine, Stage& stage);

// With validation on, prints the number of validation messages; returns kInvalidUse if there are any, else 0.
int reportValidation(const Options& options, Engine& engine);

// The methods that a run shows: all of the switch test, else the chosen one.
std::vector<const ao::MethodInfo*> preparedMethods(const Options& options);

}  // namespace obscura::game
