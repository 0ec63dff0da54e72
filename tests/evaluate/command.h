// Runs obscura-evaluate from the command line, and makes small frames for it.
#pragma once

#include <filesystem>
#include <string>

#include "../shell.h"
#include "../temporary_folder.h"
#include "truth/captured_frame.h"

namespace obscura::evaluate {

using test::Ended;
using test::shellCommand;
using test::TemporaryFolder;
Ended runTool(const std::string& arguments);  // quoted by shellCommand()

std::string textOf(const std::filesystem::path& file);
// A floor and a wall: 64 x 36 px and a guard band of 6 x 4 px.
truth::CapturedFrame cornerFrame();

}  // namespace obscura::evaluate
